"""The verb that judges every method on one file, or on several, in one report."""
from __future__ import annotations

import argparse
import os
import time
from collections.abc import Iterator

import bpy

from ... import core
from .. import benchmark
from ..files import staged
from .opening import open_file
from .options import text
from .place import add_place, placed


def add_benchmark(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--output", type=text, metavar="FOLDER", help="where the report goes (else beside the file)")
    verb.add_argument("--methods", nargs="+", default=[], metavar="METHOD", help="all where none is named")
    verb.add_argument("--budget", type=float, default=10.0, metavar="SECONDS",
                      help="for each value of a method's knob: what is expected to take longer is left out (10)")
    verb.add_argument("--resolution", type=int, metavar="PIXELS", help="of the longer side (else the render's)")
    verb.add_argument("--samples", type=int, default=4, metavar="N", help="samples per pixel of the two pictures (4)")
    verb.add_argument("--growth", type=float, default=0.0, metavar="SECONDS",
                      help="measure growth too: each method as long as a point takes no more than this")
    verb.add_argument("--no-work", action="store_true", help="leave out the counts on the talk's setting")
    verb.add_argument("--scenes", type=text, nargs="+", default=[], metavar="FILE",
                      help="one report of these files, opened one after another, instead of the open one")
    add_place(verb)
    verb.set_defaults(work=_benchmark)


def _benchmark(context: bpy.types.Context, options: argparse.Namespace) -> None:
    started = time.perf_counter(), time.process_time()
    if not (options.output or bpy.data.filepath):
        raise core.ReflectionError("The benchmark has no folder: open a .blend file or name one with --output.")
    folder = os.path.abspath(options.output or bpy.path.abspath("//reflection benchmark"))
    chosen = benchmark.Options(tuple(options.methods), options.budget, options.resolution, options.samples,
                               growth=options.growth, work=not options.no_work, tell=_tell)
    with staged(folder) as scratch:
        scenes = []
        for name, inner in _opened(options.scenes):
            with placed(bpy.context, options):
                scenes.append(benchmark.scene_report(bpy.context, name, os.path.join(scratch, inner), chosen))
        benchmark.write_benchmark(scratch, scenes, chosen, started)
    for scene in scenes:
        print(f"{scene.name}: {scene.summary[0]}")
    print(os.path.join(folder, "report.html"))


def _opened(files: list[str]) -> Iterator[tuple[str, str]]:
    """Open one file after another: each one's name, and the folder of its pictures; the open file alone where none."""
    if not files:
        yield os.path.splitext(os.path.basename(bpy.data.filepath))[0] or "scene", ""
    for path in files:
        open_file(path)
        name = os.path.splitext(os.path.basename(path))[0]
        yield name, name


def _tell(line: str) -> None:
    print(line, flush=True)
