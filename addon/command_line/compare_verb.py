"""The verb `compare`: reflections or caustics beside Cycles."""
from __future__ import annotations

import argparse
import os

import bpy

from ...core import ReflectionError
from ..operators.compare import RAYS, REFERENCE, WHAT, comparison, means_caustics, remarks_on, summary
from ..operators.compare_light import Effort, light_comparison, light_summary
from ..settings import Wanted
from .options import add_settings, given, text
from .progress import announced


def add_compare(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command, except for its place."""
    add_settings(parser)
    parser.add_argument("--samples", type=int, default=16, metavar="N", help="samples per pixel of the pictures (16)")
    parser.add_argument("--scene-samples", action="store_true",
                        help="sampling, denoising and bounces of the pictures as the scene is set")
    parser.add_argument("--what", choices=[item[0] for item in WHAT], default="AUTO",
                        help="reflections or caustics (else by the selection and what there is)")
    parser.add_argument("--reference", type=int, default=REFERENCE, metavar="N",
                        help=f"of caustics: samples of Cycles' own that all is compared with ({REFERENCE})")
    parser.add_argument("--rays", type=int, default=RAYS, metavar="N",
                        help=f"of caustics: rays traced one by one for each ({RAYS})")
    parser.add_argument("--output", type=text, metavar="FOLDER",
                        help="where pictures and numbers go (else beside the file)")
    parser.set_defaults(work=compare)


def compare(context: bpy.types.Context, options: argparse.Namespace) -> None:
    """Compare, and tell the report in one sentence."""
    folder = options.output or bpy.path.abspath("//reflection comparison")
    if not (options.output or bpy.data.filepath):
        raise ReflectionError("The comparison has no folder: open a .blend file or name one with --output.")
    if min(options.samples, options.reference) < 1:
        raise ReflectionError("A comparison takes at least one sample: raise --samples and --reference.")
    if options.rays < 1:
        raise ReflectionError("A comparison of caustics takes at least one ray: raise --rays.")
    folder = os.path.abspath(folder)
    samples = 0 if options.scene_samples else options.samples
    if options.what == "CAUSTICS" or (options.what == "AUTO" and means_caustics(context)):
        effort = Effort(samples or context.scene.cycles.samples, options.reference, options.rays)
        report, told = announced(light_comparison(context, folder, effort)), light_summary
    else:
        wanted = Wanted(context.scene, given(options))
        report, told = announced(comparison(context, folder, samples, wanted)), summary
    print(*remarks_on(context, report), told(report, folder), sep="\n")
