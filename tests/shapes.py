"""Surfaces to build scenes from: positions (n, 3), triangles (m, 3) and, where smooth, normals (n, 3)."""
from __future__ import annotations

import numpy as np

from core import TriangleMesh


def quad(centre, right, up):
    """Two triangles over centre +- right +- up; they face right x up."""
    centre, right, up = (np.asarray(v, dtype=float) for v in (centre, right, up))
    positions = np.array([centre - right - up, centre + right - up, centre + right + up, centre - right + up])
    return positions, np.array([[0, 1, 2], [0, 2, 3]]), None


def box(centre, size, turn=0.0):
    """Twelve triangles; `size` holds full lengths, `turn` an angle about Z in radians."""
    corners = np.array([[x, y, z] for z in (-0.5, 0.5) for y in (-0.5, 0.5) for x in (-0.5, 0.5)]) * size
    cos, sin = np.cos(turn), np.sin(turn)
    corners = corners @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]]) + centre
    sides = np.array([[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]])
    return corners, np.concatenate([sides[:, [0, 1, 2]], sides[:, [0, 2, 3]]]), None


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


def uv_sphere(centre, radius, segments, rings):
    """2 x segments x (rings - 1) triangles, fans at the poles."""
    def surface(u, v):
        normals = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), np.cos(v)], axis=1)
        return centre + radius * normals, normals
    return sheet(surface, segments, rings, (0.0, 2.0 * np.pi), (np.pi, 0.0))


def cylinder(centre, radius, height, segments):
    """The smooth side of an upright cylinder, without caps."""
    def surface(u, v):
        normals = np.stack([np.cos(u), np.sin(u), np.zeros_like(u)], axis=1)
        return centre + radius * normals + np.stack([0 * v, 0 * v, height * (v - 0.5)], axis=1), normals
    return sheet(surface, segments, 1, (0.0, 2.0 * np.pi))


def bowl(centre, radius, opening, segments, rings):
    """The lowest cap of a sphere about `centre`, out to the angle `opening`; normals point inward."""
    def surface(u, v):
        outward = np.stack([np.sin(v) * np.cos(u), np.sin(v) * np.sin(u), -np.cos(v)], axis=1)
        return centre + radius * outward, -outward
    return sheet(surface, segments, rings, (0.0, 2.0 * np.pi), (opening, 0.0))


def torus(centre, radius, thickness, segments, sides):
    """A ring about Z; smooth."""
    def surface(u, v):
        normals = np.stack([np.cos(v) * np.cos(u), np.cos(v) * np.sin(u), np.sin(v)], axis=1)
        ring = np.stack([np.cos(u), np.sin(u), 0 * u], axis=1)
        return centre + radius * ring + thickness * normals, normals
    return sheet(surface, segments, sides, (0.0, 2.0 * np.pi), (0.0, 2.0 * np.pi))


def water(size, height, waves, cells):
    """A square of `size` about the origin whose height is a sum of two sines, with the normals of the sines."""
    k = 2.0 * np.pi * waves / size
    across, along = np.array([k, 0.35 * k]), np.array([-0.45 * k, 0.8 * k])

    def surface(x, y):
        first, second = across[0] * x + across[1] * y, along[0] * x + along[1] * y + 0.7
        z = height * (np.sin(first) + 0.6 * np.sin(second))
        slope = height * (np.cos(first)[:, None] * across + 0.6 * np.cos(second)[:, None] * along)
        normals = np.concatenate([-slope, np.ones((len(x), 1))], axis=1)
        return np.stack([x, y, z], axis=1), normals / np.linalg.norm(normals, axis=1, keepdims=True)
    return sheet(surface, cells, cells, (-0.5 * size, 0.5 * size), (-0.5 * size, 0.5 * size))


def saddle(centre, size, height, cells):
    """A square whose height rises along x and falls along y, by `height` at the middles of its sides; smooth."""
    def surface(x, y):
        k = 4.0 * height / size**2
        normals = np.stack([-2.0 * k * x, 2.0 * k * y, np.ones_like(x)], axis=1)
        places = np.stack([x, y, k * (x**2 - y**2)], axis=1) + centre
        return places, normals / np.linalg.norm(normals, axis=1, keepdims=True)
    return sheet(surface, cells, cells, (-0.5 * size, 0.5 * size), (-0.5 * size, 0.5 * size))


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
