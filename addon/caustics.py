"""The operator that generates the light which mirrors throw, as objects that add it to what it falls on."""
from __future__ import annotations

import time
from dataclasses import dataclass

import bpy

from .. import core
from ..core.caustics import most_layers
from . import polls
from .faults import AllOrNothing, SteppedOperator, Steps, part
from .illumination import (
    Caustic,
    Tint,
    caustic_arrays,
    chosen_lamps,
    eyes_of,
    has_a_size,
    leave_out_own_caustics,
    write_caustics,
)
from .reading import SURFACES, DiffuseScene, Participants, choose, is_opaque, read_mirror, read_scene
from .settings import SettingsOfMirrors, UsesSettings, option

IN_OBJECT_MODE = "Caustics are generated in Object Mode: leave the present mode first."
READING = 0.05  # share of the work


@dataclass(frozen=True)
class Asked:
    """What is asked for: places on each lamp, the settings of each mirror, and whether Cycles' own caustics are left
    out."""

    eyes: int
    settings: SettingsOfMirrors
    leave_out: bool


@dataclass(frozen=True)
class Thrown:
    """The objects that were made, and sentences on what they leave out."""

    objects: list
    remarks: list

    def summary(self, seconds: float) -> str:
        names = ", ".join(f"'{obj.name}'" for obj in self.objects)
        return f"{names}: {sum(obj.reflection_mesh.faces for obj in self.objects)} faces of light, {seconds:.2f} s"


