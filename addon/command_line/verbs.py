"""`blender -b scene.blend --command reflection_mesh generate|light|bake|compare ...`, and the same for PyPI's bpy."""
from __future__ import annotations

import argparse
import os
import sys
import time
from contextlib import nullcontext
from dataclasses import replace

import bpy

from ... import core
from ..faults import STATUS, gathered, sentence
from ..files import check_place, save_blend
from ..illumination import chosen_lamps
from ..operators.caustics import asked_again, remember, throwing
from ..operators.clear import chosen_results
from ..operators.generate import generation
from ..operators.light import lighting_groups
from ..operators.light_remarks import summary as lighting_summary
from ..operators.light_remarks import unlike_the_mirror
from ..operators.mirror_uvs import FRAMES, TARGETS, Choices, map_settings, mapping
from ..operators.print_sheet import DPI, check_print, printing
from ..operators.rounding import rounding_remarks
from ..operators.shortcomings import other_meshes, scene_shortcomings
from ..reading import Participants, choose, seen_by_camera, shown_by, with_copies, without_shadow_catchers
from ..settings import Wanted
from .bake_verb import add_bake
from .benchmark_verb import add_benchmark
from .compare_verb import add_compare
from .opening import open_file
from .options import add_own, add_settings, add_written, given, text
from .place import add_place, placed
from .progress import announced

COMMAND = "reflection_mesh"
FILES = object()    # `--light` without a number: the samples that the file holds
_commands = []


def run(arguments: list[str], scene: str | None = None) -> int:
    """Run one verb on the open file, or on the one at `scene`; returns the exit status, 0 only on success."""
    try:
        options = _parser().parse_args(arguments)
    except SystemExit as stop:
        # asking for help is a success, a wrong argument is not; argparse has said what is wrong
        return int(stop.code or 0)
    options.words = arguments
    try:
        if scene is not None:
            open_file(scene)
        with placed(bpy.context, options) if options.verb != "benchmark" else nullcontext():
            options.work(bpy.context, options)
    except KeyboardInterrupt:
        print(getattr(options, "interrupted", "Interrupted: nothing has been saved."), file=sys.stderr)
        return STATUS
    except Exception as error:
        print(f"Error: {sentence(error, repr(options.verb), 'nothing has been saved')}", file=sys.stderr)
        return 1
    return 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog=COMMAND, description="Mirror reflections computed forward, as meshes.")
    verbs = parser.add_subparsers(dest="verb", required=True, metavar="verb")
    generate = verbs.add_parser("generate", help="generate the reflections and save the file")
    add_settings(generate)
    add_written(generate)
    _add_participants(generate)
    generate.add_argument("--light", type=int, nargs="?", const=FILES, default=0, metavar="N",
                          help="light them too, with N samples per pixel (else the file's)")
    _add_output(generate)
    generate.set_defaults(work=_generate)
    light = verbs.add_parser("light", help="let the reflections look as the mirrors do, and save the file")
    light.add_argument("--samples", type=int, metavar="N", help="samples per pixel (else the file's)")
    _add_output(light)
    light.set_defaults(work=_light)
    caustics = verbs.add_parser("caustics", help="generate the light that mirrors throw, and save the file")
    _add_caustics(caustics)
    compare = verbs.add_parser("compare", help="compare with a Cycles render of the same view")
    add_compare(compare)
    baked = verbs.add_parser("bake", help="write a range of frames to files, and a file that plays them")
    add_settings(baked, of_farms=True)
    add_bake(baked)
    maps = verbs.add_parser(
        "mirror-uvs", help="write UV maps by which a picture looks right in the mirror alone, and save the file")
    _add_anamorphosis(maps)
    for verb in (generate, light, caustics, compare, maps):
        add_place(verb)
    add_place(baked, frame=False)
    add_benchmark(verbs.add_parser("benchmark", help="every method's error and seconds, judged by Cycles"))
    return parser


def _add_caustics(verb: argparse.ArgumentParser) -> None:
    _add_participants(verb)
    verb.add_argument("--eyes", type=int, metavar="N",
                      help="places on each lamp that its light comes from (else as before, or 1)")
    add_settings(verb, ("tolerance", "depth", "memory"))
    add_own(verb)
    _add_output(verb)
    verb.set_defaults(work=_caustics)


def _add_anamorphosis(verb: argparse.ArgumentParser) -> None:
    _add_participants(verb)
    verb.add_argument("--target", choices=[item[0] for item in TARGETS], default="COPY",
                      help="on copies that are cut, or on the objects themselves (COPY)")
    verb.add_argument("--fills", choices=[item[0] for item in FRAMES], default="CAMERA",
                      help="what the picture fills (CAMERA)")
    verb.add_argument("--picture", type=text, metavar="FILE", help="image file, or image of the file, for the copies")
    verb.add_argument("--print", dest="sheet", type=text, metavar="FILE",
                      help="save the sheet, if it is one, as .png or .svg")
    verb.add_argument("--dpi", type=float, default=DPI, help=f"dots per inch of the print ({DPI:g})")
    add_settings(verb, ("tolerance", "memory"))
    _add_output(verb)
    verb.set_defaults(work=_mirror_uvs)


def _add_participants(verb: argparse.ArgumentParser) -> None:
    verb.add_argument("--mirror", type=text, nargs="+", default=[], metavar="NAME",
                      help="mirror objects (else by selection and role, as in the window)")
    verb.add_argument("--diffuse", type=text, nargs="+", default=[], metavar="NAME",
                      help="reflected objects (else, of mirrors that are named, whatever is there)")


