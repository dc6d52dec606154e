"""The operator that bakes: a range of frames as files, and results that play them without this extension."""
from __future__ import annotations

import time

import bpy

from ....core import ReflectionError
from ... import compat
from ...faults import BrowsingOperator, Steps, part, tell_done
from ...files import chosen_folder
from ...frames import writes_usd
from ...illumination import meant_lamps
from ...reading import candidates
from ...settings import SETTINGS, SettingsOptions, UsesSettings, option
from .. import polls
from ..caustics import left_out_of
from .bake import IN_OBJECT_MODE, NO_USD
from .plan import LACKING, Plan, chosen_frames, empty_remarks, layer_remarks, plan_of, scene_remarks, summary
from .side_by_side import side_by_side, words_of
from .view_layers import baking_layers, show_layers

FOLDER = "//reflection frames"
WHAT = (("REFLECTIONS", "Reflections", "What the mirrors show to the camera"),
        ("CAUSTICS", "Caustics", "The light of lamps that the mirrors throw"))

CAMERAS = (("SCENE", "Scene's", "The scene's camera, which its markers may change"),
           ("SELECTED", "Selected", "A sequence for each of the selected cameras"))
LAYERS = (("ACTIVE", "This One", "What the view layer sees that is looked at now"),
          ("RENDERED", "All Rendered", "A sequence for each view layer that is rendered, which the others do not show"))
NO_CAMERAS = "No camera is selected: select the cameras, or bake what the scene's own one sees."


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
    cameras: bpy.props.EnumProperty(name="Cameras", items=CAMERAS, default="SCENE", options={"SKIP_SAVE"},
                                    description="For which cameras reflections are baked")
    layers: bpy.props.EnumProperty(name="View Layers", items=LAYERS, default="ACTIVE", options={"SKIP_SAVE"},
                                   description="In which view layers reflections are baked")
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
        wanted, folder, layers, cameras = self.wanted(context), chosen_folder(self.filepath), *self._taken(context)
        frames, written, heard, kept = chosen_frames(context.scene, self.frames), [], [], []
        elsewhere, start = 0, 0.0
        if self.jobs > 1:
            words = self._words(context, folder, wanted.given, (layers, cameras))
            elsewhere = yield from part(side_by_side(words, frames, self.jobs, heard.append), 0.0, start := 0.9)

        def planned(layer: str) -> Plan:
            # what others have just made is not made again
            return plan_of(context, folder, self.frames, wanted, cameras=cameras, layer=layer, eyes=self.eyes,
                           overwrite=self.overwrite and self.jobs == 1, leave_out=self._leave_out,
                           lamps=tuple(meant_lamps(context)) if self.what == "CAUSTICS" else ())
        steps = baking_layers(context, layers, planned, written.append, kept.append)
        made = yield from part(steps, start, 1.0 - start)
        objects, hidden = show_layers(context, made)
        self.show_used(wanted, candidates(context)[0])
        left_out = left_out_of(objects) if self.what == "CAUSTICS" else None
        if left_out is not None:
            self.leave_out = left_out
        remarks = [line for line in heard if line.startswith(LACKING)] + kept + hidden
        remarks += empty_remarks([sequence for baked in made for sequence in baked.sequences])
        remarks += scene_remarks(context, cameras, self.what == "CAUSTICS")
        remarks += layer_remarks(context.scene, layers)
        tell_done(self, [summary([baked.plan for baked in made], elsewhere + len(written),
                                 time.perf_counter() - started)], remarks)

    def _taken(self, context: bpy.types.Context) -> tuple[list, tuple]:
        """The view layers and the cameras that have sequences of their own, none of these for the scene's."""
        layers = [layer for layer in context.scene.view_layers if layer.use] if self.layers == "RENDERED" else []
        if self.cameras == "SCENE":
            return layers or [context.view_layer], ()
        cameras = tuple(obj for obj in context.view_layer.objects.selected if obj.type == "CAMERA")
        if not cameras:
            raise ReflectionError(NO_CAMERAS)
        return layers or [context.view_layer], cameras

    def _words(self, context: bpy.types.Context, folder: str, given: dict, taken: tuple[list, tuple]) -> list[str]:
        """What the other processes are told."""
        words = ["bake", "--what", self.what, "--output", folder, *words_of(given), "--scene", context.scene.name]
        for flag, items in zip(("--view-layer", "--camera"), taken, strict=True):
            words += [flag, *(item.name for item in items)] if items else []
        words += ["--eyes", str(self.eyes)] if self.eyes else []
        return words + ["--overwrite"] * self.overwrite

    @property
    def _leave_out(self) -> bool | None:
        return self.leave_out if self.properties.is_property_set("leave_out") else None


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_bake)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_bake)
