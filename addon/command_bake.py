"""The verb `bake`: on one machine, or in chunks of frames on as many as there are, in any order."""
from __future__ import annotations

import argparse
import os
import time

import bpy

from ..core import ReflectionError
from .bake import FOLDER, baking, blur_remarks, plan_of, playing, summary
from .command_place import camera_of
from .command_progress import announced
from .command_settings import given, whole_number
from .files import check_place, chosen_folder, save_blend
from .frames import FrameRecord
from .settings import Wanted

INTERRUPTED = "Interrupted: the frames that are done stay, and the same command goes on with the others."


def add_bake(parser: argparse.ArgumentParser) -> None:
    """The options of the verb, but for settings and place."""
    parser.add_argument("--frames", "--frame", default="", metavar="LIST",
                        help="as 1-24, or 1-100:2 with a step, or 3,5-10 (else the scene's range)")
    parser.add_argument("--camera", nargs="+", default=[], metavar="NAME",
                        help="the cameras, each with a sequence of its own (else the scene's, by its markers)")
    parser.add_argument("--light", type=whole_number, metavar="N",
                        help="samples per pixel of what needs light (else the file's); 0 for none")
    parser.add_argument("--overwrite", action="store_true", help="make again the frames that are there already")
    parser.add_argument("--frames-only", action="store_true", help="write no file that plays them")
    parser.add_argument("--progress", choices=("WORDS", "OPENJD"), default="WORDS",
                        help="how progress is told: OPENJD as workers of Open Job Description read it")
    parser.add_argument("--output", metavar="FOLDER", help="where the frames go (else beside the file)")
    parser.set_defaults(work=bake, interrupted=INTERRUPTED)


def bake(context: bpy.types.Context, options: argparse.Namespace) -> None:
    """Bake what is missing; then save a copy of the file that plays it, unless that is not wanted."""
    started = time.perf_counter()
    if options.light is not None and options.light < 0:
        raise ReflectionError("Light takes no less than 0 samples: raise --light.")
    folder = os.path.abspath(options.output) if options.output else chosen_folder(FOLDER)
    scene = context.scene
    cameras = tuple(camera_of(scene, name) for name in dict.fromkeys(options.camera))
    wanted = Wanted(scene, given(options, light_samples=options.light))
    plan = plan_of(context, folder, options.frames, wanted, cameras=cameras, overwrite=options.overwrite)
    done: list = []

    def tell(record: FrameRecord) -> None:
        done.append(record)
        # as Blender tells of pictures: workers of Flamenco read it
        print(*(f"Saved: '{os.path.join(folder, file)}'" for file in record.files), sep="\n", flush=True)
    sequences = announced(baking(context, plan, tell), options.progress)
    told = blur_remarks(scene, cameras)
    if not options.frames_only:
        playing(context, sequences)
        stem = os.path.splitext(os.path.basename(bpy.data.filepath))[0] or "scene"
        path = os.path.join(folder, f"{stem} reflections.blend")
        check_place(path)
        save_blend(path)
        told.append(f"Saved: '{path}'")
    print(*told, summary(plan, len(done), time.perf_counter() - started), sep="\n", flush=True)
