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
from ...writing import protect
from .. import polls
from ..caustics import left_out_of
from ..pressed import ProtectsResults
from .bake import IN_OBJECT_MODE, NO_USD
from .plan import LACKING, Plan, chosen_frames, empty_remarks, layer_remarks, plan_of, scene_remarks, summary
from .side_by_side import side_by_side, words_of
from .view_layers import baking_layers, show_layers

FOLDER = "//reflection frames"
WHAT = (("REFLECTIONS", "Reflections", "What the camera sees in the mirrors"),
        ("CAUSTICS", "Caustics", "Light of lamps that the mirrors reflect onto other objects"))

CAMERAS = (("SCENE", "Scene's", "The scene's camera. Markers can change it"),
           ("SELECTED", "Selected", "One sequence for each selected camera"))
LAYERS = (("ACTIVE", "This One", "The current view layer"),
          ("RENDERED", "All Rendered", "One sequence for each rendered view layer, hidden in the others"))
NO_CAMERAS = "No camera is selected: select the cameras, or bake what the scene's own one sees."


class REFLECTION_MESH_OT_bake(UsesSettings, ProtectsResults, BrowsingOperator, SettingsOptions, bpy.types.Operator):
    """Write the reflections of a range of frames to files and play them. Playing needs no extension"""

    bl_idname = "reflection_mesh.bake"
    bl_label = "Bake Reflection Frames"
    bl_options = {"REGISTER", "UNDO"}
    unchanged = "the frames that are done are kept, the file has not changed"
    uses, renamed = (*SETTINGS, "light_samples"), {"light_samples": "samples"}

    what: bpy.props.EnumProperty(name="What", items=WHAT, default="REFLECTIONS", options={"SKIP_SAVE"},
                                 description="Results that are baked for each frame")
    eyes: bpy.props.IntProperty(name="Lamp Places", default=0, min=0, soft_max=64, max=4096, options={"SKIP_SAVE"},
                                description="Number of points on each lamp that its caustics come from. 0 uses as "
                                            "many as they were generated with")
    leave_out: bpy.props.BoolProperty(name="Replace Cycles' Own", default=True, options={"SKIP_SAVE"},
                                      description="Stop the lamps from lighting these mirrors, so that Cycles adds no"
                                                  " caustics of its own, until the caustics are cleared. If not "
                                                  "given, as before")
    filepath: bpy.props.StringProperty(name="Folder", description="Folder for the files of the frames", default=FOLDER,
                                       subtype="FILE_PATH", options=compat.RELATIVE_PATH)
    frames: bpy.props.StringProperty(name="Frames", default="", options={"SKIP_SAVE"},
                                     description="Frames to bake, such as 1-24, or 1-100:2 with a step. Empty uses "
                                                 "the scene's range")
    cameras: bpy.props.EnumProperty(name="Cameras", items=CAMERAS, default="SCENE", options={"SKIP_SAVE"},
                                    description="Cameras that reflections are baked for")
    layers: bpy.props.EnumProperty(name="View Layers", items=LAYERS, default="ACTIVE", options={"SKIP_SAVE"},
                                   description="View layers that reflections are baked for")
    samples: option("light_samples", min=0, description="Number of light paths for each pixel of the mirrors. 0 bakes"
                                                        " no light")
    overwrite: bpy.props.BoolProperty(name="Overwrite", default=False, options={"SKIP_SAVE"},
                                      description="Bake frames again that exist already")
    jobs: bpy.props.IntProperty(name="Processes", default=1, min=1, soft_max=16, max=256, options={"SKIP_SAVE"},
                                description="Number of processes that bake at the same time. Each uses one core and "
                                            "memory of its own")

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
            # skip frames that the other processes have just baked
            return plan_of(context, folder, self.frames, wanted, cameras=cameras, layer=layer, eyes=self.eyes,
                           overwrite=self.overwrite and self.jobs == 1, leave_out=self._leave_out,
                           lamps=tuple(meant_lamps(context)) if self.what == "CAUSTICS" else ())
        steps = baking_layers(context, layers, planned, written.append, kept.append)
        made = yield from part(steps, start, 1.0 - start)
        objects, hidden = show_layers(context, made)
        if self.protect:
            protect(objects)
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
        """Return the view layers and the cameras that get sequences of their own; empty for the scene's own."""
        layers = [layer for layer in context.scene.view_layers if layer.use] if self.layers == "RENDERED" else []
        if self.cameras == "SCENE":
            return layers or [context.view_layer], ()
        cameras = tuple(obj for obj in context.view_layer.objects.selected if obj.type == "CAMERA")
        if not cameras:
            raise ReflectionError(NO_CAMERAS)
        return layers or [context.view_layer], cameras

    def _words(self, context: bpy.types.Context, folder: str, given: dict, taken: tuple[list, tuple]) -> list[str]:
        """Return the command line arguments for the other processes."""
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
