"""The verb `bake`: on one machine, or in chunks of frames on as many as there are, in any order."""
from __future__ import annotations

import argparse
import os
import time
from itertools import chain

import bpy

from ...core import ReflectionError
from ..faults import gathered
from ..files import check_place, chosen_folder, save_blend
from ..frames import FrameRecord
from ..illumination import meant_lamps
from ..operators.bake_frames import (
    FOLDER,
    WHAT,
    Plan,
    baking_layers,
    chosen_frames,
    empty_remarks,
    layer_remarks,
    plan_of,
    scene_remarks,
    show_layers,
    side_by_side,
    summary,
)
from ..settings import Wanted
from .options import Names, add_own, given, text, whole_number
from .place import camera_of, forget_chance, layer_of
from .progress import announced

INTERRUPTED = "Interrupted: the frames that are done stay, and the same command goes on with the others."


def add_bake(parser: argparse.ArgumentParser) -> None:
    """Add the options of the command, except for settings and place."""
    parser.add_argument("--frames", "--frame", type=text, metavar="LIST",
                        help="as 1-24, or 1-100:2 with a step, or 3,5-10 (else the scene's range)")
    parser.add_argument("--camera", action=Names, nargs="+", default=[], metavar="NAME",
                        help="the cameras, each with a sequence of its own (else the scene's, by its markers)")
    parser.add_argument("--what", choices=[item[0] for item in WHAT], default="REFLECTIONS",
                        help="reflections, or the light of lamps that mirrors throw")
    parser.add_argument("--eyes", type=whole_number, metavar="N",
                        help="places on each lamp that its caustics come from (else as they were generated)")
    add_own(parser)
    parser.add_argument("--view-layer", action=Names, nargs="+", default=[], metavar="NAME",
                        help="the view layers, each with a sequence of its own, that the others do not show (else the "
                        "file's own)")
    parser.add_argument("--light", type=whole_number, metavar="N",
                        help="samples per pixel of what needs light (else the file's); 0 for none")
    parser.add_argument("--overwrite", action="store_true", help="make again the frames that are there already")
    parser.add_argument("--frames-only", action="store_true", help="write no file that plays them")
    parser.add_argument("--jobs", type=int, default=1, metavar="N",
                        help="so many processes side by side, each with the memory of one (1)")
    parser.add_argument("--progress", choices=("WORDS", "OPENJD"), default="WORDS",
                        help="how progress is told: OPENJD as workers of Open Job Description read it")
    parser.add_argument("--output", type=text, metavar="FOLDER", help="where the frames go (else beside the file)")
    parser.set_defaults(work=bake, interrupted=INTERRUPTED)


def bake(context: bpy.types.Context, options: argparse.Namespace) -> None:
    """Bake the missing frames. Then save a copy of the file that plays them, unless it is not wanted."""
    started = time.perf_counter()
    _check(options)
    thrown = options.what == "CAUSTICS"
    folder = os.path.abspath(options.output) if options.output else chosen_folder(FOLDER)
    path = _player_path(folder, options)
    scene = context.scene
    cameras = tuple(camera_of(scene, name) for name in dict.fromkeys(options.camera))
    layers = [layer_of(scene, name) for name in dict.fromkeys(options.view_layer)] or [context.view_layer]
    wanted = Wanted(scene, given(options, light_samples=options.light))
    done: list = []
    remarks: list = []

    def tell(record: FrameRecord) -> None:
        done.append(record)
        # same form as Blender's message on images, which workers of Flamenco parse
        print(*(f"Saved: '{os.path.join(folder, file)}'" for file in record.files), sep="\n", flush=True)
    elsewhere = _made_side_by_side(scene, folder, options) if options.jobs > 1 else 0

    def planned(layer: str) -> Plan:
        forget_chance(context)
        # skip frames that other processes have just baked
        return plan_of(context, folder, options.frames or "", wanted, cameras=cameras, layer=layer,
                       overwrite=options.overwrite and options.jobs == 1, eyes=options.eyes or 0,
                       lamps=tuple(meant_lamps(context)) if thrown else (), leave_out=options.leave_out)
    made = announced(baking_layers(context, layers, planned, tell, remarks.append), options.progress)
    told = remarks + scene_remarks(context, cameras, thrown)
    told += layer_remarks(scene, layers)
    if not options.frames_only:
        # a chunk of a farm does not know the other frames
        told += empty_remarks(list(chain.from_iterable(baked.sequences for baked in made)))
        told += show_layers(context, made)[1]
        save_blend(path)
        told.append(f"Saved: '{path}'")
    plans = [baked.plan for baked in made]
    print(*gathered(told), summary(plans, elsewhere + len(done), time.perf_counter() - started), sep="\n", flush=True)


def _check(options: argparse.Namespace) -> None:
    if options.light is not None and options.light < 0:
        raise ReflectionError("Light takes no less than 0 samples: raise --light.")
    if options.eyes is not None and options.eyes < 1:
        raise ReflectionError("Light comes from one place of each lamp at least: raise --eyes.")
    if options.eyes is not None and options.what != "CAUSTICS":
        raise ReflectionError("Only light that mirrors throw comes from places on lamps: add --what CAUSTICS, or leave "
                              "--eyes out.")
    if options.jobs < 1:
        raise ReflectionError("Frames are baked by one process at least: raise --jobs.")


def _player_path(folder: str, options: argparse.Namespace) -> str:
    """Return the path of the file that plays the frames. Check in advance that it can be saved."""
    stem = os.path.splitext(os.path.basename(bpy.data.filepath))[0] or "scene"
    path = os.path.join(folder, f"{stem} {options.what.lower()}.blend")
    if os.path.isdir(folder) and not options.frames_only:
        check_place(path)
    return path


def _made_side_by_side(scene: bpy.types.Scene, folder: str, options: argparse.Namespace) -> int:
    """Bake the frames in `options.jobs` processes and print their progress.

    Frames that exist already are kept, unless `--overwrite` was given.

    Parameters
    ----------
    scene : bpy.types.Scene
        Its frame range is used if the options contain no frames.
    folder : str
        Absolute path for the files of the frames.
    options : argparse.Namespace

    Returns
    -------
    int
        Number of frames that the processes have written, added up over cameras and view layers.

    Raises
    ------
    ReflectionError
        If a process fails, with the message of the first one that does. The others are ended; written frames stay.
    KeyboardInterrupt
        If a process was interrupted.
    """
    steps = side_by_side([*options.words, "--output", folder], chosen_frames(scene, options.frames or ""), options.jobs,
                         lambda line: print(line, flush=True))
    return announced(steps, options.progress)
