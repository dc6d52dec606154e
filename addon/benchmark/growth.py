"""Measure how the methods' run times grow with the scene and the mirror, in the talk's setting at increasing detail."""
from __future__ import annotations

import time
from collections.abc import Callable

from ...core import ReflectionError
from ...core.rivals import METHODS, primary_hits
from ...core.rivals.scenes import MadeScene, with_mirror_triangles, with_vertices
from ..report import Growth
from .rival_bvhtree import RIVAL as BVHTREE

PIXELS = 512
VERTICES = (1_000, 3_000, 10_000, 30_000, 100_000, 1_000_000)
TRIANGLES = (500, 2_000, 8_000, 30_000, 100_000)
# a method each of those that scale alike, at one value of its knob
CHOSEN = (("GENERAL", METHODS["GENERAL"], 0.5), ("RAYS", METHODS["RAYS"], 1), ("BVHTREE", BVHTREE, 1),
          ("CLUSTERS", METHODS["CLUSTERS"], 0), ("MORPHING", METHODS["MORPHING"], 4000))
TITLES = {"BVHTREE": "Blender's BVHTree"}


def growths(budget: float, tell: Callable[[str], None] = print, sizes: tuple = (VERTICES, TRIANGLES),
            pixels: int = PIXELS) -> tuple[list[Growth], list[str]]:
    """Return the run times of a few methods over the number of diffuse vertices and of mirror triangles, and sentences
    on sizes that were left out because a smaller one took longer than `budget` seconds.
    """
    lines, left_out = [], []
    for axis, make, counts in (("diffuse vertices", with_vertices, sizes[0]),
                               ("mirror triangles", with_mirror_triangles, sizes[1])):
        taken: dict = {key: ([], []) for key, *_ in CHOSEN}
        stopped: dict = {}
        for count in counts:
            going = [entry for entry in CHOSEN if entry[0] not in stopped]
            if not going:
                break
            made = make(count, (pixels, pixels))
            hits = primary_hits(made.view, made.mirror, made.scene)
            size = len(made.scene.positions) if axis == "diffuse vertices" else len(made.mirror.triangles)
            since = time.perf_counter()
            for key, rival, value in going:
                seconds = _seconds(made, rival, value, hits)
                if seconds is None or seconds > budget:
                    stopped[key] = size
                if seconds is not None:
                    taken[key][0].append(size)
                    taken[key][1].append(seconds)
            tell(f"growth: {size:,} {axis}, {time.perf_counter() - since:.1f} s")
        for key, rival, _ in CHOSEN:
            title = TITLES.get(key, rival.title)
            lines.append(Growth(key, title, axis, *map(tuple, taken[key])))
            if key in stopped and stopped[key] < 0.9 * counts[-1]:
                left_out.append(f"{title} was stopped at {stopped[key]:,} {axis}, where it took more than "
                                f"{budget:g} s.")
    return lines, left_out


def _seconds(made: MadeScene, rival, value: float, hits) -> float | None:
    """Return the shorter run time of two runs, or that of one run longer than a second; None if memory does not
    suffice.
    """
    best = None
    for _ in range(2):
        try:
            picture = rival.run(made.view, made.mirror, made.scene, value, hits)
        except (MemoryError, ReflectionError):
            return best
        best = min(best or float("inf"), sum(picture.seconds.values()))
        if best > 1.0:
            break
    return best
