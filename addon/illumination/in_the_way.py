"""What stands in the light's way, without being lit: opaque objects beside the mirrors and what they light."""
from __future__ import annotations

import bpy

from ... import core
from ..reading import SURFACES, Participants, is_opaque, read_scene


def blocking(context: bpy.types.Context, chosen: Participants) -> list:
    """What else stands in the light's way: all that casts shadows and that no light goes through."""
    part_takers = {*chosen.mirrors, *chosen.diffuse}
    return [obj for obj in context.view_layer.objects
            if obj not in part_takers and obj.type in SURFACES and obj.visible_get() and not obj.hide_render
            and obj.visible_shadow and obj.reflection_mesh.role not in {"REFLECTION", "CAUSTICS"}
            and all(is_opaque(slot.material) for slot in obj.material_slots)]


def blockers_of(depsgraph: bpy.types.Depsgraph, objects: list) -> core.TriangleMesh | None:
    """Objects as one mesh; None where none of them has faces."""
    if not objects:
        return None
    try:
        return read_scene(depsgraph, objects).mesh
    except core.ReflectionError:
        return None
