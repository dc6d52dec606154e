"""Reading of what light meets that mirrors throw: mirrors, what it falls on, and what stands in its way."""
from __future__ import annotations

from dataclasses import dataclass, replace

import bpy

from .... import core
from ...faults import Steps
from ...freshness import light_record
from ...illumination import (
    MirrorPart,
    MirrorPlaces,
    Receiving,
    blockers_of,
    blocking,
    instancers_of_lamps,
    parts_of,
    places_on_mirror,
    receiving,
    textured,
)
from ...reading import DiffuseScene, MirrorSurface, Participants, read_mirrors, read_scene
from ..shortcomings import left_out
from .remarks import remarks_on_instances, remarks_on_taking

IN_OBJECT_MODE = "Caustics are generated in Object Mode: leave the present mode first."
NOTHING_LIT = "Light falls on nothing but lamps: select what it is to fall on, or give it the role Reflected."


@dataclass(frozen=True)
class CausticScene:
    """The part of the scene that matters for caustics.

    Attributes
    ----------
    depsgraph : bpy.types.Depsgraph
    pairs, dark : list of (bpy.types.Object, bpy.types.Object)
        Mirrors and lamps: pairs whose mirror has faces, and pairs whose mirror has none.
    surfaces, places, receivers : dict
        By mirror: its surface, the places where its textures are sampled, and the objects that its light hits.
    blockers : dict
        Mesh of occluders by lamp.
    diffuse : DiffuseScene
    sources : list of bpy.types.Object
        Lit objects, including hidden ones, which take part again when they are shown.
    origins : dict
        Record of the inputs, by (mirror, lamp).
    remarks, lacks : list of str
        Sentences on what is left out, and on what the caustics lack because of it.
    """

    depsgraph: bpy.types.Depsgraph
    pairs: list
    dark: list
    surfaces: dict[bpy.types.Object, MirrorSurface]
    places: dict[bpy.types.Object, MirrorPlaces]
    receivers: dict[bpy.types.Object, list[Receiving]]
    blockers: dict[bpy.types.Object, core.TriangleMesh | None]
    diffuse: DiffuseScene
    sources: list
    origins: dict
    remarks: list[str]
    lacks: list[str]

    def parts(self, mirror: bpy.types.Object) -> list[MirrorPart]:
        """Return the parts of a mirror that light may meet first, with the other mirrors."""
        return parts_of(self.surfaces[mirror], [other for one, other in self.surfaces.items() if one != mirror])


def reading_caustics(context: bpy.types.Context, chosen: Participants, lamps: list, pairs: list) -> Steps[CausticScene]:
    """Read the parts of the scene for caustics of `lamps` by the mirrors of `chosen`, for the requested `pairs`
    (mirror, lamp), yielding (fraction, stage).

    Raises
    ------
    core.ReflectionError
        In another mode than Object Mode, or where there is nothing to light.
    """
    if context.mode != "OBJECT":
        raise core.ReflectionError(IN_OBJECT_MODE)
    yield 0.0, "Reading the scene"
    depsgraph = context.evaluated_depsgraph_get()
    # emitting objects light others and receive no caustics
    chosen = replace(chosen, diffuse=[obj for obj in chosen.diffuse if obj not in lamps])
    if not chosen.diffuse:
        raise core.ReflectionError(NOTHING_LIT)
    surfaces, faceless = read_mirrors(depsgraph, chosen.mirrors)
    dark, pairs = ([pair for pair in pairs if (pair[0] in surfaces) == there] for there in (False, True))
    places = {mirror: MirrorPlaces(textured(mirror), places_on_mirror(depsgraph, mirror)) for mirror in surfaces}
    scene = read_scene(depsgraph, chosen.diffuse, unmirrored=True)
    receivers = {mirror: receiving(scene, surface.mesh) for mirror, surface in surfaces.items()}
    standing = blocking(context, chosen)
    blockers = {lamp: blockers_of(depsgraph, [obj for obj in standing if obj != lamp]) for lamp in lamps}
    origins, sources = {}, scene.sources + [obj for obj in chosen.waiting if obj not in lamps]
    for pair in pairs:
        origins[pair] = light_record(context, *pair, sources)
        yield 0.0, "Reading the scene"
    return CausticScene(depsgraph, pairs, dark, surfaces, places, receivers, blockers, scene, sources, origins,
                        [*left_out(context, chosen), *faceless,
                         *remarks_on_instances(instancers_of_lamps(context))], remarks_on_taking(scene, surfaces))
