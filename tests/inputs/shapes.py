"""Surfaces to build scenes from: positions (n, 3), triangles (m, 3) and, where smooth, normals (n, 3)."""
from __future__ import annotations

import numpy as np

from core.rivals.scenes import combine, icosphere, sheet, torus

__all__ = ["bowl", "box", "combine", "cylinder", "icosphere", "quad", "saddle", "sheet", "torus", "uv_sphere", "water"]


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
