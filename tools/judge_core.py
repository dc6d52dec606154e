"""Judge `core.reflect` on scenes made from formulas, without Blender: one line of numbers for each.

    python -m tools.judge_core sphere flat --resolution 1024 --tolerance 0.5 --images demo
"""
from __future__ import annotations

import argparse
import sys
import time
import traceback
from pathlib import Path

import core
from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare, write_images
from tests.oracles.truth import trace

COLUMNS = ("scene", "median", "p95", "p99", "max", "hole%", "spill%", "wrong%", "sum%", "sunk%", "self%", "bent%",
           "faces", "seconds", "truth s")
LINE = "{:13}" + " {:>8}" * (len(COLUMNS) - 1)


def judge_scene(name: str, resolution: int, settings: core.Settings, single: bool, images: Path | None):
    """Reflect, judge and print one scene; returns its numbers and its mesh."""
    case = SCENES[name]((resolution, resolution))
    start = time.perf_counter()
    mesh = core.reflect(case.view, case.mirror, case.scene, settings)
    reflected = time.perf_counter()
    truth = trace(case.view, case.mirror, case.scene)
    traced = time.perf_counter()
    judgement = compare(case.view, case.mirror, mesh, truth, placement=settings.placement, single_precision=single)
    n = judgement.numbers
    shares = ("hole", "spill", "wrong_layer", "uncovered", "sunk", "sees_itself", "bent")
    print(LINE.format(name, *(f"{n[k]:.3f}" for k in ("median", "p95", "p99", "maximum")),
                      *(f"{n[k]:.4f}" for k in shares), len(mesh.triangles), f"{reflected - start:.2f}",
                      f"{traced - reflected:.2f}"), flush=True)
    if images is not None:
        write_images(images, name, case.scene, mesh, truth, judgement)
    return n, mesh


def main(arguments: list[str] | None = None) -> int:
    """Run from the command line; 1 where a scene raised an error or misses a limit that was given."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", metavar="scene", help=f"all where none is named: {', '.join(SCENES)}")
    parser.add_argument("--resolution", type=int, default=1024, help="pixels of width and height (1024)")
    parser.add_argument("--tolerance", type=float, default=0.5, help="in pixels (0.5)")
    parser.add_argument("--placement", choices=core.PLACEMENTS, default="LAYERED")
    parser.add_argument("--method", choices=core.METHODS, default="GENERAL")
    parser.add_argument("--single", action="store_true", help="round the mesh to float32 first, as Blender holds it")
    parser.add_argument("--details", action="store_true", help="also print counts, times of stages and the worst pixel")
    parser.add_argument("--images", type=Path, help="folder for pictures of the errors")
    parser.add_argument("--limit-p99", type=float, help="fail where the 99th percentile is not under this, in pixels")
    parser.add_argument("--limit-uncovered", type=float, help="fail where their sum is not under this, in %%")
    options = parser.parse_args(arguments)
    unknown = [name for name in options.scenes if name not in SCENES]
    if unknown:
        parser.error(f"there is no scene {', '.join(unknown)}; choose from {', '.join(SCENES)}")
    settings = core.Settings(tolerance=options.tolerance, placement=options.placement, method=options.method)
    print(LINE.format(*COLUMNS))
    failed = False
    for name in options.scenes or SCENES:
        try:
            numbers, mesh = judge_scene(name, options.resolution, settings, options.single, options.images)
        except (ArithmeticError, LookupError, MemoryError, RuntimeError, TypeError, ValueError):
            # One scene's error must not hide the numbers of the others.
            print(f"{name}: error", flush=True)
            traceback.print_exc()
            failed = True
            continue
        failed |= options.limit_p99 is not None and not numbers["p99"] < options.limit_p99
        failed |= options.limit_uncovered is not None and not numbers["uncovered"] < options.limit_uncovered
        if options.details:
            print("   worst pixel", numbers["worst_pixel"], " estimated", mesh.estimated_error, " spill outside",
                  f"{numbers['spill_outside']:.3f}%")
            print("   counts", mesh.counts)
            print("   seconds", {stage: round(spent, 3) for stage, spent in mesh.seconds.items()}, flush=True)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
