"""Finer meshes of the same surface: mirrors with their normals, and diffuse scenes for methods that move vertices."""
from __future__ import annotations

import numpy as np

from ...geometry import TriangleMesh, areas, shared_edges, split

ROUNDS = 16
_MIDDLES = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.5, 0.5, 0.0], [0.0, 0.5, 0.5],
                     [0.5, 0.0, 0.5]])


def quartered(mesh: TriangleMesh, times: int) -> TriangleMesh:
    """Every triangle cut into four, `times` times over. Normals halfway are those of the interpolation, made unit."""
    for _ in range(times):
        ends, _, edge = shared_edges(mesh.triangles)
        corners = np.concatenate((mesh.triangles, len(mesh.positions) + edge), axis=1)
        parent, local = split(np.ones(mesh.triangles.shape, dtype=bool))
        mesh = TriangleMesh(np.concatenate((mesh.positions, mesh.positions[ends].mean(axis=1))),
                            np.take_along_axis(corners[parent], local, axis=1),
                            np.einsum("mcw,mwx->mcx", _MIDDLES[local], mesh.corner_normals[parent]))
    return mesh


def tessellated(mesh: TriangleMesh, vertices: int) -> tuple[TriangleMesh, np.ndarray]:
    """About `vertices` vertices on the surface of a mesh, evenly, and the triangle of the mesh that each of the finer
    triangles lies in. No coarser than the mesh is."""
    positions, triangles, source = mesh.positions, mesh.triangles, np.arange(len(mesh.triangles))
    area = float(areas(positions[triangles]).sum())
    # assume half as many vertices as triangles, which are about equilateral, with sides of 3/4 of the longest side
    longest = np.sqrt(area / max(vertices, 1) * 2.0 / np.sqrt(3.0)) / 0.75
    for _ in range(ROUNDS):
        ends, _, edge = shared_edges(triangles)
        marked = np.linalg.norm(positions[ends[:, 0]] - positions[ends[:, 1]], axis=1) > longest
        if not marked.any():
            break
        corners = np.concatenate((triangles, (len(positions) + np.cumsum(marked) - 1)[edge]), axis=1)
        parent, local = split(marked[edge])
        positions = np.concatenate((positions, positions[ends[marked]].mean(axis=1)))
        triangles, source = np.take_along_axis(corners[parent], local, axis=1), source[parent]
    return TriangleMesh(positions, triangles), source
