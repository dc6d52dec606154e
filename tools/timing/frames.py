"""Seconds of a frame in which the eye alone has moved: with what is kept, without it, and of Cycles, in one run.

    python -m tools.timing.frames [1000 10000 100000] [--runs 5] [--mirror 32] [--method GENERAL]

The scenes are those of tools.timing.sizes. Cycles renders one sample with persistent data, as it does in an animation,
and comes first: without any reflection in the file nothing but its camera changes either. Generations are told in
processor seconds too, which others on the machine change less.
"""
from __future__ import annotations

import argparse
import importlib
import os
import statistics
import sys
import time

from tools import extension_zip
from tools.measure import print_table
from tools.timing import sizes
from tools.timing.installed import measured_installed

STEP = 0.02  # scene units that the eye moves from frame to frame


def main(arguments: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vertices", nargs="*", type=int, default=[1000, 10000, 100000])
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--mirror", type=int, default=32, help="rings and segments of the ball (32)")
    parser.add_argument("--method", default="GENERAL", help="the operator's (GENERAL)")
    options = parser.parse_args(arguments)
    rows = measured_installed(options.vertices, lambda count: _measured(count, options))
    import bpy
    print(f"Blender {bpy.app.version_string}, {os.cpu_count()} threads, medians of {options.runs} frames; ratios of "
          "the medians, and the smallest and largest of single frames\n")
    print_table([("vertices", "kept, processor s", "read anew", "anew / kept", "from", "to", "kept s", "Cycles s",
                  "Cycles / kept", "from", "to", "kept MB"), *rows])
    return 0


def _measured(count: int, options: argparse.Namespace) -> list:
    """One row of the table."""
    import bpy
    sizes._scene(count, options.mirror)
    bpy.context.scene.render.use_persistent_data = True
    told = importlib.import_module(extension_zip.PACKAGE + ".addon.standing.told")
    keeping = importlib.import_module(extension_zip.PACKAGE + ".addon.standing.kept")
    camera = bpy.context.scene.camera
    kept, anew, cycles = [], [], []
    for _ in range(1 + options.runs):
        camera.location.x += STEP
        cycles.append(sizes._cycles())
    camera.location.x -= STEP * len(cycles)
    sizes._generate(method=options.method)
    for _ in range(options.runs):
        camera.location.x += STEP
        kept.append(_generated(options.method))
        told._tell(None)
        anew.append(_generated(options.method))
    del cycles[0]
    walls, owns, all_anew = [wall for _, wall in kept], [own for own, _ in kept], [own for own, _ in anew]
    own, from_scratch, mine, theirs = (statistics.median(taken) for taken in (owns, all_anew, walls, cycles))
    return [count, own, from_scratch, from_scratch / own, *sizes._spread(all_anew, owns), mine, theirs, theirs / mine,
            *sizes._spread(cycles, walls), keeping.held_bytes() / 1e6]


def _generated(method: str) -> tuple[float, float]:
    """Processor seconds of a generation, and seconds."""
    started = time.process_time()
    seconds = sizes._generate(method=method)
    return time.process_time() - started, seconds


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