def _add_output(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--output", type=text, metavar="FILE", help="save here, and leave the opened file as it is")


def _generate(context: bpy.types.Context, options: argparse.Namespace) -> None:
    path = _path_to_save(options)
    if options.light is not FILES and options.light < 0:
        raise core.ReflectionError("Light takes at least one sample: raise --light.")
    started = time.perf_counter()
    wanted, chosen = Wanted(context.scene, given(options)), _chosen(context, options)
    outcome = announced(generation(context, chosen, wanted, preview=True))
    if options.light:
        outcome = replace(outcome, unlit=[], dropped=[])   # their light comes next
    lacks = scene_shortcomings(context, chosen, wanted)
    # the view layer knows new objects only from its next update on
    context.view_layer.update()
    lacks += rounding_remarks(context, [obj for obj, _ in outcome.results])
    told = [*gathered([*outcome.news, *outcome.remarks, *outcome.dropped, *lacks]),
            outcome.summary(time.perf_counter() - started)]
    if options.light:
        samples = None if options.light is FILES else options.light
        told.append(_lit(context, [obj for obj, _ in outcome.results], samples))
    save_blend(path)
    print(*told, sep="\n")


def _light(context: bpy.types.Context, options: argparse.Namespace) -> None:
    path = _path_to_save(options)
    if options.samples is not None and options.samples < 1:
        raise core.ReflectionError("Light takes at least one sample: raise --samples.")
    told = _lit(context, chosen_results(context), options.samples)
    save_blend(path)
    print(told)


def _caustics(context: bpy.types.Context, options: argparse.Namespace) -> None:
    path = _path_to_save(options)
    started = time.perf_counter()
    chosen, lamps = _chosen(context, options, unmirrored=True), chosen_lamps(context)
    wanted = Wanted(context.scene, given(options))
    asked = asked_again(context, chosen, lamps, wanted, (options.eyes, options.leave_out))
    thrown = announced(throwing(context, chosen, lamps, asked))
    remember(thrown.objects, asked)
    save_blend(path)
    context.view_layer.update()
    told = thrown.remarks + other_meshes(context.scene, chosen.mirrors + chosen.diffuse)
    told += rounding_remarks(context, thrown.objects)
    print(*gathered(told), thrown.summary(time.perf_counter() - started), sep="\n")


def _mirror_uvs(context: bpy.types.Context, options: argparse.Namespace) -> None:
    path = _path_to_save(options)
    sheet = os.path.abspath(options.sheet) if options.sheet else None
    if sheet is not None:
        check_print(sheet, options.dpi)
    started = time.perf_counter()
    chosen = _chosen(context, options)
    settings = map_settings(Wanted(context.scene, given(options)), chosen)
    choices = Choices(options.target, options.fills, options.picture or "")
    outcome = announced(mapping(context, chosen, settings, choices))
    told = [*gathered(outcome.remarks), outcome.summary(time.perf_counter() - started)]
    if sheet is not None:
        if len(outcome.objects) > 1:
            raise core.ReflectionError("One sheet is printed at a time: name it with --mirror and --diffuse.")
        context.view_layer.update()
        told.append(announced(printing(context, outcome.objects[0], sheet, dpi=options.dpi)))
    save_blend(path)
    print(*told, sep="\n")


def _lit(context: bpy.types.Context, results: list, samples: int | None) -> str:
    started = time.perf_counter()
    wanted = Wanted(context.scene, given(argparse.Namespace(), light_samples=samples))
    lit = announced(lighting_groups(context, wanted.lights(with_copies(context, results))))
    return "\n".join([*unlike_the_mirror(context, lit), lighting_summary(lit, time.perf_counter() - started)])


def _path_to_save(options: argparse.Namespace) -> str:
    """Return the path for saving the file. Check that it is writable and ends with .blend, not e.g. as a picture or a
    page.
    """
    if not (options.output or bpy.data.filepath):
        raise core.ReflectionError("There is no file to save to: open a .blend file or name one with --output.")
    path = os.path.abspath(options.output or bpy.data.filepath)
    check_place(path)
    if options.output and not path.lower().endswith(".blend"):
        raise core.ReflectionError(f"'{path}' is not the name of a .blend file: let it end so.")
    return path


def _chosen(context: bpy.types.Context, options: argparse.Namespace, unmirrored: bool = False) -> Participants:
    """Return the objects named in the options, or those chosen by selection and roles; `unmirrored` as in `choose`."""
    if not (options.mirror or options.diffuse):
        return choose(context, unmirrored=unmirrored)
    if not options.mirror:
        raise core.ReflectionError("Name the mirrors too, with --mirror.")
    objects = context.view_layer.objects
    missing = [name for name in options.mirror + options.diffuse if name not in objects]
    if missing:
        raise core.ReflectionError(f"There is no object '{missing[0]}' in the view layer: check its name.")
    both = set(options.mirror) & set(options.diffuse)
    if both:
        raise core.ReflectionError(f"'{min(both)}' is named both as a mirror and as reflected: name it once.")
    mirrors = [objects[name] for name in options.mirror]
    if not options.diffuse:
        return seen_by_camera(context, mirrors, shown_by(context, mirrors, unmirrored=unmirrored), unmirrored)
    mirrors, caught = (mirrors, []) if unmirrored else without_shadow_catchers(mirrors)
    return Participants(mirrors, [objects[name] for name in options.diffuse], [], caught=caught)


def register() -> None:
    _commands.append(bpy.utils.register_cli_command(COMMAND, run))


def unregister() -> None:
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
