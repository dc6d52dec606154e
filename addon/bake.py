"""The operator that bakes: a range of frames as files, and results that play them without this extension."""
from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict, dataclass

import bpy

from .. import core
from . import compat, polls
from .clear import clear
from .faults import AllOrNothing, BrowsingOperator, Steps, interrupt_held, part, still_there
from .files import chosen_folder, staged
from .frames import (
    FrameRecord,
    Sequence,
    file_name,
    frame_numbers,
    frame_text,
    is_done,
    light_of,
    play,
    player_of,
    read_record,
    record_path,
    set_aside,
    show_by_camera,
    write_image,
    write_record,
    write_result,
    writes_usd,
)
from .generate import generation
from .light import lighting
from .reading import NothingSeen, candidates, choose, read_view, render_size, visible
from .settings import SAMPLES, SETTINGS, SettingsOfMirrors, SettingsOptions, UsesSettings, Wanted, of_each, option

FOLDER = "//reflection frames"
IN_OBJECT_MODE = "Reflections are baked in Object Mode: leave the present mode first."
NO_USD = "This Blender cannot write USD files: bake with one that can."


@dataclass(frozen=True)
class Plan:
    """What is to be baked.

    Attributes
    ----------
    folder : str
        Absolute path.
    frames : list of int
    settings : core.Settings, or a function that gives those of a mirror
    samples : int
        Of light per pixel; 0 for none.
    cameras : list of bpy.types.Object
        One sequence for each; empty: one by the scene's own camera, which its markers may change.
    overwrite : bool
        Make again what is there; else it is kept, where it was made with the same settings.
    """

    folder: str
    frames: list[int]
    settings: core.Settings | SettingsOfMirrors
    samples: int = SAMPLES
    cameras: tuple = ()
    overwrite: bool = False

    @property
    def takes(self) -> list:
        """(name, camera or None) of each sequence."""
        names = [camera.name if len(self.cameras) > 1 else "" for camera in self.cameras]
        return list(zip(names, self.cameras, strict=True)) or [("", None)]

    def made_with(self, context: bpy.types.Context, camera: bpy.types.Object | None, mirrors: list) -> dict:
        """What a frame depends on, besides what is in the file; by name, the settings of mirrors with their own."""
        settings = _plain(of_each(self.settings)(None))
        each = {mirror.name: _plain(of_each(self.settings)(mirror)) for mirror in mirrors}
        own = {name: values for name, values in each.items() if values != settings}
        return {**settings, **({"own": own} if own else {}), "samples": self.samples,
                "camera": camera.name if camera else "",
                "scene": context.scene.name, "view_layer": context.view_layer.name,
                "resolution": "{} x {}".format(*render_size(context.scene))}


def _plain(settings: core.Settings) -> dict:
    return {name: value for name, value in asdict(settings).items() if isinstance(value, str | int | float)}


