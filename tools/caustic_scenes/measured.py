"""Scenes by which caustics are measured, beside the samples."""
from __future__ import annotations

import numpy as np

from tools.caustic_scenes.building import empty, lamp, metal, plain, sheet, take_part


def _waves() -> None:
    """A metal as wavy as water before a wall, in the sun."""
    count = 96
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, count), np.linspace(-2.2, 1.4, count), indexing="ij")
    z = (0.012 * np.sin(3.1 * x + 4.7 * y) + 0.010 * np.sin(-5.3 * x + 2.9 * y + 1.0) + 0.007 * np.sin(
        7.1 * x + 1.3 * y + 2.0) + 0.006 * np.sin(-2.2 * x + 8.3 * y + 0.5))
    empty((-0.8, -4.4, 1.9), (0.1, 1.0, 0.9))
    take_part(metal(sheet("Water", np.stack((x, y, z), axis=-1))),
              [plain("plane", size=6.0, location=(0.0, 1.5, 2.0), rotation=(np.pi / 2, 0.0, 0.0))],
               lamp("SUN", (0.0, 0.0, 3.0), (-0.25, -1.0, 0.9), energy=3.0, angle=0.009))


def _bowl() -> None:
    """A bowl on its side that gathers light on a wall."""
    import bpy
    empty((-3.0, -4.5, 2.5), (0.0, 0.3, 1.0))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=96, ring_count=48, radius=1.0, location=(0.0, 1.0, 1.0),
                                         rotation=(np.pi / 2, 0.0, 0.0))
    bowl = bpy.context.object
    import bmesh
    body = bmesh.new()
    body.from_mesh(bowl.data)
    bmesh.ops.delete(body, geom=[vertex for vertex in body.verts if vertex.co.z > -0.45], context="VERTS")
    body.to_mesh(bowl.data)
    body.free()
    take_part(metal(bowl), [plain("plane", size=8.0), plain("plane", size=1.0, location=(0.4, 0.6, 0.5),
                                                           rotation=(np.pi / 2, 0.0, 0.4))],
               lamp("POINT", (0.6, -2.0, 2.2), (0.0, 1.0, 1.0), energy=200.0, shadow_soft_size=0.05))


def _cylinder() -> None:
    """A tin on a floor, in the sun."""
    import bpy
    empty((1.5, -5.0, 4.0), (0.0, -0.8, 0.0))
    bpy.ops.mesh.primitive_cylinder_add(vertices=96, radius=0.6, depth=1.4, location=(0.0, 0.0, 0.7))
    take_part(metal(bpy.context.object), [plain("plane", size=9.0)],
               lamp("SUN", (0.0, 0.0, 5.0), (-0.5, -2.0, 1.5), energy=3.0, angle=0.009))


def _bathroom() -> None:
    """A tilted mirror over a basin, and a window's light that it throws on floor and wall."""
    import bpy
    empty((3.0, -4.0, 3.0), (0.0, 0.0, 0.6))
    bpy.ops.mesh.primitive_plane_add(size=1.2, location=(0.0, 1.4, 1.6), rotation=(1.5, 0.0, 0.0))
    mirror = bpy.context.object
    basin = plain("cylinder", radius=0.35, depth=0.2, location=(0.1, 0.9, 0.8), vertices=48)
    take_part(metal(mirror), [plain("plane", size=6.0), basin, plain("plane", size=6.0, location=(0.0, 1.5, 2.0),
                                                                         rotation=(np.pi / 2, 0.0, 0.0))],
               lamp("SPOT", (1.0, -2.5, 3.2), (0.0, 1.4, 1.6), energy=300.0, shadow_soft_size=0.05, spot_size=0.6))


def _suzanne() -> None:
    """A monkey of chrome on a floor."""
    import bpy
    empty((2.5, -4.5, 3.5), (0.0, -0.8, 0.4))
    bpy.ops.mesh.primitive_monkey_add(size=1.6, location=(0.0, 0.2, 0.8), rotation=(-0.4, 0.0, 0.0))
    monkey = bpy.context.object
    monkey.modifiers.new("Smooth", "SUBSURF").levels = 1
    take_part(metal(monkey), [plain("plane", size=8.0)],
               lamp("POINT", (1.6, -2.4, 2.2), (0.0, 0.0, 0.8), energy=200.0, shadow_soft_size=0.05))


SCENES = {"waves": _waves, "bowl": _bowl, "cylinder": _cylinder, "bathroom": _bathroom, "suzanne": _suzanne}
