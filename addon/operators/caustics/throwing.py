"""The making of light which mirrors throw: from the scene to objects that add it to what it falls on."""
from __future__ import annotations

import time
from collections import Counter
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain, product

import bpy
import numpy as np

from .... import core
from ....core.caustics import most_layers
from ...faults import AllOrNothing, Steps, listed, one_or_more, part
from ...frames import stop_playing
from ...illumination import (
    Caustic,
    MirrorPart,
    NoLight,
    Tint,
    caustic_arrays,
    eyes_of,
    follow_lamp,
    follow_layers,
    leave_out,
    results_with,
    write_caustics,
)
from ...reading import Participants, materials_shown
from ...writing import set_free, told_of
from ..shortcomings import Refused
from .asked import Asked
from .caustic_scene import CausticScene, reading_caustics
from .remarks import remarks_on, shortcomings_of_light

READING = 0.05  # share of the work


class NothingThrown(core.ReflectionError):
    """No mirror throws any light on the objects at the moment."""


@dataclass
class _Left:
    """Sentences on lamps and mirrors that are unlit or refused and on what caustics lack, and the (mirror, lamp) pairs
    in `dark` that cast nothing at the moment.
    """

    unlit: list
    refused: list
    lacks: list
    dark: list


@dataclass(frozen=True)
class Thrown:
    """The generated caustics.

    Attributes
    ----------
    objects : list of bpy.types.Object
    receivers : dict
        Materials of the lit objects in the order of the object's slots, by object.
    layers : int
        Number of overlapping faces of caustics.
    remarks : list of str
        Sentences on what is left out.
    dark : list of (bpy.types.Object, bpy.types.Object)
        Mirrors and lamps that cast nothing at the moment.
    lacks : list of str
        The sentences on light that is missing or differs from Cycles.
    """

    objects: list
    receivers: dict
    layers: int
    remarks: list
    dark: list
    lacks: list = field(default_factory=list)

    def summary(self, seconds: float) -> str:
        names = listed(obj.name for obj in self.objects)
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
        Where there is nothing to see of it, `NothingThrown` where it may be at another moment, `Refused` where things
        stand against it as they are; its message is one sentence for the user.
    """
    pairs = [(mirror, lamp) for mirror in chosen.mirrors for lamp in lamps
             if only is None or (mirror, lamp) in only]
    if min(wanted.places(*pair) for pair in pairs) < 1:
        raise core.ReflectionError("Light comes from one place of each lamp at least: raise the number of places.")
    started = time.perf_counter()
    scene = yield from reading_caustics(context, chosen, lamps, pairs)
    prepared, left = yield from _prepared(context, scene, wanted)
    if not prepared:
        raise Refused(left.refused) if left.refused else NothingThrown(left.unlit[-1])
    yield 1.0, "Writing"
    thrown = _written(context, prepared, wanted, left)
    for obj in thrown.objects:
        obj.reflection_mesh.made_from = scene.origins[obj.reflection_mesh.mirror, obj.reflection_mesh.lamp]
        obj.reflection_mesh.seconds = (time.perf_counter() - started) / len(thrown.objects)
    return thrown


def _prepared(context: bpy.types.Context, scene: CausticScene, wanted: Asked) -> Steps[tuple[list[Caustic], _Left]]:
    """Return the caustics of each mirror and lamp of a scene that cast any, and what is left out."""
    prepared, left = [], _Left(scene.remarks, [], scene.lacks, scene.dark)
    each = (1.0 - READING) / max(len(scene.pairs), 1)
    for number, (mirror, lamp) in enumerate(scene.pairs):
        name = name_of(mirror, lamp, list(scene.blockers))
        steps = _lit(scene, (mirror, lamp), wanted)
        try:
            lit = yield from part(steps, READING + each * number, each, name)
        except core.ReflectionError as error:
            none = isinstance(error, NoLight | core.NothingInView)
            (left.unlit if none else left.refused).append(f"{name}: {error}")
            left.dark += [(mirror, lamp)] * none
            continue
        left.lacks += shortcomings_of_light(name, [mesh for *_, mesh in lit])
        steps = _made(context, name, (mirror, lamp), lit, scene)
        made = replace((yield from part(steps, READING + each * (number + 1), 0.0, name)),
                       eyes=wanted.places(mirror, lamp))
        # several transparent sheets in a row add their layers
        prepared.append(replace(made, layers=made.layers * len(scene.receivers[mirror]).bit_length()))
    return prepared, left


def name_of(mirror: bpy.types.Object, lamp: bpy.types.Object, lamps: list) -> str:
    """Return the name of the caustics of a mirror and one of `lamps`."""
    return f"{mirror.name} Caustics{f' {lamp.name}' if len(lamps) > 1 else ''}"


def _lit(scene: CausticScene, pair: tuple, wanted: Asked) -> Steps[list]:
    """Return the caustics (eye, part, mesh) of each point on the lamp and each part of a mirror, on all receivers. The
    meshes refer to the triangles of the scene. If there are none, raise the last error.
    """
    (mirror, lamp), lit, told = pair, [], None
    parts, receivers = scene.parts(mirror), scene.receivers[mirror]
    eyes = eyes_of(scene.depsgraph, lamp, wanted.places(mirror, lamp),
                   np.concatenate([own.mesh.positions[own.mesh.triangles.ravel()] for own in parts]))
    share = 1.0 / (len(eyes) * len(parts) * len(receivers))
    for number, (eye, own, ends) in enumerate(product(eyes, parts, receivers)):
        standing = _joined([scene.blockers[lamp], eye.body])
        shining = replace(eye.shining, places=len(eyes))
        steps = core.caustic_steps(shining, own.mesh, ends.mesh, wanted.settings(mirror), own.others, standing)
        try:
            mesh = yield from part(steps, number * share, share)
            lit.append((eye, own, replace(mesh, **ends.counted(mesh))))
        except core.ReflectionError as error:
            told = error
    if not lit:
        raise told
    return lit


def _joined(meshes: list) -> core.TriangleMesh | None:
    """Join the meshes that are not None; return None if there are none."""
    there = [mesh for mesh in meshes if mesh is not None]
    return core.TriangleMesh.joined(there) if there else None


def _made(context: bpy.types.Context, name: str, pair: tuple, lit: list, scene: CausticScene) -> Steps[Caustic]:
    yield 0.0, "Computing brightness"
    counts: Counter = Counter()
    for *_, mesh in lit:
        counts.update(mesh.counts)
    diffuse, places = scene.diffuse, scene.places[pair[0]]
    arrays = yield from core.in_steps(partial(caustic_arrays, lit, diffuse, places, context.scene.camera))
    source_face = next(one.values for one in arrays.attributes if one.name == "source_face")
    layers = yield from core.in_steps(partial(most_layers, arrays.positions, arrays.triangles, source_face))
    plain = all(_plain(own, mesh, places.tints) for _, own, mesh in lit)
    return Caustic(name, *pair, scene.sources, arrays, dict(counts), layers, plain, places.tints)


def _plain(own: MirrorPart, mesh: core.CausticMesh, textured: list[Tint]) -> bool:
    """Return True if the colours of all mirrors that the light of some caustics has met are known.

    Parameters
    ----------
    own : MirrorPart
        The part of a mirror that the light from the lamp meets first.
    mesh : core.CausticMesh
        The caustics of that part. `mesh.met` has the mirror triangles that the light of each face meets.
    textured : list of Tint
        Tints of the mirror whose colour is a known texture. The colour of `own` is known if its tint is constant or
        equal to one of these. The tints of all mirrors after the first must be constant.
    """
    known = own.tint.constant or any(own.tint.same(tint) for tint in textured)
    later = np.unique(own.colours.tint_of[mesh.met[:, 1:][mesh.met[:, 1:] >= 0]])
    return known and all(own.colours.tints[index].constant for index in later.tolist())


def _written(context: bpy.types.Context, prepared: list, wanted: Asked, left: _Left) -> Thrown:
    objects, unknown, scene, remarks = [], [], context.scene, left.unlit
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
    lacks = left.lacks + left.refused + remarks_on(prepared, unknown)
    return Thrown(objects, receivers, layers, remarks + lacks, left.dark, lacks)
