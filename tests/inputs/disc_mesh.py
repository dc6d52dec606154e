"""Points with discs as a mesh of polygons, to be drawn and judged as other reflection meshes are."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from core import ReflectionMesh


def polygons_of(mesh: ReflectionMesh, sides: int = 6) -> ReflectionMesh:
    """Every disc as the regular polygon round it, drawn flat; all of it shows the one diffuse point."""
    count = len(mesh.positions)
    angle = 2.0 * np.pi * np.arange(sides) / sides
    corners = np.stack((np.cos(angle), np.sin(angle)), axis=1) / np.cos(np.pi / sides)
    positions = mesh.positions[:, None] + np.einsum("ck,nkx->ncx", corners, mesh.discs.axes)
    fan = np.array([[0, k, k + 1] for k in range(1, sides - 1)])
    return replace(
        mesh, positions=positions.reshape(-1, 3),
        triangles=(sides * np.arange(count)[:, None, None] + fan).reshape(-1, 3),
        reflected_position=np.repeat(mesh.reflected_position, sides, axis=0),
        # no face names a triangle: the judge takes every point further off than its bound for another surface
        source_face=np.full(count * len(fan), -2))
