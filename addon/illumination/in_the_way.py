"""What stands in the light's way: opaque objects beside the mirrors and what they light, and what of that is opaque."""
from __future__ import annotations

import bpy
import numpy as np

from ... import core
from ..reading import DiffuseScene, Participants, is_clear, is_opaque, materials_of, may_have_faces, read_scene

ALL_CLEAR = "Light goes through all that is to be lit: select what it is to fall on, or give it the role Reflected."


def blocking(context: bpy.types.Context, chosen: Participants) -> list:
    """What else stands in the light's way: all that casts shadows and has parts that no light goes through."""
    part_takers = {*chosen.mirrors, *chosen.diffuse}
    return [obj for obj in context.view_layer.objects
            if obj not in part_takers and may_have_faces(obj) and obj.visible_get()
            and not obj.hide_render and obj.visible_shadow
            and obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}
            and any(map(is_opaque, materials_of(obj) or [None]))]


def blockers_of(depsgraph: bpy.types.Depsgraph, objects: list) -> core.TriangleMesh | None:
    """What of objects no light goes through, as one mesh; None where none of them has such faces."""
    if not objects:
        return None
    try:
        scene = read_scene(depsgraph, objects)
    except core.ReflectionError:
        return None
    opaque = np.array([is_opaque(material) for material in scene.materials])[scene.material]
    if opaque.all():
        return scene.mesh
    return core.TriangleMesh(scene.mesh.positions, scene.mesh.triangles[opaque]) if opaque.any() else None


def receiving(scene: DiffuseScene) -> tuple[core.TriangleMesh, np.ndarray]:
    """What of a scene light ends on, and which of its triangles (k,) that is: clear glass is not lit, and what lies
    behind it is.

    Raises
    ------
    core.ReflectionError
        Where there is no such thing.
    """
    clear = np.array([is_clear(material) for material in scene.materials])[scene.material]
    if clear.all():
        raise core.ReflectionError(ALL_CLEAR)
    kept = np.flatnonzero(~clear)
    if not clear.any():
        return scene.mesh, kept
    return core.TriangleMesh(scene.mesh.positions, scene.mesh.triangles[kept]), kept
