"""The operator that generates the light which mirrors throw, as objects that add it to what it falls on."""
from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from itertools import chain, product

import bpy
import numpy as np

from ... import core
from ...core.caustics import most_layers
from ..faults import AllOrNothing, SteppedOperator, Steps, one_or_more, part, tell_done
from ..frames import stop_playing
from ..freshness import light_record
from ..illumination import (
    Caustic,
    MirrorPart,
    MirrorPlaces,
    NoLight,
    Receiving,
    Tint,
    blockers_of,
    blocking,
    caustic_arrays,
    chosen_lamps,
    eyes_of,
    follow_lamp,
    follow_layers,
    leave_out,
    parts_of,
    places_on_mirror,
    receiving,
    results_with,
    textured,
    write_caustics,
)
from ..reading import DiffuseScene, Participants, choose, materials_shown, read_mirrors, read_scene
from ..settings import UsesSettings, option
from ..writing import set_free, told_of
from . import polls
from .asked_light import Asked, asked_again, remember
from .caustic_remarks import remarks_on, remarks_on_taking
from .shortcomings import left_out, other_meshes

IN_OBJECT_MODE = "Caustics are generated in Object Mode: leave the present mode first."
NOTHING_LIT = "Light falls on nothing but lamps: select what it is to fall on, or give it the role Reflected."
AS_BEFORE = ("eyes", "leave_out")  # where they are not given
READING = 0.05  # share of the work


class NothingThrown(core.ReflectionError):
    """No mirror throws any light on the objects at the moment."""


@dataclass(frozen=True)
class Thrown:
    """What was made.

    Attributes
    ----------
    objects : list of bpy.types.Object
    receivers : dict
        The materials of what is lit, in the order of the object's own, by object.
    layers : int
        How many faces of light lie over each other.
    remarks : list of str
        Sentences on what is left out.
    dark : list of (bpy.types.Object, bpy.types.Object)
        Mirrors and lamps that throw nothing at the moment.
    """

    objects: list
    receivers: dict
    layers: int
    remarks: list
    dark: list

    def summary(self, seconds: float) -> str:
        names = ", ".join(f"'{obj.name}'" for obj in self.objects)
        faces = one_or_more(sum(obj.reflection_mesh.faces for obj in self.objects), "1 face", "{count} faces")
        return f"{names}: {faces} of light, {seconds:.2f} s"


