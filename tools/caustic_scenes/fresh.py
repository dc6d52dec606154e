"""Four scenes more that caustics were not made with: an open can, a ball of facets, a staircase, two bent sheets."""
from __future__ import annotations

import numpy as np

from tools.caustic_scenes.building import empty, faceted, lamp, metal, plain, sheet, take_part


def _can() -> None:
    """An open can under a spot with a soft edge: curves on its bottom, and before it on the table."""
    empty((0.9, -1.9, 3.4), (0.1, -0.15, 0.2))
    angle = np.linspace(0.0, 2.0 * np.pi, 128, endpoint=False)
    height = np.linspace(0.004, 0.8, 5)[:, None]
    wall = np.stack([np.broadcast_to(values, (5, 128)) for values in (
        0.5 * np.cos(angle), 0.5 * np.sin(angle), height)], axis=-1)
    bottom = plain("circle", radius=0.499, vertices=128, fill_type="NGON", location=(0.0, 0.0, 0.004))
    bottom.name = "Bottom"
    take_part(metal(sheet("Can", wall, True)), [plain("plane", size=6.0), bottom],
              lamp("SPOT", (1.6, -1.3, 2.8), (0.0, 0.0, 0.5), energy=300.0, shadow_soft_size=0.02, spot_size=0.5,
                   spot_blend=0.8))


def _disco() -> None:
    """A ball of flat facets in a corner of a room, in the sun."""
    import bpy
    empty((-2.6, -3.6, 2.2), (0.4, 0.6, 1.2))
    bpy.ops.mesh.primitive_uv_sphere_add(segments=40, ring_count=20, radius=0.5, location=(0.0, 0.0, 1.6))
    ball = faceted(bpy.context.object)
    walls = [plain("plane", size=5.0),
             plain("plane", size=5.0, location=(0.0, 2.5, 2.5), rotation=(np.pi / 2, 0.0, 0.0)),
             plain("plane", size=5.0, location=(2.5, 0.0, 2.5), rotation=(0.0, -np.pi / 2, 0.0)),
             plain("plane", size=5.0, location=(0.0, 0.0, 4.0), rotation=(np.pi, 0.0, 0.0))]
    take_part(ball, walls,
              lamp("SUN", (-1.0, -1.0, 3.0), (-0.7, -0.5, 0.45), energy=3.0, angle=0.009))


def _stairs() -> None:
    """A staircase of mirrors under an area lamp, between a wall and the ceiling: three mirrors that show each other."""
    import bpy
    empty((-3.0, -4.2, 2.4), (0.3, 0.3, 1.4))
    rise, run, count = 0.25, 0.4, 5
    y = np.repeat(np.arange(count + 1), 2)[1:] * run - 1.0
    z = np.repeat(np.arange(count + 1), 2)[:-1] * rise + 0.01
    line = np.column_stack((np.zeros(len(y)), y, z))
    steps = np.stack([line + (x, 0.0, 0.0) for x in (-0.8, 0.8)])
    stairs = faceted(sheet("Stairs", steps))
    bpy.context.scene.reflection_mesh.depth = 2
    take_part(stairs, [plain("plane", size=8.0),
                       plain("plane", size=8.0, location=(0.0, 2.0, 2.0), rotation=(np.pi / 2, 0.0, 0.0)),
                       plain("plane", size=8.0, location=(0.0, 0.0, 4.2), rotation=(np.pi, 0.0, 0.0))],
              lamp("AREA", (0.7, -1.6, 3.6), (0.0, 0.4, 0.6), energy=200.0, size=0.2))


def _sheets() -> None:
    """A bent sheet with waves across it, which throws a lamp's light twice, on floor and wall."""
    import bpy
    empty((-3.6, -4.4, 2.8), (0.0, 0.4, 0.8))
    across, along = np.meshgrid(np.linspace(-1.0, 1.0, 72), np.linspace(0.0, 1.9, 72), indexing="ij")
    radius = 1.2 + 0.02 * np.sin(7.0 * across + 2.0 * along) + 0.015 * np.sin(3.0 * across - 9.0 * along)
    points = np.stack((across, 0.9 - radius * np.cos(1.1 * along - 1.0) + 0.6,
                       1.3 + radius * np.sin(1.1 * along - 1.0)), axis=-1)
    points[..., 1] = 1.8 - points[..., 1]
    bent = metal(sheet("Sheet", points))
    bpy.context.scene.reflection_mesh.depth = 2
    take_part(bent, [plain("plane", size=7.0),
                     plain("plane", size=7.0, location=(0.0, 2.6, 2.0), rotation=(np.pi / 2, 0.0, 0.0))],
              lamp("POINT", (0.3, -1.6, 1.9), (0.0, 0.0, 0.0), energy=120.0, shadow_soft_size=0.02))


SCENES = {"can": _can, "disco": _disco, "stairs": _stairs, "sheets": _sheets}
