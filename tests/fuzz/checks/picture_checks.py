"""Whether a reflection mesh shows what rays see, in some of the picture's pixels: whole regions must not be wrong.

A pixel is asked in its middle. Where rays fill squares of up to a pixel they tell what is seen there, and nothing of
what lies between two middles: in none of the 499 pixels of a bowl did a result show what rays do not meet, and in 8 of
69 places between them it did.
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from core import ReflectionMesh, View
from tests.fuzz.drawing.configurations import Configuration
from tests.oracles.raster import rasterise
from tests.oracles.truth_bounces import trace_bounces

PIXELS = 24  # of the longer side that are asked, about
SHARE, FEWEST = 0.04, 5  # of the mirror's pixels, and pixels: more must not be wrong
OTHER_SURFACE = 2.0  # pixels: another triangle further away is another surface
TOLERANCES = 3.0  # by which a region may be displaced, and one pixel more
TOLD = ("missed", "bounded", "unfilled")  # counts by which a result tells that something is missing


def shows_what_rays_see(configuration: Configuration, mesh: ReflectionMesh) -> Iterator[str]:
    """No large part of the mirror is wrong, or open without a count that says so."""
    if configuration.settings.method != "GENERAL":
        return
    seen, wrong = regions(configuration, mesh)
    if any(mesh.counts.get(name) for name in TOLD):
        del wrong["holes"]
    for kind, pixels in wrong.items():
        if pixels >= FEWEST and pixels > SHARE * seen:
            yield f"{kind}: {pixels} of {seen} pixels of the mirror, and no count says so"


def refused_rightly(configuration: Configuration, refusal: str) -> Iterator[str]:
    """No sentence says that the view does not see the mirror where rays do."""
    if " see " not in refusal:
        return
    view, mirrors = coarse(configuration.view), configuration.mirrors
    seen = trace_bounces(view, configuration.mirror, configuration.scene, mirrors, 1).seen
    if seen.sum() >= FEWEST:
        yield f"refusal: {seen.sum()} of {len(seen)} pixels show the mirror: {refusal!r}"


def regions(configuration: Configuration, mesh: ReflectionMesh) -> tuple[int, dict[str, int]]:
    """How many pixels of the coarse picture show the mirror, and in how many of these the mesh is wrong.

    Returns
    -------
    seen : int
        Pixels where Cycles bends the normal are left out, here and below.
    wrong : dict
        `holes`: rays see the scene and the mesh shows nothing; `spill`: the reverse; `layers`: the mesh shows another
        surface; `astray`: it shows another place of the same triangle. SURFACE does not order its layers: both are
        left out there.
    """
    view = coarse(configuration.view)
    truth = trace_bounces(view, configuration.mirror, configuration.scene, configuration.mirrors,
                          configuration.settings.depth)
    counted = truth.seen & ~truth.bent
    sees = counted & (truth.source >= 0)
    drawn = rasterise(view, mesh.positions, mesh.triangles)
    shows = drawn.triangle >= 0
    wrong = {"holes": sees & ~shows, "spill": counted & ~sees & shows}
    if configuration.settings.placement != "SURFACE" and len(mesh.triangles):
        both, same = sees & shows, mesh.source_face[drawn.triangle] == truth.source
        place = drawn.interpolate(mesh.reflected_position, mesh.triangles)
        away = np.linalg.norm(place - truth.position, axis=1) / np.where(truth.motion > 0.0, truth.motion, np.nan)
        wrong["layers"] = both & ~same & ~(away < OTHER_SURFACE)
        wrong["astray"] = both & same & (away > TOLERANCES * configuration.settings.tolerance + 1.0)
    return int(counted.sum()), {kind: int(pixels.sum()) for kind, pixels in wrong.items()}


def coarse(view: View) -> View:
    """The same eye with few pixels, whose middles are those of some of its own, evenly spaced."""
    sides = np.array(view.resolution)
    step = max(1, round(sides.max() / PIXELS))
    count = np.maximum(1, sides // step)
    # of the picture, in its pixels: where the first of the few begins
    start = (sides - 1 - step * (count - 1)) // 2 + 0.5 * (1 - step)
    scale, shift = sides / (step * count), (sides - 2.0 * start) / (step * count) - 1.0
    projection = view.projection.copy()
    projection[:2] = scale[:, None] * projection[:2] + shift[:, None] * projection[3]
    return replace(view, projection=projection, resolution=(int(count[0]), int(count[1])))


CHECKS = (shows_what_rays_see,)
