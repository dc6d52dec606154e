"""Find the objects that are mirrors, by their role or by the materials of their faces."""
from __future__ import annotations

from collections.abc import Callable

import bpy

from .materials import (
    all_fog,
    instanced_materials,
    instances_otherwise,
    is_mirror,
    materials_on_faces,
    mirror_roughness,
    mirrors_in_part,
    own_materials,
)
from .results import RESULTS

GEOMETRY = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
# Roughness up to which a reflection in a ball can be recognised: Cycles still shows cubes as spots of their colours.
# A rougher object in a selection is a mirror only if it is the active object and nothing else qualifies.
RECOGNISABLE = 0.3
NONE, IN_PART, WHOLE = range(3)
IsMirror = Callable[[bpy.types.Material | None], bool]


def can_take_part(obj: bpy.types.Object) -> bool:
    """Return True for objects that may have faces or instances, except fog, results and ignored objects."""
    return obj.reflection_mesh.role not in {"IGNORE", *RESULTS} and may_have_faces(obj) and not all_fog(obj)


def may_have_faces(obj: bpy.types.Object) -> bool:
    """Return True for objects that may have faces: their own, those of instances, or those of Geometry Nodes."""
    return obj.type in GEOMETRY or obj.is_instancer or any(modifier.type == "NODES" for modifier in obj.modifiers)


def says_mirror(obj: bpy.types.Object) -> bool:
    """Return True for a mirror by its role, or by a material of any of its faces or instances."""
    role = obj.reflection_mesh.role
    return role == "MIRROR" or (role == "AUTO" and _share(obj, instanced_materials([obj])[obj], is_mirror) > NONE)


def may_say_mirror(obj: bpy.types.Object, mirrors: set) -> bool:
    """Return True for objects that could be mirrors. Faster than `says_mirror`, since it evaluates no instances.

    Instances of Geometry Nodes or particles could have any of the mirror materials, `mirrors`.
    """
    role = obj.reflection_mesh.role
    if role != "AUTO" or not mirrors:
        return role == "MIRROR"
    return instances_otherwise(obj) or _share(obj, [], mirrors.__contains__) > NONE


def mirrors_among(objects: list) -> list:
    """Return the objects that are mirrors by their role or their material.

    An instance that is a mirror in part only, such as a room with a mirror in it, counts if there is no other mirror.
    """
    instanced = instanced_materials(objects)
    shares = {obj: _share(obj, instanced[obj], is_mirror) for obj in objects if obj.reflection_mesh.role == "AUTO"}
    said = [obj for obj in objects if obj.reflection_mesh.role == "MIRROR"]
    whole = [obj for obj, share in shares.items() if share == WHOLE]
    return said + whole or [obj for obj, share in shares.items() if share == IN_PART]


def rough_among(objects: list, most: float = float("inf")) -> list:
    """Return the automatic objects with a material that is a mirror's but for its roughness, up to the `most` of it."""
    def is_rough(material: bpy.types.Material | None) -> bool:
        roughness = mirror_roughness(material)
        return roughness is not None and roughness <= most
    instanced = instanced_materials(objects)
    return [obj for obj in objects if obj.reflection_mesh.role == "AUTO" and _share(obj, instanced[obj], is_rough)]


def of_selection(objects: list, active: bpy.types.Object | None) -> list:
    """Return the mirrors among selected objects: those that say so, else what is nearly one, else the active one.

    Rough metal counts before the active object, unless that mirrors sharply itself, as glass and lacquer do.
    """
    mirrors = mirrors_among(objects)
    if mirrors:
        return mirrors
    chosen = [active] if active in objects and active.reflection_mesh.role == "AUTO" else []
    if chosen and any(map(mirrors_in_part, materials_on_faces(active))):
        return chosen
    return rough_among(objects, RECOGNISABLE) or chosen


def _share(obj: bpy.types.Object, instanced: list, is_one: IsMirror) -> int:
    """Return how much of an object mirrors.

    An object with the materials of a mirror and of its frame is a mirror as a whole: its other faces do not reflect.
    """
    # slots first: faces are many
    if any(map(is_one, own_materials(obj))) and any(map(is_one, materials_on_faces(obj))):
        return WHOLE
    if obj.instance_type == "COLLECTION" and obj.instance_collection is not None:
        shares = [_share(other, [], is_one) for other in obj.instance_collection.all_objects if can_take_part(other)]
    else:
        shares = [WHOLE * is_one(material) for material in dict.fromkeys(instanced)]
        shares += [NONE] * bool(shares and own_materials(obj))
    return WHOLE if shares and min(shares) == WHOLE else IN_PART if any(shares) else NONE
