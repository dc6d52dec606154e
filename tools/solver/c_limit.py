"""What NumPy leaves on the table: the innermost kernels beside C, on the same arrays, as ratios.

    python -m tools.solver.c_limit [--pairs 200000] [--rounds 9]

Compiles tools/solver/c_limit.c with the system's C compiler (`CC`, or cc) and runs the cubic and Newton's step of the
walk in turn with the method's own, in its chunks. Results are compared first. Prints a table in Markdown.
"""
from __future__ import annotations

import argparse
import ctypes
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from core import TriangleMesh, View, project
from core.cameras import MirrorMap, three_ray_cameras, visible_triangles
from core.geometry import ordered, rows
from core.patches import Patch, Walk
from core.patches.walk import AT_ONCE, LONGEST, STEPS, newton
from core.rivals.scenes import icosphere
from core.solver.cubic import coefficients, differences
from core.solver.projection import CHUNK, Images
from tools.solver.solver_rate import KINDS, kernel_project

SOURCE = Path(__file__).with_suffix(".c")
OPTIONS = ("-O3", "-march=native", "-ffast-math", "-fPIC", "-c")
ROUNDING = 1e-8  # of the result: simple roots near each other, or steps that begin far off, magnify it


class Missing(Exception):
    """There is no C compiler."""


@dataclass(frozen=True)
class Kernel:
    """One kernel in both languages: each call works on the same arrays and returns its results.

    Attributes
    ----------
    name : str
    count : int
        Pairs or points.
    numpy, c : callable
    """

    name: str
    count: int
    numpy: Callable[[], np.ndarray]
    c: Callable[[], np.ndarray]


def compiled(folder: Path) -> ctypes.CDLL:
    """The kernels in C, compiled into a folder.

    Raises
    ------
    Missing
        In a sentence, where there is no compiler.
    """
    compiler = shutil.which(os.environ.get("CC", "cc"))
    if compiler is None:
        raise Missing("There is no C compiler; install one (on Debian: apt-get install gcc), or name it with CC=...")
    parts, library = folder / "c_limit.o", folder / "c_limit.so"
    subprocess.run([compiler, *OPTIONS, str(SOURCE), "-o", str(parts)], check=True)
    # a library that is linked with fast arithmetic would switch the smallest numbers off for all of the process
    subprocess.run([compiler, "-shared", str(parts), "-o", str(library), "-lm"], check=True)
    return ctypes.CDLL(str(library))


def kernels(library: ctypes.CDLL, pairs: int) -> list[Kernel]:
    """The kernels on about so many pairs of a ball's cameras, and points before a ball."""
    rng = np.random.default_rng(1)
    given = KINDS["a ball's cameras"](rng, pairs)
    parts = [tuple(np.ascontiguousarray(part[start:start + CHUNK]) for part in given)
             for start in range(0, pairs, CHUNK)]
    frames = [differences(*part) for part in parts]
    patch, starts = walk_starts(rng, pairs)
    return [
        Kernel("coefficients of the cubic", pairs,
               lambda: np.concatenate([coefficients(*frame) for frame in frames], 1),
               lambda: np.concatenate([_coefficients(library, *frame) for frame in frames], 1)),
        Kernel("images, by the closed form", pairs,
               lambda: _first(kernel_project(*given)), lambda: _nearest(library, parts)),
        Kernel("images, certain (`core.project`)", pairs,
               lambda: _first(project(*given)), lambda: _nearest(library, parts)),
        Kernel(f"{STEPS} steps of Newton's method", pairs,
               lambda: np.concatenate([np.vstack(newton(patch, *start)[:2]) for start in starts], 1),
               lambda: np.concatenate([_newton(library, patch, *start) for start in starts], 1))]


