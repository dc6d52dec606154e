"""The operator that bakes: a range of frames as files, and results that play them without this extension."""
from __future__ import annotations

import os
import time
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from itertools import combinations

import bpy

from .... import core
from ... import compat
from ...faults import AllOrNothing, BrowsingOperator, Steps, part, still_there, tell
from ...files import chosen_folder, staged
from ...frames import (
    FrameRecord,
    Sequence,
    file_name,
    record_path,
    set_aside,
    told_apart,
    write_image,
    write_record,
    write_result,
    writes_usd,
)
from ...freshness import frame_origin
from ...illumination import meant_lamps
from ...reading import NothingSeen, candidates, choose, read_view
from ...settings import SETTINGS, SettingsOptions, UsesSettings, of_each, option
from .. import polls
from ..clear import clear
from ..generate import generation
from ..light import lighting
from ..shortcomings import render_shortcomings
from .plan import (
    Plan,
    blur_remarks,
    compared,
    found_frames,
    layer_remarks,
    open_frame,
    plan_of,
    summary,
    visible_or_none,
)
from .playing import showing
from .thrown_light import ThrownLight

FOLDER = "//reflection frames"
IN_OBJECT_MODE = "Reflections are baked in Object Mode: leave the present mode first."
NO_USD = "This Blender cannot write USD files, nor play them: bake and play with one that can, as those of blender.org."
WHAT = (("REFLECTIONS", "Reflections", "What the mirrors show to the camera"),
        ("CAUSTICS", "Caustics", "The light of lamps that the mirrors throw"))


@dataclass(frozen=True)
class Reflections:
    """The reflections in mirrors, frame by frame: what there is to bake where nothing else is asked for.

    Attributes
    ----------
    mirrors, diffuse : list of bpy.types.Object
    """

    mirrors: list
    diffuse: list

    role, layers = "REFLECTION", 0

    @property
    def keys(self) -> list[str]:
        """Of the results in the records of frames."""
        return [mirror.name for mirror in self.mirrors]

    def take(self, name: str) -> str:
        """What the records of a sequence are called."""
        return name

    def file(self, key: str, take: str) -> str:
        return f"{told_apart(self.keys)[key]} Reflection {take}".strip()

    def made_with(self, context: bpy.types.Context, plan: Plan, camera: bpy.types.Object | None) -> dict:
        return plan.made_with(context, camera, self.mirrors)

    def origin(self, context: bpy.types.Context, plan: Plan) -> dict:
        """What the open frame is made from."""
        return frame_origin(context, visible_or_none(context, self.mirrors, self.diffuse), bool(plan.samples))

    def frame(self, context: bpy.types.Context, plan: Plan, results: list) -> Steps[None]:
        """Generate and light the open frame, adding to `results` as soon as they are there."""
        return _results(context, plan, visible_or_none(context, self.mirrors, self.diffuse), results)

    def by_key(self, results: list) -> dict:
        return {obj.reflection_mesh.mirror.name: obj for obj in results}

    def materials_of(self, result: bpy.types.Object | None) -> list | None:
        """What the record tells of a result's materials; None: these."""
        return None

    def clear(self, context: bpy.types.Context, results: list) -> None:
        clear(context, still_there(results))


