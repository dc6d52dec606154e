"""`blender -b scene.blend --command reflection_mesh generate|compare|benchmark ...`, and the same for PyPI's bpy."""
from __future__ import annotations

import argparse
import os
import sys
import time

import bpy

from .. import core
from . import benchmark
from .compare import compare
from .compare import summary as comparison
from .generate import Outcome, generation
from .properties import METHODS, PLACEMENTS
from .roles import Participants, choose

COMMAND = "reflection_mesh"
_commands = []


def run(arguments: list[str]) -> int:
    """Run one verb on the open file; returns the exit status, 0 only on success."""
    try:
        options = _parser().parse_args(arguments)
    except SystemExit as stop:
        # asking for help is a success, a wrong argument is not; argparse has said what is wrong
        return int(stop.code or 0)
    try:
        options.work(bpy.context, options)
    except (core.ReflectionError, RuntimeError, OSError, MemoryError) as error:
        print(f"Error: {str(error).removeprefix('Error: ').strip() or 'the memory does not suffice'}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=COMMAND, description="Mirror reflections computed forward, as meshes.")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="verb")
    generate = verbs.add_parser("generate", help="generate the reflections and save the file")
    _add_settings(generate)
    generate.add_argument("--mirror", nargs="+", default=[], metavar="NAME",
                          help="mirror objects (else by selection and role, as in the window)")
    generate.add_argument("--diffuse", nargs="+", default=[], metavar="NAME", help="diffuse objects")
    generate.add_argument("--output", metavar="FILE", help="save here, and leave the opened file as it is")
    generate.set_defaults(work=_generate)
    compare = verbs.add_parser("compare", help="compare with a Cycles render of the same view")
    _add_settings(compare)
    compare.add_argument("--samples", type=int, default=16, metavar="N", help="samples per pixel of the pictures")
    compare.add_argument("--scene-samples", action="store_true",
                         help="sampling, denoising and bounces of the pictures as the scene is set")
    compare.add_argument("--output", metavar="FOLDER", help="where pictures and numbers go (else beside the file)")
    compare.set_defaults(work=_compare)
    _add_benchmark(verbs.add_parser("benchmark", help="every method's error and seconds, judged by Cycles"))
    return parser


def _add_benchmark(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--output", metavar="FOLDER", help="where the report goes (else beside the file)")
    verb.add_argument("--methods", nargs="+", default=[], metavar="METHOD", help="all where none is named")
    verb.add_argument("--budget", type=float, default=10.0, metavar="SECONDS",
                      help="for each value of a method's knob: what is expected to take longer is left out (10)")
    verb.add_argument("--resolution", type=int, metavar="PIXELS", help="of the longer side (else the render's)")
    verb.add_argument("--samples", type=int, default=4, metavar="N", help="samples per pixel of the two pictures (4)")
    verb.add_argument("--growth", type=float, default=0.0, metavar="SECONDS",
                      help="measure growth too: each method as long as a point takes no more than this")
    verb.add_argument("--no-work", action="store_true", help="leave out the counts on the talk's setting")
    verb.add_argument("--scenes", nargs="+", default=[], metavar="FILE",
                      help="one report of these files, opened one after another, instead of the open one")
    verb.set_defaults(work=_benchmark)


def _add_settings(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--tolerance", type=float, default=0.5, metavar="PIXELS")
    parser.add_argument("--placement", choices=[item[0] for item in PLACEMENTS], default="LAYERED")
    parser.add_argument("--method", choices=[item[0] for item in METHODS], default="GENERAL")
    parser.add_argument("--depth", type=int, default=1, metavar="BOUNCES", help="followed from mirror to mirror")


def _settings(options: argparse.Namespace) -> core.Settings:
    try:
        return core.Settings(options.tolerance, options.placement, options.method, options.depth)
    except ValueError as error:
        raise core.ReflectionError(str(error)) from error


def _generate(context: bpy.types.Context, options: argparse.Namespace) -> None:
    if not (options.output or bpy.data.filepath):
        raise core.ReflectionError("There is no file to save to: open a .blend file or name one with --output.")
    started = time.perf_counter()
    settings = _settings(options)
    outcome = _announced(generation(context, _chosen(context, options), settings))
    if options.output:
        bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath(options.output), copy=True)
    else:
        bpy.ops.wm.save_mainfile()
    for remark in outcome.remarks:
        print(remark)
    print(outcome.summary(time.perf_counter() - started))


def _announced(steps) -> Outcome:
    """Run a generator of progress to its end, printing each stage once; returns what it returns."""
    told = None
    while True:
        try:
            fraction, stage = next(steps)
        except StopIteration as stop:
            return stop.value
        if stage != told:
            print(f"{100.0 * fraction:3.0f} %  {stage}", flush=True)
            told = stage


def _chosen(context: bpy.types.Context, options: argparse.Namespace) -> Participants:
    """The objects named, or those that the selection and the roles choose."""
    if not (options.mirror or options.diffuse):
        return choose(context)
    if not (options.mirror and options.diffuse):
        raise core.ReflectionError("Name both: the mirrors with --mirror and the objects to reflect with --diffuse.")
    objects = context.view_layer.objects
    missing = [name for name in options.mirror + options.diffuse if name not in objects]
    if missing:
        raise core.ReflectionError(f"There is no object '{missing[0]}' in the view layer: check its name.")
    both = set(options.mirror) & set(options.diffuse)
    if both:
        raise core.ReflectionError(f"'{min(both)}' is named both as a mirror and as a diffuse object: name it once.")
    return Participants([objects[name] for name in options.mirror], [objects[name] for name in options.diffuse], [])


def _compare(context: bpy.types.Context, options: argparse.Namespace) -> None:
    folder = options.output or bpy.path.abspath("//reflection comparison")
    if not (options.output or bpy.data.filepath):
        raise core.ReflectionError("The comparison has no folder: open a .blend file or name one with --output.")
    if options.samples < 1:
        raise core.ReflectionError("A comparison takes at least one sample: raise --samples.")
    folder = os.path.abspath(folder)
    samples = 0 if options.scene_samples else options.samples
    print(comparison(compare(context, folder, samples, _settings(options)), folder))


def _benchmark(context: bpy.types.Context, options: argparse.Namespace) -> None:
    started = time.perf_counter(), time.process_time()
    if not (options.output or bpy.data.filepath):
        raise core.ReflectionError("The benchmark has no folder: open a .blend file or name one with --output.")
    folder = os.path.abspath(options.output or bpy.path.abspath("//reflection benchmark"))
    chosen = benchmark.Options(tuple(options.methods), options.budget, options.resolution, options.samples, _tell)
    files = [os.path.abspath(path) for path in options.scenes]
    scenes = []
    for path in files or [bpy.data.filepath]:
        if files:
            bpy.ops.wm.open_mainfile(filepath=path, use_scripts=False)
        name = os.path.splitext(os.path.basename(path))[0] or "scene"
        scenes.append(benchmark.scene_report(bpy.context, name, os.path.join(folder, name) if files else folder,
                                             chosen))
    benchmark.write_benchmark(folder, scenes, chosen, growth=options.growth, work=not options.no_work, since=started,
                              tell=_tell)
    for scene in scenes:
        print(f"{scene.name}: {scene.summary[0]}")
    print(os.path.join(folder, "report.html"))


def _tell(line: str) -> None:
    print(line, flush=True)


def register() -> None:
    _commands.append(bpy.utils.register_cli_command(COMMAND, run))


def unregister() -> None:
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