def baking(context: bpy.types.Context, plan: Plan, tell: Callable[[FrameRecord], None] = lambda record: None
           ) -> Steps[list]:
    """Bake all frames of a plan, yielding (fraction, stage); closed at any step, the file is as it was, and the frames
    that are done stay in their folder.

    Parameters
    ----------
    tell : callable
        Is given the record of each frame that is done.

    Returns
    -------
    sequences : list of Sequence
        What `playing` lets the file play.

    Raises
    ------
    core.ReflectionError
        Where a frame cannot be baked.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    if not writes_usd():
        raise core.ReflectionError(NO_USD)
    mirrors, diffuse = candidates(context)
    if not (mirrors and diffuse):
        choose(context)     # which says what is missing
    if not plan.cameras:
        read_view(context)
    takes = plan.takes
    share = 1.0 / (len(takes) * len(plan.frames))
    found = [_found(context, plan, take, mirrors) for take in takes]
    with set_aside(context, mirrors):
        for index, ((name, camera), known) in enumerate(zip(takes, found)):
            for number, frame in enumerate(plan.frames):
                start = (index * len(plan.frames) + number) * share
                yield start, f"Frame {frame} {name}".strip()
                if known[frame] is None:
                    with interrupt_held():
                        context.scene.frame_set(frame)
                    if camera is not None:
                        context.scene.camera = camera
                    steps = _frame(context, plan, (name, camera), (mirrors, diffuse))
                    known[frame] = yield from part(steps, start, share, f"Frame {frame}")
                    tell(known[frame])
    placements = {mirror.name: of_each(plan.settings)(mirror).placement for mirror in mirrors}
    return [Sequence(plan.folder, [known[frame] for frame in plan.frames], name, placements)
            for (name, _), known in zip(takes, found)]


def _found(context: bpy.types.Context, plan: Plan, take: tuple, mirrors: list) -> dict:
    """The frames of a sequence that are there already, and None for those that are to be made."""
    name, camera = take
    known: dict = dict.fromkeys(plan.frames)
    if plan.overwrite:
        return known
    made_with = plan.made_with(context, camera, mirrors)
    for frame in plan.frames:
        record = read_record(record_path(plan.folder, name, frame))
        if not is_done(plan.folder, record):
            continue
        if record.made_with != made_with or set(record.results) != {mirror.name for mirror in mirrors}:
            raise core.ReflectionError(f"Frame {frame} in '{plan.folder}' was baked with other settings or mirrors: "
                                       "overwrite it, or choose another folder.")
        known[frame] = record
    return known


def _frame(context: bpy.types.Context, plan: Plan, take: tuple, everything: tuple) -> Steps[FrameRecord]:
    """Make the open frame: its files take their places when all of them are whole, and its record last."""
    name, camera = take
    frame = context.scene.frame_current
    mirrors, diffuse = everything
    with AllOrNothing() as whole:
        results: list = []
        whole.undo(_clear, context, results)
        yield from part(_results(context, plan, visible_or_none(context, mirrors, diffuse), results), 0.0, 0.95)
        by_mirror = {obj.reflection_mesh.mirror: obj for obj in results}
        yield 0.95, "Writing"
        lit = [obj.reflection_mesh.light_material for obj in results if obj.reflection_mesh.light_material]
        image = file_name(f"Light {name}".strip(), frame, "exr") if lit else ""
        made = {}
        place = record_path(plan.folder, name, frame)
        with staged(plan.folder) as scratch:
            for mirror in mirrors:
                result = by_mirror.get(mirror)
                file = file_name(f"{mirror.name} Reflection {name}".strip(), frame, "usdc")
                made[mirror.name] = write_result(context, result, os.path.join(scratch, file), result is not None
                                                 and result.reflection_mesh.light_material is not None)
            if image:
                write_image(lit[0], os.path.join(scratch, image))
            # from here on the frame is not done until it has a record again
            with suppress(FileNotFoundError):
                os.unlink(place)
        record = FrameRecord(frame, plan.made_with(context, camera, mirrors), made, image)
        with staged(plan.folder) as scratch:
            write_record(os.path.join(scratch, os.path.basename(place)), record)
        _clear(context, results)
    return record


def visible_or_none(context: bpy.types.Context, mirrors: list, diffuse: list):
    """Who takes part in the open frame; None where all mirrors or all else are hidden."""
    try:
        return visible(context, mirrors, diffuse)
    except NothingSeen:
        return None


def _results(context: bpy.types.Context, plan: Plan, chosen, results: list) -> Steps[None]:
    """Generate and light the open frame, adding to `results` as soon as they are there; none where nothing is seen."""
    if chosen is None:
        return
    try:
        outcome = yield from part(generation(context, chosen, plan.settings), 0.0, 0.5 if plan.samples else 1.0)
    except NothingSeen:
        return
    results += [obj for obj, _ in outcome.results]
    context.view_layer.update()
    if plan.samples:
        yield from part(lighting(context, results, plan.samples, "PICTURE"), 0.5, 0.5)


def _clear(context: bpy.types.Context, results: list) -> None:
    clear(context, still_there(results))


def playing(context: bpy.types.Context, sequences: list[Sequence]) -> list:
    """Let the results of the file play sequences: all or none of them; returns the objects."""
    mirrors, diffuse = candidates(context)
    with AllOrNothing() as whole:
        players = [player_of(sequence, mirror, light, whole)
                   for sequence in sequences for light in [light_of(sequence, whole)] for mirror in mirrors]
        shown = [(play(context, player, diffuse, whole), player.sequence.name) for player in players]
        if len(sequences) > 1:
            show_by_camera(context.scene, shown)
    return [obj for obj, _ in shown]


def blur_remarks(scene: bpy.types.Scene, cameras: tuple) -> list[str]:
    """What baked reflections cannot do of what the scene asks for, in sentences."""
    told = []
    if scene.render.use_motion_blur:
        told.append("Motion blur: reflections are sharp, since their faces change from frame to frame; blur them after "
                    "the render, or render in-between frames and mix them.")
    marked = [marker.camera for marker in scene.timeline_markers if marker.camera]
    if any(camera and camera.type == "CAMERA" and camera.data.dof.use_dof
           for camera in (cameras or [scene.camera, *marked])):
        told.append("Depth of field: the camera focuses on the mirror and not on what it shows; choose the placement "
                    "Virtual for flat mirrors, or blur after the render.")
    return told


def summary(plan: Plan, made: int, seconds: float) -> str:
    """One line on what was baked."""
    frames = len(plan.frames) * len(plan.takes)
    return f"{made} of {frames} frame{'' if frames == 1 else 's'} baked into '{plan.folder}', {seconds:.2f} s"


class REFLECTION_MESH_OT_bake(UsesSettings, BrowsingOperator, SettingsOptions, bpy.types.Operator):
    """Write the reflections of a range of frames to files, and let them play; they need no extension to be seen"""

    bl_idname = "reflection_mesh.bake"
    bl_label = "Bake Reflection Frames"
    bl_options = {"REGISTER", "UNDO"}
    unchanged = "the frames that are done are kept, the file has not changed"
    uses, renamed = (*SETTINGS, "light_samples"), {"light_samples": "samples"}

    filepath: bpy.props.StringProperty(name="Folder", description="Folder for the files of the frames", default=FOLDER,
                                       subtype="FILE_PATH", options=compat.RELATIVE_PATH)
    frames: bpy.props.StringProperty(name="Frames", default="", options={"SKIP_SAVE"},
                                     description="As 1-24, or 1-100:2 with a step; the scene's range where empty")
    samples: option("light_samples", min=0, description="Light paths for each pixel of the mirrors; 0: no light")
    overwrite: bpy.props.BoolProperty(name="Overwrite", default=False, options={"SKIP_SAVE"},
                                      description="Make again the frames that are there already")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE),
                            lambda context: "" if writes_usd() else NO_USD, polls.has_mirror, polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        wanted = self.wanted(context)
        plan = plan_of(context, chosen_folder(self.filepath), self.frames, wanted, overwrite=self.overwrite)
        written: list = []
        sequences = yield from baking(context, plan, written.append)
        playing(context, sequences)
        self.show_used(wanted, candidates(context)[0])
        for remark in blur_remarks(context.scene, plan.cameras):
            self.report({"WARNING"}, remark)
        self.report({"INFO"}, summary(plan, len(written), time.perf_counter() - started))


def plan_of(context: bpy.types.Context, folder: str, frames: str, wanted: Wanted, **more) -> Plan:
    """A plan for the frames that a text names, or the scene's range, by the settings of the mirrors that take part."""
    numbers = chosen_frames(context.scene, frames)
    return Plan(folder, numbers, wanted, wanted.samples(candidates(context)[0]), **more)


def chosen_frames(scene: bpy.types.Scene, text: str) -> list[int]:
    """The frames that a text names, or the scene's range."""
    return frame_numbers(text or frame_text(scene.frame_start, scene.frame_end, scene.frame_step))


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_bake)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_bake)