def throwing(context: bpy.types.Context, chosen: Participants, lamps: list, wanted: Asked,
             only: set | None = None) -> Steps[Thrown]:
    """Generate the light of `lamps` that `chosen.mirrors` throw on `chosen.diffuse`, yielding (fraction, stage); that
    of `only` some (mirror, lamp) where these are given.

    Nothing in the file changes before the last step; a generator that is closed before leaves no trace.

    Raises
    ------
    core.ReflectionError
        Where there is nothing to see of it, `NothingThrown` where it may be at another moment; its message is one
        sentence for the user.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    pairs = [(mirror, lamp) for mirror in chosen.mirrors for lamp in lamps
             if only is None or (mirror, lamp) in only]
    if min(wanted.places(*pair) for pair in pairs) < 1:
        raise core.ReflectionError("Light comes from one place of each lamp at least: raise the number of places.")
    started = time.perf_counter()
    yield 0.0, "Reading the scene"
    depsgraph = context.evaluated_depsgraph_get()
    # what emits lights others
    chosen = replace(chosen, diffuse=[obj for obj in chosen.diffuse if obj not in lamps])
    if not chosen.diffuse:
        raise core.ReflectionError(NOTHING_LIT)
    surfaces, faceless = read_mirrors(depsgraph, chosen.mirrors)
    dark, pairs = ([pair for pair in pairs if (pair[0] in surfaces) == there] for there in (False, True))
    places = {mirror: MirrorPlaces(textured(mirror), places_on_mirror(depsgraph, mirror)) for mirror in surfaces}
    scene = read_scene(depsgraph, chosen.diffuse)
    receivers = {mirror: receiving(scene, surface.mesh) for mirror, surface in surfaces.items()}
    standing = blocking(context, chosen)
    blockers = {lamp: blockers_of(depsgraph, [obj for obj in standing if obj != lamp]) for lamp in lamps}
    origins = {}
    for pair in pairs:
        origins[pair] = light_record(context, *pair, scene.sources)
        yield 0.0, "Reading the scene"
    prepared, refused = [], left_out(context, chosen.hidden) + faceless + remarks_on_taking(scene, surfaces)
    for number, (mirror, lamp) in enumerate(pairs):
        name = name_of(mirror, lamp, lamps)
        eyes = partial(eyes_of, depsgraph, lamp, wanted.places(mirror, lamp))
        parts = parts_of(surfaces[mirror], [surfaces[other] for other in surfaces if other != mirror])
        steps = _lit(eyes, parts, receivers[mirror], blockers[lamp], wanted.settings(mirror))
        try:
            lit = yield from part(steps, READING + (1.0 - READING) * number / len(pairs), (1.0 - READING) / len(pairs),
                                  name)
        except core.ReflectionError as error:
            refused.append(f"{name}: {error}")
            dark += [(mirror, lamp)] * isinstance(error, NoLight | core.NothingInView)
            continue
        done = READING + (1.0 - READING) * (number + 1) / len(pairs)
        steps = _made(context, name, (mirror, lamp), lit, scene, places[mirror])
        made = replace((yield from part(steps, done, 0.0, name)), eyes=wanted.places(mirror, lamp))
        # what is seen through sheets passes the layers on each of them
        prepared.append(replace(made, layers=made.layers * len(receivers[mirror]).bit_length()))
    if not prepared:
        raise (NothingThrown if {*pairs} <= {*dark} else core.ReflectionError)(refused[-1])
    yield 1.0, "Writing"
    thrown = _written(context, prepared, wanted, (refused, dark))
    for obj in thrown.objects:
        obj.reflection_mesh.made_from = origins[obj.reflection_mesh.mirror, obj.reflection_mesh.lamp]
        obj.reflection_mesh.seconds = (time.perf_counter() - started) / len(thrown.objects)
    return thrown


def name_of(mirror: bpy.types.Object, lamp: bpy.types.Object, lamps: list) -> str:
    """What the light of a mirror and one of `lamps` is called."""
    return f"{mirror.name} Caustics{f' {lamp.name}' if len(lamps) > 1 else ''}"


def _lit(eyes_of_lamp: Callable, parts: list[MirrorPart], receivers: list[Receiving],
         blockers: core.TriangleMesh | None, settings: core.Settings) -> Steps[list]:
    """The light (eye, part, mesh) of each of a lamp's places that each part of a mirror throws on all `receivers`, on
    the triangles of the scene; where none throws any, the error of the last."""
    lit, told = [], None
    eyes = eyes_of_lamp(np.concatenate([own.mesh.positions[own.mesh.triangles.ravel()] for own in parts]))
    share = 1.0 / (len(eyes) * len(parts) * len(receivers))
    for number, (eye, own, ends) in enumerate(product(eyes, parts, receivers)):
        standing = _joined([blockers, eye.body])
        steps = core.caustic_steps(eye.shining, own.mesh, ends.mesh, settings, own.others, standing)
        try:
            mesh = yield from part(steps, number * share, share)
            lit.append((eye, own, replace(mesh, **ends.counted(mesh))))
        except core.ReflectionError as error:
            told = error
    if not lit:
        raise told
    return lit


def _joined(meshes: list) -> core.TriangleMesh | None:
    """Those meshes that are there as one; None where there is none."""
    there = [mesh for mesh in meshes if mesh is not None]
    return core.TriangleMesh.joined(there) if there else None


def _made(context: bpy.types.Context, name: str, pair: tuple, lit: list, scene: DiffuseScene,
          places: MirrorPlaces) -> Steps[Caustic]:
    yield 0.0, "irradiance"
    counts = {key: sum(mesh.counts.get(key, 0) for *_, mesh in lit) for key in lit[0][-1].counts}
    arrays = yield from core.in_steps(partial(caustic_arrays, lit, scene, places, context.scene.camera))
    source_face = next(one.values for one in arrays.attributes if one.name == "source_face")
    layers = yield from core.in_steps(partial(most_layers, arrays.positions, arrays.triangles, source_face))
    plain = all(_plain(own, mesh, places.tints) for _, own, mesh in lit)
    return Caustic(name, *pair, scene.sources, arrays, counts, layers, plain, places.tints)


def _plain(own: MirrorPart, mesh: core.CausticMesh, textured: list[Tint]) -> bool:
    """Whether the colours of the mirrors that light has met are known all over: those of the first by its textures."""
    known = own.tint.constant or any(own.tint.same(tint) for tint in textured)
    later = np.unique(own.colours.tint_of[mesh.met[:, 1:][mesh.met[:, 1:] >= 0]])
    return known and all(own.colours.tints[index].constant for index in later.tolist())


def _written(context: bpy.types.Context, prepared: list, wanted: Asked, left: tuple[list, list]) -> Thrown:
    objects, unknown, scene, (remarks, dark) = [], [], context.scene, left
    shown = materials_shown(context.evaluated_depsgraph_get(), [made.mirror for made in prepared])
    with AllOrNothing() as whole:
        for made in prepared:
            for earlier in results_with(context, made.mirror, made.lamp)[:1]:
                remarks += told_of(earlier, set_free(context, earlier, whole))
            obj, strange = write_caustics(context, made, whole, wanted.keep_materials)
            whole.after(stop_playing, obj)
            objects.append(obj)
            unknown += strange
            if wanted.leaves_out(made.mirror, made.lamp):
                remarks += leave_out(scene, made.mirror, made.lamp, shown[made.mirror], whole)
            else:
                follow_lamp(made.lamp)
        layers = sum(made.layers for made in prepared)
        receivers = {obj: made.arrays.materials for obj, made in zip(objects, prepared)}
        remarks += follow_layers(scene, layers, chain.from_iterable(receivers.values()), whole)
    remarks += remarks_on(prepared, unknown)
    return Thrown(objects, receivers, layers, remarks, dark)


class REFLECTION_MESH_OT_caustics(UsesSettings, SteppedOperator, bpy.types.Operator):
    """Compute the light of lamps that the mirrors throw on the reflected objects, as meshes that add it to them"""

    bl_idname = "reflection_mesh.caustics"
    bl_label = "Generate Caustics"
    bl_options = {"REGISTER", "UNDO"}

    uses = ("tolerance", "depth", "memory")

    tolerance: option("tolerance")
    depth: option("depth")
    memory: option("memory")
    eyes: bpy.props.IntProperty(name="Lamp Places", default=1, min=1, soft_max=64, max=4096, options={"SKIP_SAVE"},
                                description="Places on each lamp that its light comes from: one is sharp, more are as "
                                "soft as the lamp is large; as many as before, where this is not given")
    leave_out: bpy.props.BoolProperty(name="Replace Cycles' Own", default=True, options={"SKIP_SAVE"},
                                      description="The lamps do not light these mirrors any more, so that Cycles does "
                                      "not add caustics of its own; clearing brings that back. As before, where this "
                                      "is not given")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), polls.has_mirror)

    def steps(self, context: bpy.types.Context) -> Steps[None]:
        started = time.perf_counter()
        chosen, wanted, lamps = choose(context), self.wanted(context), chosen_lamps(context)
        given = [getattr(self, name) if self.properties.is_property_set(name) else None for name in AS_BEFORE]
        asked = asked_again(context, chosen, lamps, wanted, tuple(given))
        thrown = yield from throwing(context, chosen, lamps, asked)
        remember(thrown.objects, asked)
        self.show_used(wanted, chosen.mirrors)
        pairs = [(obj.reflection_mesh.mirror, obj.reflection_mesh.lamp) for obj in thrown.objects]
        for name, used in zip(AS_BEFORE, (asked.places, asked.leaves_out)):
            if len({used(*pair) for pair in pairs}) == 1:
                setattr(self, name, used(*pairs[0]))
        context.view_layer.update()
        remarks = thrown.remarks + other_meshes(context.scene, chosen.mirrors + chosen.diffuse)
        tell_done(self, [thrown.summary(time.perf_counter() - started)], remarks)


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_caustics)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_caustics)