def throwing(context: bpy.types.Context, chosen: Participants, lamps: list, wanted: Asked) -> Steps[Thrown]:
    """Generate the light of `lamps` that `chosen.mirrors` throw on `chosen.diffuse`, yielding (fraction, stage).

    Nothing in the file changes before the last step; a generator that is closed before leaves no trace.

    Raises
    ------
    core.ReflectionError
        Where there is nothing to see of it; its message is one sentence for the user.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    if wanted.eyes < 1:
        raise core.ReflectionError("Light comes from one place of each lamp at least: raise the number of places.")
    yield 0.0, "Reading the scene"
    depsgraph = context.evaluated_depsgraph_get()
    surfaces = [read_mirror(depsgraph, mirror).mesh for mirror in chosen.mirrors]
    scene = read_scene(depsgraph, chosen.diffuse)
    blockers = _blockers(context, depsgraph, chosen)
    several, share = len(lamps) > 1, (1.0 - READING) / (len(surfaces) * len(lamps) * wanted.eyes)
    prepared, refused = [], [f"Left out because it is hidden: '{obj.name}'." for obj in chosen.hidden]
    done = READING
    for index, (mirror, surface) in enumerate(zip(chosen.mirrors, surfaces)):
        others = core.TriangleMesh.joined(surfaces[:index] + surfaces[index + 1:])
        for lamp in lamps:
            name = f"{mirror.name} Caustics{f' {lamp.name}' if several else ''}"
            lit, told = [], ""
            for eye in eyes_of(depsgraph, lamp, wanted.eyes, surface.positions[surface.triangles].mean(axis=(0, 1))):
                steps = core.caustic_steps(eye.lamp, surface, scene.mesh, wanted.settings(mirror),
                                           others if len(others.triangles) else None, blockers)
                try:
                    lit.append((eye, (yield from part(steps, done, share, name))))
                except core.ReflectionError as error:
                    told = f"{name}: {error}"
                done += share
            if not lit:
                refused.append(told)
                continue
            prepared.append(_made(context, name, (mirror, lamp), lit, scene))
    if not prepared:
        raise core.ReflectionError(refused[-1])
    yield 1.0, "Writing"
    return _written(context, prepared, wanted, refused)


def _made(context: bpy.types.Context, name: str, pair: tuple, lit: list, scene: DiffuseScene) -> Caustic:
    counts = {key: sum(mesh.counts.get(key, 0) for _, mesh in lit) for key in lit[0][1].counts}
    arrays = caustic_arrays(lit, scene, Tint.of(pair[0]), context.scene.camera)
    places = [arrays.positions, arrays.triangles, next(
        one.values for one in arrays.attributes if one.name == "source_face")]
    return Caustic(name, *pair, scene.sources, arrays, counts, most_layers(*places))


def _written(context: bpy.types.Context, prepared: list, wanted: Asked, remarks: list) -> Thrown:
    objects, unknown, scene = [], [], context.scene
    with AllOrNothing() as whole:
        for made in prepared:
            obj, strange = write_caustics(context, made, whole)
            objects.append(obj)
            unknown += strange
            if wanted.leave_out and scene.render.engine == "CYCLES" and scene.cycles.caustics_reflective and (
                    has_a_size(made.lamp)) and not leave_out_own_caustics(made.lamp, made.mirror, whole):
                remarks.append(f"Cycles adds its own caustics of '{made.lamp.name}', whose light is linked already: "
                               f"take '{made.mirror.name}' out of what it lights.")
    for material in dict.fromkeys(unknown):
        remarks.append(f"The colour of '{material.name}' is not known all over, where it is laid out by the object or "
                       "mixed of several shaders: its light may have another colour.")
    if not all(Tint.of(made.mirror).constant for made in prepared):
        remarks.append("A mirror's colour that changes over it counts as one: plug it off to choose which.")
    bounces, layers = scene.cycles.transparent_max_bounces, sum(made.layers for made in prepared)
    if scene.render.engine == "CYCLES" and layers > bounces:
        remarks.append(f"Cycles follows {bounces} transparent layers, and of light {layers} or more lie over each "
                       "other, which is dark there: raise Light Paths > Max Bounces > Transparent.")
    return Thrown(objects, remarks)


def _blockers(context: bpy.types.Context, depsgraph: bpy.types.Depsgraph,
              chosen: Participants) -> core.TriangleMesh | None:
    """What else stands in the light's way: all that casts shadows and that no light goes through."""
    part_takers = {*chosen.mirrors, *chosen.diffuse}
    objects = [obj for obj in context.view_layer.objects
               if obj not in part_takers and obj.type in SURFACES and obj.visible_get() and not obj.hide_render
               and obj.visible_shadow and obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}
               and all(is_opaque(slot.material) for slot in obj.material_slots)]
    if not objects:
        return None
    try:
        return read_scene(depsgraph, objects).mesh
    except core.ReflectionError:
        return None  # none of them has faces


class REFLECTION_MESH_OT_caustics(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Compute the light of lamps that the mirrors throw on the diffuse objects, as meshes that add it to them"""

    bl_idname = "reflection_mesh.caustics"
    bl_label = "Generate Caustics"
    bl_options = {"REGISTER", "UNDO"}

    uses = ("tolerance", "depth", "memory")

    tolerance: option("tolerance")
    depth: option("depth")
    memory: option("memory")
    eyes: bpy.props.IntProperty(name="Lamp Places", default=1, min=1, soft_max=64, max=4096, options=set(),
                                description="Places on each lamp that its light comes from: one is sharp, more are as "
                                "soft as the lamp is large")
    leave_out: bpy.props.BoolProperty(name="Replace Cycles' Own", default=True, options=set(),
                                      description="The lamps do not light these mirrors any more, so that Cycles does "
                                      "not add caustics of its own; clearing brings that back")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        chosen, wanted = choose(context), self.wanted(context)
        thrown = yield from throwing(context, chosen, chosen_lamps(context), Asked(self.eyes, wanted, self.leave_out))
        self.show_used(wanted, chosen.mirrors)
        context.view_layer.update()
        for remark in thrown.remarks:
            self.report({"WARNING"}, remark)
        self.report({"INFO"}, thrown.summary(time.perf_counter() - started))


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_caustics)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_caustics)
