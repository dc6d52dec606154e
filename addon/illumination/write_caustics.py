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
    """The caustics of one mirror and one lamp, before they are written.

    Attributes
    ----------
    name : str
        Name of a new object.
    mirror, lamp : bpy.types.Object
    sources : list of bpy.types.Object
        Lit objects, followed by those that are hidden at the moment.
    arrays : MeshArrays
        With the receivers' materials.
    counts : dict
    layers : int
        Largest number of overlapping faces.
    plain : bool
        True if each of the mirror's materials has one colour or a known texture.
    textured : list of Tint
        Tints of the mirror with a texture.
    eyes : int
        Number of points on the lamp.
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
    """Return the editable caustics of a mirror and a lamp in the scene."""
    return [obj for obj in context.scene.objects if obj.reflection_mesh.role == "CAUSTICS" and obj.type == "MESH"
            and obj.reflection_mesh.mirror == mirror and obj.reflection_mesh.lamp == lamp and obj.library is None]


def caustics_object(context: bpy.types.Context, name: str, pair: tuple, sources: list,
                    whole: AllOrNothing) -> bpy.types.Object:
    """Return the object for the caustics of `pair`, a mirror and a lamp: the existing one, whose mesh may be
    overwritten, or a new one with that name.
    """
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
    """Write the caustics into a new object or the existing one, which is updated in place. Return the object, and the
    receivers' materials whose colour is not known. If something fails, `whole` undoes all changes made here.

    Parameters
    ----------
    keep_materials : bool
        Keep the present materials if they are for the same receivers. Then engines need not compile them again.
    """
    earlier = results_with(context, made.mirror, made.lamp)[:1]
    # registered first, so that it runs last
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
    """Return the number of points on the lamp of the existing caustics, by (mirror, lamp)."""
    return {(mirror, lamp): max(obj.reflection_mesh.eyes, 1) for mirror in mirrors for lamp in lamps
            for obj in results_with(context, mirror, lamp)[:1]}
