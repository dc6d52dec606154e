"""The object that carries the light of one lamp that one mirror throws."""
from __future__ import annotations

import json
from dataclasses import dataclass, replace

import bpy
from mathutils import Matrix

from ..faults import AllOrNothing, keep_data, keep_object
from ..writing import RAYS, MeshArrays, new_beside, write_mesh
from .caustic_material import adds_light, forget_added_light


@dataclass(frozen=True)
class Caustic:
    """What is to be written for one mirror and one lamp.

    Attributes
    ----------
    name : str
        Of a new object.
    mirror, lamp : bpy.types.Object
    sources : list of bpy.types.Object
        What is lit.
    arrays : MeshArrays
        With the receivers' materials.
    counts : dict
    layers : int
        The most faces over each other.
    """

    name: str
    mirror: bpy.types.Object
    lamp: bpy.types.Object
    sources: list
    arrays: MeshArrays
    counts: dict
    layers: int


def results_with(context: bpy.types.Context, mirror: bpy.types.Object, lamp: bpy.types.Object) -> list:
    """Caustics of a mirror and a lamp in the scene that can be changed."""
    return [obj for obj in context.scene.objects if obj.reflection_mesh.role == "CAUSTICS" and obj.type == "MESH"
            and obj.reflection_mesh.mirror == mirror and obj.reflection_mesh.lamp == lamp and obj.library is None]


def write_caustics(context: bpy.types.Context, made: Caustic,
                   whole: AllOrNothing) -> tuple[bpy.types.Object, list]:
    """The light as an object, a new one or the one that is there already, updated in place; and the receivers'
    materials whose colour it does not know. Where something fails, `whole` takes back all that is changed here."""
    earlier = results_with(context, made.mirror, made.lamp)
    if earlier:
        obj = earlier[0]
        # what is to be done at last is said first
        whole.after(forget_added_light, list(obj.data.materials))
        keep_object(obj, whole)
        keep_data(obj, whole)
    else:
        obj = new_beside(context, made.name, made.mirror, whole)
        for rays in RAYS:
            setattr(obj, rays, False)
        obj.lineart.usage = "EXCLUDE"
    materials, unknown = [], []
    for receiver in made.arrays.materials:
        material, known = adds_light(receiver, whole)
        materials.append(material)
        if not known:
            unknown.append(receiver)
    write_mesh(obj.data, replace(made.arrays, materials=materials))
    obj.matrix_world = Matrix.Translation(made.arrays.origin)
    record = obj.reflection_mesh
    record.role, record.mirror, record.lamp = "CAUSTICS", made.mirror, made.lamp
    record.sources.clear()
    for source in made.sources:
        record.sources.add().object = source
    record.counts = json.dumps({name: int(count) for name, count in made.counts.items()})
    record.faces = len(obj.data.polygons)
    return obj, unknown
