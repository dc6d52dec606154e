"""The operator that generates the light which mirrors throw, as objects that add it to what it falls on."""
from __future__ import annotations

import time

import bpy

from ...faults import SteppedOperator, Steps, tell_done
from ...illumination import chosen_lamps
from ...reading import choose
from ...settings import UsesSettings, option
from ...writing import protect
from .. import polls
from ..pressed import ProtectsResults
from ..rounding import rounding_remarks
from ..shortcomings import other_meshes
from .asked import asked_again, remember
from .caustic_scene import IN_OBJECT_MODE
from .throwing import throwing

AS_BEFORE = ("eyes", "leave_out")  # options that keep their last values if they are not given


class REFLECTION_MESH_OT_caustics(UsesSettings, ProtectsResults, SteppedOperator, bpy.types.Operator):
    """Create meshes that show the light of lamps that the mirrors reflect onto other objects"""

    bl_idname = "reflection_mesh.caustics"
    bl_label = "Generate Caustics"
    bl_options = {"REGISTER", "UNDO"}

    uses = ("tolerance", "depth", "memory")

    tolerance: option("tolerance")
    depth: option("depth")
    memory: option("memory")
    eyes: bpy.props.IntProperty(name="Lamp Places", default=1, min=1, soft_max=64, max=4096, options={"SKIP_SAVE"},
                                description="Number of points on each lamp that its light comes from. One gives sharp"
                                            " caustics, more give caustics as soft as the lamp is large. If not "
                                            "given, as many as before")
    leave_out: bpy.props.BoolProperty(name="Replace Cycles' Own", default=True, options={"SKIP_SAVE"},
                                      description="Stop the lamps from lighting these mirrors, so that Cycles adds no"
                                                  " caustics of its own, until the caustics are cleared. If not "
                                                  "given, as before")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror, polls.has_lamp)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        chosen, wanted, lamps = choose(context, unmirrored=True), self.wanted(context), chosen_lamps(context)
        given = [getattr(self, name) if self.properties.is_property_set(name) else None for name in AS_BEFORE]
        asked = asked_again(context, chosen, lamps, wanted, tuple(given))
        thrown = yield from throwing(context, chosen, lamps, asked)
        remember(thrown.objects, asked)
        if self.protect:
            protect(thrown.objects)
        self.show_used(wanted, chosen.mirrors)
        pairs = [(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp) for obj in thrown.objects]
        for name, used in zip(AS_BEFORE, (asked.places, asked.leaves_out)):
            if len({used(*pair) for pair in pairs}) == 1:
                setattr(self, name, used(*pairs[0]))
        context.view_layer.update()
        remarks = thrown.remarks + other_meshes(context.scene, chosen.mirrors + chosen.diffuse)
        remarks += rounding_remarks(context, thrown.objects)
        tell_done(self, [thrown.summary(time.perf_counter() - started)], remarks)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_caustics)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_caustics)
