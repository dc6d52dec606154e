"""Surfaces to build scenes from: positions (n, 3), triangles (m, 3) and, where smooth, normals (n, 3)."""
from __future__ import annotations

import numpy as np

from ...geometry import TriangleMesh


def icosphere(centre, radius, subdivisions):
    """20 x 4^subdivisions triangles of nearly one size."""
    golden = 0.5 * (1.0 + np.sqrt(5.0))
    a = np.array([[0.0, y, z] for y in (-1.0, 1.0) for z in (-golden, golden)])
    positions = np.concatenate([a, np.roll(a, 1, axis=1), np.roll(a, 2, axis=1)])
    # The corners of one face are the triples at the shortest distance from each other.
    gap = np.linalg.norm(positions[:, None] - positions, axis=2)
    close = (gap > 1.0) & (gap < 2.1)
    i, j, k = np.nonzero(close[:, :, None] & close[:, None, :] & close[None, :, :])
    triangles = np.stack([i, j, k], axis=1)[(i < j) & (j < k)]
    triangles = _outward(positions, triangles)
    for _ in range(subdivisions):
        edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]], axis=2)
        unique, middle = np.unique(edges.reshape(-1, 2), axis=0, return_inverse=True)
        ab, bc, ca = (middle.reshape(-1, 3) + len(positions)).T
        a, b, c = triangles.T
        positions = np.concatenate([positions, positions[unique].mean(axis=1)])
        positions /= np.linalg.norm(positions, axis=1, keepdims=True)
        triangles = np.concatenate([np.stack(t, axis=1) for t in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))])
    normals = positions / np.linalg.norm(positions, axis=1, keepdims=True)
    return normals * radius + centre, triangles, normals


def sheet(function, columns, rows, u=(0.0, 1.0), v=(0.0, 1.0)):
    """A grid of columns x rows quads over `function(u, v)` -> positions, normals; seams and poles are joined."""
    uu, vv = np.meshgrid(np.linspace(*u, columns + 1), np.linspace(*v, rows + 1))
    positions, normals = function(uu.ravel(), vv.ravel())
    start = (np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)).ravel()
    quads = start[:, None] + [0, 1, columns + 2, columns + 1]
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    grain = 1e-9 * np.ptp(positions, axis=0).max()
    _, kept, joined = np.unique(np.round(positions / grain), axis=0, return_index=True, return_inverse=True)
    triangles = joined.reshape(-1)[triangles]
    distinct = (np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)
    return positions[kept], triangles[distinct], normals[kept]


def torus(centre, radius, thickness, segments, sides):
    """A ring about Z; smooth."""
    def surface(u, v):
        normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=1)
        ring = np.stack([np.cos(u), np.sin(u), 0 * u], axis=1)
        return centre + radius * ring + thickness * normals, normals
    return sheet(surface, segments, sides, (0.0, 2.0 * np.pi), (0.0, 2.0 * np.pi))


def combine(*surfaces) -> TriangleMesh:
    """One mesh of several surfaces; those without normals are flat."""
    start, positions, triangles, normals = 0, [], [], []
    for points, faces, smooth in surfaces:
        flat = TriangleMesh(points, faces).corner_normals
        normals.append(flat if smooth is None else smooth[faces])
        positions.append(points)
        triangles.append(faces + start)
        start += len(points)
    return TriangleMesh(np.concatenate(positions), np.concatenate(triangles), np.concatenate(normals))


def _outward(positions, triangles):
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    inward = np.einsum("ni,ni->n", np.cross(b - a, c - a), a) < 0.0
    return np.where(inward[:, None], triangles[:, ::-1], triangles)