def baking(context: bpy.types.Context, plan: Plan, tell: Callable[[FrameRecord], None] = lambda record: None,
           remark: Callable[[str], None] = lambda sentence: None) -> Steps[list]:
    """Bake all frames of a plan, yielding (fraction, stage); closed at any step, the file is as it was, and the frames
    that are done stay in their folder.

    Parameters
    ----------
    tell : callable
        Is given the record of each frame that is done.
    remark : callable
        Is given a sentence on frames that are kept although the scene has changed since.

    Returns
    -------
    sequences : list of Sequence
        What `bake_playing.playing` lets the file play.

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
    for one, other in combinations(mirrors, 2):
        if one.name == other.name:
            # one of them is linked; frames know mirrors by their names
            raise core.ReflectionError(f"Two mirrors are called '{one.name}': rename one of them.")
    baked = ThrownLight.of(context, plan, mirrors, diffuse) if plan.lamps else Reflections(mirrors, diffuse)
    if not (plan.cameras or plan.lamps):
        read_view(context)
    takes = plan.takes
    share = 1.0 / (len(takes) * len(plan.frames))
    found = [found_frames(context, plan, take, baked) for take in takes]
    with set_aside(context, mirrors, baked.role):
        for (_, camera), known in zip(takes, found):
            yield from part(compared(context, plan, camera, (mirrors, diffuse), known, remark), 0.0, 0.0)
        for index, ((name, camera), known) in enumerate(zip(takes, found)):
            for number, frame in enumerate(plan.frames):
                start = (index * len(plan.frames) + number) * share
                yield start, f"Frame {frame} {name}".strip()
                if known[frame] is None:
                    open_frame(context, frame, camera)
                    steps = _frame(context, plan, (name, camera), baked)
                    known[frame] = yield from part(steps, start, share, f"Frame {frame}")
                    tell(known[frame])
    placements = {mirror.name: of_each(plan.settings)(mirror).placement for mirror in mirrors}
    several = len(takes) > 1
    return [Sequence(plan.folder, [known[frame] for frame in plan.frames], name, placements,
                     camera.name if several else "", baked.layers) for (name, camera), known in zip(takes, found)]


def _frame(context: bpy.types.Context, plan: Plan, take: tuple,
           baked: Reflections | ThrownLight) -> Steps[FrameRecord]:
    """Make the open frame: its files take their places when all of them are whole, and its record last."""
    name, camera = take
    frame = context.scene.frame_current
    with AllOrNothing() as whole:
        results: list = []
        whole.undo(baked.clear, context, results)
        made_from = baked.origin(context, plan)
        yield from part(baked.frame(context, plan, results), 0.0, 0.95)
        by_key = baked.by_key(results)
        yield 0.95, "Writing"
        lit = [obj.reflection_mesh.light_material for obj in results if obj.reflection_mesh.light_material]
        image = file_name(f"Light {name}".strip(), frame, "exr") if lit else ""
        made = {}
        place = record_path(plan.folder, baked.take(name), frame)
        with staged(plan.folder) as scratch:
            for number, key in enumerate(baked.keys):
                start, share = 0.95 + 0.04 * number / len(baked.keys), 0.04 / len(baked.keys)
                yield start, f"Writing {key}"
                result = by_key.get(key)
                path = os.path.join(scratch, file_name(baked.file(key, name), frame, "usdc"))
                shows = result is not None and result.reflection_mesh.light_material is not None
                steps = write_result(context, result, path, shows, baked.materials_of(result))
                made[key] = yield from part(steps, start, share, f"Writing {key}")
            if image:
                yield 0.99, "Writing the light"
                write_image(lit[0], os.path.join(scratch, image))
            # from here on the frame is not done until it has a record again
            with suppress(FileNotFoundError):
                os.unlink(place)
        record = FrameRecord(frame, baked.made_with(context, plan, camera), made, image, made_from)
        with staged(plan.folder) as scratch:
            write_record(os.path.join(scratch, os.path.basename(place)), record)
        baked.clear(context, results)
    return record


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
        yield from part(lighting(context, results, plan.samples, "PICTURE", lamps_apart=False), 0.5, 0.5)


class REFLECTION_MESH_OT_bake(UsesSettings, BrowsingOperator, SettingsOptions, bpy.types.Operator):
    """Write the reflections of a range of frames to files, and let them play; they need no extension to be seen"""

    bl_idname = "reflection_mesh.bake"
    bl_label = "Bake Reflection Frames"
    bl_options = {"REGISTER", "UNDO"}
    unchanged = "the frames that are done are kept, the file has not changed"
    uses, renamed = (*SETTINGS, "light_samples"), {"light_samples": "samples"}

    what: bpy.props.EnumProperty(name="What", items=WHAT, default="REFLECTIONS", options={"SKIP_SAVE"},
                                 description="What is written of each frame")
    eyes: bpy.props.IntProperty(name="Lamp Places", default=0, min=0, soft_max=64, max=4096, options={"SKIP_SAVE"},
                                description="Places on each lamp that its caustics come from; 0: as many as they were "
                                "generated with")
    leave_out: bpy.props.BoolProperty(name="Replace Cycles' Own", default=True, options={"SKIP_SAVE"},
                                      description="The lamps do not light these mirrors any more, so that Cycles does "
                                      "not add caustics of its own; clearing brings that back")
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
        lamps = tuple(meant_lamps(context)) if self.what == "CAUSTICS" else ()
        plan = plan_of(context, chosen_folder(self.filepath), self.frames, wanted, overwrite=self.overwrite,
                       lamps=lamps, eyes=self.eyes, leave_out=self.leave_out)
        written: list = []
        sequences = yield from baking(context, plan, written.append,
                                      lambda sentence: tell(self, {"WARNING"}, sentence))
        _, remarks = showing(context, plan, sequences)
        self.show_used(wanted, candidates(context)[0])
        remarks += render_shortcomings(context, *candidates(context))
        remarks += blur_remarks(context.scene, plan.cameras, bool(lamps))
        for remark in remarks + layer_remarks(context.scene, [context.view_layer]):
            tell(self, {"WARNING"}, remark)
        tell(self, {"INFO"}, summary([plan], len(written), time.perf_counter() - started))


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_bake)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_bake)