def walk_starts(rng: np.random.Generator, count: int) -> tuple[Patch, list[tuple]]:
    """The patch of a ball, and in chunks the starts of points before it: triangles, (u, v), s and the points."""
    positions, triangles, normals = icosphere((0.0, 0.0, 0.0), 1.0, 4)
    view = View.looking_at((0.3, -5.0, 2.0), (0.0, 0.0, 0.0), (1024, 1024), field_of_view=0.5)
    mirror, _ = ordered(TriangleMesh(positions, triangles, normals[triangles]), shading=True)
    cameras = three_ray_cameras(MirrorMap(view, mirror), mirror, visible_triangles(view, mirror))
    patch = Patch.largest(cameras, np.ones(len(cameras), dtype=bool))
    assert patch is not None
    points = rows(rng.uniform((-2.0, -4.0, -2.0), (2.0, -1.5, 2.0), (count, 3))) - patch.eye
    chunks = [np.ascontiguousarray(points[:, start:start + AT_ONCE]) for start in range(0, count, AT_ONCE)]
    walk = Walk(patch)
    return patch, [(*walk.near(chunk), chunk) for chunk in chunks]


def _first(images: Images) -> np.ndarray:
    """The nearest image (n,) of each pair, 1e100 where it has none."""
    found = np.full(len(images.degenerate), 1e100)
    found[images.pair[::-1]] = images.distance[::-1]
    return found


def _pointer(array: np.ndarray) -> ctypes.c_void_p:
    return ctypes.c_void_p(array.ctypes.data)


def _coefficients(library: ctypes.CDLL, still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    count = still.shape[2]
    found = np.empty((4, count))
    library.coefficients(ctypes.c_size_t(count), *map(_pointer, (still, moving, found)))
    return found


def _nearest(library: ctypes.CDLL, parts: list[tuple]) -> np.ndarray:
    """The nearest image (n,) of each pair, 1e100 where it has none."""
    nearest = [np.empty(len(part[2])) for part in parts]
    for part, found in zip(parts, nearest):
        library.images(ctypes.c_size_t(len(found)), *map(_pointer, (*part, found)))
    return np.concatenate(nearest)


def _newton(library: ctypes.CDLL, patch: Patch, member: np.ndarray, uv: np.ndarray, s: np.ndarray,
            points: np.ndarray) -> np.ndarray:
    found, moved = np.concatenate((uv, s[None])), np.empty(len(s))
    sizes = (ctypes.c_size_t(len(s)), ctypes.c_size_t(len(patch)), ctypes.c_int(STEPS), ctypes.c_double(LONGEST))
    library.newton(*sizes, *map(_pointer, (patch.shape, member, found, points, moved)))
    return found


def agreement(kernel: Kernel) -> tuple[float, float]:
    """The share of the results that differ by more than rounding, and the 99.9th percentile of their relative
    differences."""
    mine, other = kernel.numpy(), kernel.c()
    scale = np.abs(mine).max(axis=0) if mine.ndim == 2 else np.abs(mine)
    away = np.abs(mine - other) / np.maximum(scale, 1e-300)
    return float((away > ROUNDING).mean()), float(np.percentile(away, 99.9))


def main(arguments: list[str] | None = None) -> int:
    """Run from the command line."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--pairs", type=int, default=200_000)
    parser.add_argument("--rounds", type=int, default=9)
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory(prefix="reflection_mesh_") as folder:
        try:
            library = compiled(Path(folder))
        except Missing as missing:
            print(missing, file=sys.stderr)
            return 1
        print("| kernel | NumPy, ns each | C, ns each | NumPy / C | from, to | beyond rounding % |")
        print("|---" + 5 * "|---:" + "|")
        for kernel in kernels(library, options.pairs):
            other = 100.0 * agreement(kernel)[0]
            seconds = np.array([[_seconds(kernel.numpy), _seconds(kernel.c)] for _ in range(options.rounds)])
            mine, c = np.median(seconds, axis=0) / kernel.count * 1e9
            ratio = seconds[:, 0] / seconds[:, 1]
            print(f"| {kernel.name} | {mine:.0f} | {c:.0f} | {np.median(ratio):.1f} | {ratio.min():.1f}, "
                  f"{ratio.max():.1f} | {other:.3f} |", flush=True)
    return 0


def _seconds(run: Callable[[], np.ndarray]) -> float:
    started = time.perf_counter()
    run()
    return time.perf_counter() - started


if __name__ == "__main__":
    sys.exit(main())
