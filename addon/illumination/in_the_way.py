"""What stands in the light's way: opaque objects beside the mirrors and what they light."""
from __future__ import annotations

import bpy
import numpy as np

from ... import core
from ..reading import Participants, is_opaque, materials_of, may_have_faces, read_scene, seen_in


def blocking(context: bpy.types.Context, chosen: Participants) -> list:
    """What else stands in the light's way: all that casts shadows and has parts that no light goes through."""
    part_takers, is_seen = {*chosen.mirrors, *chosen.diffuse}, seen_in(context)
    return [obj for obj in context.view_layer.objects
            if obj not in part_takers and may_have_faces(obj) and is_seen(obj) and obj.visible_shadow
            and obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}
            and any(map(is_opaque, materials_of(obj) or [None]))]


def blockers_of(depsgraph: bpy.types.Depsgraph, objects: list) -> core.TriangleMesh | None:
    """What of objects no light goes through, as one mesh; None where none of them has such faces."""
    if not objects:
        return None
    try:
        scene = read_scene(depsgraph, objects, unmirrored=True)
    except core.ReflectionError:
        return None
    opaque = np.array([is_opaque(material) for material in scene.materials])[scene.material]
    if opaque.all():
        return scene.mesh
    return core.TriangleMesh(scene.mesh.positions, scene.mesh.triangles[opaque]) if opaque.any() else None
