"""What several cores would bring: chunks of pairs, and whole reflections, in turn and side by side, in one run.

    python -m tools.timing.threads [torus bowl 10000 ...] [--workers 2] [--rounds 5]

Scenes are named as for tools.timing.turns. The chunks are those in which cameras and triangles that may overlap are
looked at, the largest single share of the work where mirrors fold. NumPy's own threads are switched off.
"""
from __future__ import annotations

import argparse
import multiprocessing
import os
import statistics
import sys
import time
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor

for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")

import numpy as np  # noqa: E402

import core  # noqa: E402
from core.cameras import MirrorMap, in_picture, three_ray_cameras, visible_triangles  # noqa: E402
from core.culling import SceneAndMirrors  # noqa: E402
from core.filling import Crowds, Limits  # noqa: E402
from core.geometry import SceneFrames, distinct  # noqa: E402
from core.polygons import Overlaps, covering  # noqa: E402
from tools.measure import print_table  # noqa: E402
from tools.timing.turns import _scene  # noqa: E402

CHUNKS, PAIRS = (4096, 16384, 65536), 1 << 19


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", default=["torus", "bowl", "10000"])
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args(arguments)
    with ThreadPoolExecutor(options.workers) as threads, \
            ProcessPoolExecutor(options.workers, multiprocessing.get_context("spawn")) as processes:
        rows = [_chunked(options.scenes[0], size, threads, options.rounds) for size in CHUNKS]
        print_table([("pairs in a chunk", "one s", "threads s", "one / threads", "from", "to"), *rows])
        print()
        rows = [_whole(name, threads, processes, options) for name in options.scenes]
        print_table([("scene, so often", "in turn s", "threads s", "in turn / threads", "from", "to", "processes s",
                      "in turn / processes", "from", "to"), *rows])
    return 0


def _chunked(name: str, size: int, threads: Executor, rounds: int) -> tuple:
    """Seconds to look at all pairs of a scene in chunks of this size, one after another and side by side."""
    cameras, frames, met, (camera, column) = _pairs(name)
    starts = range(0, len(camera), size)
    covering.PAIRS_AT_ONCE = size

    def chunk(start: int) -> int:
        part = slice(start, start + size)
        return len(Overlaps.of(cameras, frames, (camera[part], column[part]), met).candidates)
    one, several = _in_turns(rounds, lambda: [chunk(start) for start in starts],
                             lambda: list(threads.map(chunk, starts)))
    return (size, statistics.median(one), statistics.median(several), *_gain(one, several))


def _pairs(name: str) -> tuple:
    """Cameras, frames, what is met, and pairs of a camera and a column, as many as `PAIRS`."""
    view, mirror, scene = _scene(core, name)
    cameras = three_ray_cameras(MirrorMap(view, mirror), mirror, visible_triangles(view, mirror))
    cameras = cameras.select(in_picture(cameras))
    met = SceneAndMirrors(core.SceneTree.build(scene), mirror)
    limits = Limits.of(core.Settings(), view.resolution[0] * view.resolution[1], len(met.triangles))
    found = met.diffuse_in(cameras, Crowds(met, limits, True).bound(cameras))
    seen, column = distinct(found.triangle)
    return cameras, SceneFrames.of(met, seen), met, (np.resize(found.cone, PAIRS), np.resize(column, PAIRS))


def _whole(name: str, threads: Executor, processes: Executor, options: argparse.Namespace) -> tuple:
    """Seconds of as many reflections of a scene as there are workers."""
    names = [name] * options.workers
    list(processes.map(_reflect, names))
    _reflect(name)
    one, side_by_side, apart = _in_turns(
        options.rounds, lambda: list(map(_reflect, names)), lambda: list(threads.map(_reflect, names)),
        lambda: list(processes.map(_reflect, names)))
    return (f"{name}, {len(names)}", statistics.median(one), statistics.median(side_by_side),
            *_gain(one, side_by_side), statistics.median(apart), *_gain(one, apart))


def _reflect(name: str) -> int:
    return len(core.reflect(*_scene(core, name)).triangles)


def _in_turns(rounds: int, *ways: Callable[[], list]) -> list[list[float]]:
    """Seconds of each way to do the same, in turns, and once before that counts."""
    seconds: list[list[float]] = [[] for _ in ways]
    for _ in range(rounds + 1):
        for way, taken in zip(ways, seconds):
            started = time.perf_counter()
            way()
            taken.append(time.perf_counter() - started)
    return [taken[1:] for taken in seconds]


def _gain(before: list[float], after: list[float]) -> tuple[float, float, float]:
    ratios = [one / other for one, other in zip(before, after)]
    return statistics.median(ratios), min(ratios), max(ratios)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
