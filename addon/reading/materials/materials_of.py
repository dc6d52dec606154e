"""The materials that an object shows, be they its own or those of the collection that it is an instance of."""
from __future__ import annotations

from itertools import compress

import bpy
import numpy as np

from .material_nodes import all_nodes
from .mirror_materials import which_reflect
from .opaque_materials import is_fog

INSTANCING = {"NODES", "PARTICLE_SYSTEM"}
# modifiers that may give faces other slots than the mesh does
REPAINTING = {"BEVEL", "BOOLEAN", "MESH_SEQUENCE_CACHE", "NODES", "SOLIDIFY", "WIREFRAME"}


def materials_of(obj: bpy.types.Object) -> list:
    """Return one material for each slot, None for an empty slot. Materials that Geometry Nodes assign replace the
    object's. An instance of a collection has those of the members as well.
    """
    own = own_materials(obj)
    if obj.instance_type != "COLLECTION" or obj.instance_collection is None:
        return own
    return own + [material for other in obj.instance_collection.all_objects for material in materials_of(other)]


def own_materials(obj: bpy.types.Object) -> list:
    """Return `materials_of` without the materials of an instanced collection."""
    return _in_slots(_shown(obj))


def materials_on_faces(obj: bpy.types.Object) -> list:
    """Return the materials of an object's slots that at least one face uses. Imported meshes often have many unused
    slots.
    """
    shown = _shown(obj)
    own = _in_slots(shown)
    repainted = shown == obj and any(modifier.type in REPAINTING for modifier in obj.modifiers)
    if len(own) < 2 or shown.type != "MESH" or repainted:
        return own
    used = np.zeros(len(shown.data.polygons), dtype=np.int32)
    shown.data.polygons.foreach_get("material_index", used)
    # like Blender, use the last slot for indices that are too large
    return [own[index] for index in np.flatnonzero(np.bincount(used.clip(0, len(own) - 1))).tolist()]


def reflecting_materials(mirrors: list) -> list:
    """Return the distinct materials of `mirrors` that reflect. If none of a mirror's do, return all of that mirror."""
    return list(dict.fromkeys(material for mirror in mirrors for material in _reflecting(mirror)))


def _reflecting(mirror: bpy.types.Object) -> list:
    collected = mirror.instance_type == "COLLECTION" and mirror.instance_collection is not None
    known = (materials_of(mirror) if collected else materials_on_faces(mirror)) + instanced_materials([mirror])[mirror]
    known = list(dict.fromkeys(material for material in known if material is not None))
    return list(compress(known, which_reflect(known)))


def all_materials_of(mirror: bpy.types.Object) -> list:
    """Return `materials_of`, plus the materials of instances by Geometry Nodes, particles, vertices or faces."""
    return materials_of(mirror) + instanced_materials([mirror])[mirror]


def instanced_materials(objects: list) -> dict:
    """Return, for each object, the materials of its instances that are not collection instances. Read them from the
    last evaluation, without a new one.
    """
    found: dict = {obj: [] for obj in objects}
    depsgraph = getattr(getattr(bpy.context, "view_layer", None), "depsgraph", None)
    if depsgraph is None or not any(map(instances_otherwise, objects)):
        return found
    for instance in depsgraph.object_instances:
        owner = instance.parent.original if instance.is_instance else None
        if owner in found and instances_otherwise(owner):
            found[owner] += [None if slot.material is None else slot.material.original
                             for slot in instance.object.material_slots]
    return found


def instances_otherwise(obj: bpy.types.Object) -> bool:
    """Return True for an object that may instance others by Geometry Nodes, particles, vertices or faces."""
    return obj.instance_type in {"VERTS", "FACES"} or any(modifier.type in INSTANCING for modifier in obj.modifiers)


def _shown(obj: bpy.types.Object) -> bpy.types.Object:
    """Return the object as last evaluated if Geometry Nodes may assign its materials, else the object itself. Do not
    evaluate anything: this is called at every redraw.
    """
    if not any(modifier.type == "NODES" and modifier.show_viewport for modifier in obj.modifiers):
        return obj
    layer = getattr(bpy.context, "view_layer", None)
    depsgraph = None if layer is None else layer.depsgraph
    return obj if depsgraph is None else obj.evaluated_get(depsgraph)


def _in_slots(obj: bpy.types.Object) -> list:
    materials = [slot.material for slot in obj.material_slots]
    # look materials up by name: the originals of evaluated copies may have been removed since
    return [bpy.data.materials.get(_key(material)) if material is not None and material.is_evaluated else material
            for material in materials]


def _key(material: bpy.types.Material) -> str | tuple[str, str]:
    return material.name if material.library is None else (material.name, material.library.filepath)


def goes_by_name(obj: bpy.types.Object) -> bool:
    """Return True where materials of an object ask for the number that is random by its name."""
    return any(node.type == "OBJECT_INFO" and node.outputs["Random"].is_linked
               for material in materials_of(obj) if material is not None for node in all_nodes(material.node_tree))


def all_fog(obj: bpy.types.Object) -> bool:
    """Return True for an object whose materials have only a volume and no surface."""
    shown = materials_of(obj)
    return bool(shown) and all(map(is_fog, shown))


def materials_shown(depsgraph: bpy.types.Depsgraph, objects: list) -> dict:
    """Return, by object, the distinct materials that each object currently shows, including those of Geometry Nodes and
    of its instances.
    """
    found: dict = {obj: {} for obj in objects}
    for instance in depsgraph.object_instances:
        owner = (instance.parent if instance.is_instance else instance.object).original
        if owner in found and instance.show_self:
            found[owner].update((slot.material.original, None) for slot in instance.object.material_slots
                                if slot.material)
    return {obj: list(materials) for obj, materials in found.items()}
