"""The object that carries the light of one lamp that one mirror throws."""
from __future__ import annotations

import json
from dataclasses import dataclass, replace

import bpy
from mathutils import Matrix

from ..faults import AllOrNothing, keep_data, keep_object
from ..writing import RAYS, MeshArrays, new_beside, write_mesh
from .caustic_material import UNSEEN, adds_light, forget_added_light
from .mirrors import stains

SHOWN_BY = {"visible_glossy", "visible_transmission"}


@dataclass(frozen=True)
class Caustic:
    """What is to be written for one mirror and one lamp.

    Attributes
    ----------
    name : str
        Of a new object.
    mirror, lamp : bpy.types.Object
    sources : list of bpy.types.Object
        What is lit, and after it what would be, were it not hidden.
    arrays : MeshArrays
        With the receivers' materials.
    counts : dict
    layers : int
        The most faces over each other.
    plain : bool
        Whether each of the mirrors' materials is one colour, but for the textured ones.
    textured : list of Tint
        Of the mirror, whose colour changes over it.
    eyes : int
        Places on the lamp that it comes from.
    """

    name: str
    mirror: bpy.types.Object
    lamp: bpy.types.Object
    sources: list
    arrays: MeshArrays
    counts: dict
    layers: int
    plain: bool
    textured: list
    eyes: int = 1


def results_with(context: bpy.types.Context, mirror: bpy.types.Object, lamp: bpy.types.Object) -> list:
    """Caustics of a mirror and a lamp in the scene that can be changed."""
    return [obj for obj in context.scene.objects if obj.reflection_mesh.role == "CAUSTICS" and obj.type == "MESH"
            and obj.reflection_mesh.mirror == mirror and obj.reflection_mesh.lamp == lamp and obj.library is None]


def caustics_object(context: bpy.types.Context, name: str, pair: tuple, sources: list,
                    whole: AllOrNothing) -> bpy.types.Object:
    """The object for the light of `pair`, a mirror and a lamp: the one that is there already, whose mesh may then be
    written, or a new one of that name."""
    earlier = results_with(context, *pair)
    if earlier:
        obj = earlier[0]
        keep_object(obj, whole)
        keep_data(obj, whole)
    else:
        obj = new_beside(context, name, pair[0], whole)
        # mirrors and glass show it; diffuse light that left what is lit would have to pass all layers of it
        for rays in RAYS:
            setattr(obj, rays, rays in SHOWN_BY)
        obj.lineart.usage = "EXCLUDE"
    # compositors find the light of a lamp in its group
    whole.undo(setattr, obj, "lightgroup", obj.lightgroup)
    obj.lightgroup = pair[1].lightgroup
    record = obj.reflection_mesh
    record.role, (record.mirror, record.lamp) = "CAUSTICS", pair
    record.sources.clear()
    for source in sources:
        record.sources.add().object = source
    return obj


def write_caustics(context: bpy.types.Context, made: Caustic, whole: AllOrNothing,
                   keep_materials: bool = False) -> tuple[bpy.types.Object, list]:
    """The light as an object, a new one or the one that is there already, updated in place; and the receivers'
    materials whose colour it does not know. Where something fails, `whole` takes back all that is changed here.

    Parameters
    ----------
    keep_materials : bool
        Show the present materials further, where they are for the same receivers: engines need not make them ready
        again.
    """
    earlier = results_with(context, made.mirror, made.lamp)[:1]
    # what is to be done at last is said first
    whole.after(forget_added_light, [material for obj in earlier for material in obj.data.materials])
    kept = [list(obj.data.materials) for obj in earlier
            if [entry.material for entry in obj.reflection_mesh.materials] == made.arrays.materials]
    obj = caustics_object(context, made.name, (made.mirror, made.lamp), made.sources, whole)
    materials, unknown, colours = [], [], stains(made.textured, whole)
    unseen = any(one.name == UNSEEN for one in made.arrays.attributes)
    for receiver in made.arrays.materials:
        if keep_materials and not (made.textured or unseen) and kept and len(kept[0]) == len(made.arrays.materials):
            materials = kept[0]
            break
        material, known = adds_light(receiver, colours, whole, unseen)
        materials.append(material)
        if not known:
            unknown.append(receiver)
    write_mesh(obj.data, replace(made.arrays, materials=materials))
    obj.matrix_world = Matrix.Translation(made.arrays.origin)
    record = obj.reflection_mesh
    record.eyes = made.eyes
    record.materials.clear()
    for receiver in made.arrays.materials:
        record.materials.add().material = receiver
    record.counts = json.dumps({name: int(count) for name, count in made.counts.items()})
    record.faces = len(obj.data.polygons)
    return obj, unknown


def places_kept(context: bpy.types.Context, mirrors: list, lamps: list) -> dict:
    """On how many places of its lamp the light of each (mirror, lamp) comes from that there is."""
    return {(mirror, lamp): max(obj.reflection_mesh.eyes, 1) for mirror in mirrors for lamp in lamps
            for obj in results_with(context, mirror, lamp)[:1]}
