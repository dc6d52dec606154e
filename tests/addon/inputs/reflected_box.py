"""A box before a mirror that shows it already, and what happens to them before the button is pressed again."""
from __future__ import annotations

import bpy
import numpy as np
import parts


def reflected_box() -> tuple:
    """A box, a wall mirror with a mirror's material, and the reflection of one in the other."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "PRINCIPLED"))
    parts.select(cube, mirror)
    return mirror, cube, parts.generate()


def moved(cube) -> None:
    cube.location.x += 0.4
    bpy.context.view_layer.update()


def middle(result) -> np.ndarray:
    return parts.attribute(result, "reflected_position").mean(axis=0)


def second_camera() -> bpy.types.Object:
    bpy.ops.object.camera_add(location=(2.0, -6.0, 1.0), rotation=(1.45, 0.0, 0.3))
    other = bpy.context.object
    other.name = "Other"
    other.select_set(False)
    return other


def results() -> list:
    return sorted(obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION")
