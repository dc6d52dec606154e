"""Where vertices are before anything deforms them, which Generated coordinates go by."""
from __future__ import annotations

from contextlib import ExitStack

import bpy
import numpy as np

DEFORMING = {"ARMATURE", "CAST", "CLOTH", "CORRECTIVE_SMOOTH", "CURVE", "DISPLACE", "HOOK", "LAPLACIANDEFORM",
             "LAPLACIANSMOOTH", "LATTICE", "MESH_CACHE", "MESH_DEFORM", "SHRINKWRAP", "SIMPLE_DEFORM", "SMOOTH",
             "SOFT_BODY", "SURFACE_DEFORM", "VOLUME_DISPLACE", "WARP", "WAVE"}


def is_deformed(obj: bpy.types.Object) -> bool:
    """Whether anything moves an object's vertices and makes none."""
    return obj.type == "MESH" and (obj.data.shape_keys is not None or any(
        modifier.type in DEFORMING and modifier.show_viewport for modifier in obj.modifiers))


def undeformed_positions(scene: bpy.types.Scene, obj: bpy.types.Object) -> np.ndarray:
    """Positions (n, 3) float32 of an object's vertices as the viewport of `scene` has them, but for what only moves
    them. Blender tells them in renders alone (`MeshVertex.undeformed_co`)."""
    with ExitStack() as back:
        plain, copy = bpy.data.scenes.new("Reflection Light"), obj.copy()
        back.callback(bpy.data.scenes.remove, plain)
        back.callback(bpy.data.objects.remove, copy)
        plain.render.use_simplify = scene.render.use_simplify
        plain.render.simplify_subdivision = scene.render.simplify_subdivision
        copy.animation_data_clear()
        copy.show_only_shape_key, copy.active_shape_key_index = True, 0
        for modifier in list(copy.modifiers):
            if modifier.type in DEFORMING:
                copy.modifiers.remove(modifier)
        plain.collection.objects.link(copy)
        layer = plain.view_layers[0]
        layer.update()
        mesh = copy.evaluated_get(layer.depsgraph).data
        positions = np.empty((len(mesh.vertices), 3), dtype=np.float32)
        mesh.attributes["position"].data.foreach_get("vector", positions.reshape(-1))
        return positions


def keep_undeformed(obj: bpy.types.Object, positions: np.ndarray) -> None:
    """Let an object that has no modifiers be as it is, and have Generated coordinates as if its vertices were at
    `positions` (n, 3)."""
    place = obj.data.attributes["position"].data
    shown = np.empty(3 * len(place), dtype=np.float32)
    place.foreach_get("vector", shown)
    place.foreach_set("vector", positions.astype(np.float32).reshape(-1))
    obj.show_only_shape_key = False
    obj.shape_key_add(name="Undeformed", from_mix=False)
    key = obj.shape_key_add(name="Deformed", from_mix=False)
    key.data.foreach_set("co", shown)
    key.value = 1.0
