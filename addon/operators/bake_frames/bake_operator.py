"""The operator that bakes: a range of frames as files, and results that play them without this extension."""
from __future__ import annotations

import time
from dataclasses import replace

import bpy

from ... import compat
from ...faults import BrowsingOperator, Steps, part, tell_done
from ...files import chosen_folder
from ...frames import writes_usd
from ...illumination import meant_lamps
from ...reading import candidates
from ...settings import SETTINGS, SettingsOptions, UsesSettings, option
from .. import polls
from ..asked_light import left_out_of
from ..shortcomings import render_shortcomings
from .bake import IN_OBJECT_MODE, NO_USD, baking
from .plan import LACKING, Plan, blur_remarks, empty_remarks, layer_remarks, plan_of, summary
from .playing import showing
from .side_by_side import side_by_side, words_of

FOLDER = "//reflection frames"
WHAT = (("REFLECTIONS", "Reflections", "What the mirrors show to the camera"),
        ("CAUSTICS", "Caustics", "The light of lamps that the mirrors throw"))


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
                                      "not add caustics of its own; clearing brings that back. As before, where this "
                                      "is not given")
    filepath: bpy.props.StringProperty(name="Folder", description="Folder for the files of the frames", default=FOLDER,
                                       subtype="FILE_PATH", options=compat.RELATIVE_PATH)
    frames: bpy.props.StringProperty(name="Frames", default="", options={"SKIP_SAVE"},
                                     description="As 1-24, or 1-100:2 with a step; the scene's range where empty")
    samples: option("light_samples", min=0, description="Light paths for each pixel of the mirrors; 0: no light")
    overwrite: bpy.props.BoolProperty(name="Overwrite", default=False, options={"SKIP_SAVE"},
                                      description="Make again the frames that are there already")
    jobs: bpy.props.IntProperty(name="Processes", default=1, min=1, soft_max=16, max=256, options={"SKIP_SAVE"},
                                description="So many bake side by side, each on a core and with memory of its own")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE),
                            lambda context: "" if writes_usd() else NO_USD, polls.has_mirror, polls.has_camera)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        wanted = self.wanted(context)
        lamps = tuple(meant_lamps(context)) if self.what == "CAUSTICS" else ()
        plan = plan_of(context, chosen_folder(self.filepath), self.frames, wanted, overwrite=self.overwrite,
                       lamps=lamps, eyes=self.eyes, leave_out=self._leave_out)
        written: list = []
        heard: list = []
        elsewhere, start = 0, 0.0
        if self.jobs > 1:
            steps = side_by_side(self._words(context, plan, wanted.given), plan.frames, self.jobs, heard.append)
            elsewhere = yield from part(steps, 0.0, start := 0.9)
            # what others have just made is not made again
            plan = replace(plan, overwrite=False)
        kept: list = []
        sequences = yield from part(baking(context, plan, written.append, kept.append), start, 1.0 - start)
        objects, hidden = showing(context, plan, sequences)
        self.show_used(wanted, candidates(context)[0])
        left_out = left_out_of(objects) if lamps else None
        if left_out is not None:
            self.leave_out = left_out
        remarks = [line for line in heard if line.startswith(LACKING)] + kept + hidden + empty_remarks(sequences)
        remarks += render_shortcomings(context, *candidates(context))
        remarks += blur_remarks(context.scene, plan.cameras, bool(lamps))
        remarks += layer_remarks(context.scene, [context.view_layer])
        tell_done(self, [summary([plan], elsewhere + len(written), time.perf_counter() - started)], remarks)

    def _words(self, context: bpy.types.Context, plan: Plan, given: dict) -> list[str]:
        """What the other processes are told."""
        words = ["bake", "--what", self.what, "--output", plan.folder, *words_of(given)]
        words += ["--scene", context.scene.name, "--view-layer", context.view_layer.name]
        words += ["--eyes", str(self.eyes)] if self.eyes else []
        return words + ["--overwrite"] * self.overwrite

    @property
    def _leave_out(self) -> bool | None:
        return self.leave_out if self.properties.is_property_set("leave_out") else None


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_bake)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_bake)
