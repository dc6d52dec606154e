"""Find occluders of light: opaque objects other than the mirrors and the receivers."""
from __future__ import annotations

import bpy
import numpy as np

from ... import core
from ..reading import Participants, is_opaque, materials_of, may_have_faces, read_scene, seen_in


def blocking(context: bpy.types.Context, chosen: Participants) -> list:
    """Return the visible opaque objects that cast shadows and do not take part."""
    part_takers, is_seen = {*chosen.mirrors, *chosen.diffuse}, seen_in(context)
    return [obj for obj in context.view_layer.objects
            if obj not in part_takers and may_have_faces(obj) and is_seen(obj) and obj.visible_shadow
            and obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}
            and any(map(is_opaque, materials_of(obj) or [None]))]


def blockers_of(depsgraph: bpy.types.Depsgraph, objects: list) -> core.TriangleMesh | None:
    """Return the opaque faces of `objects` as one mesh; None if there are none."""
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
