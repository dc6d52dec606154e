"""Scenes made to measure methods on: the setting of the talk's cost model, and the same with more and more of each."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import TriangleMesh
from ...views import View
from .shapes import combine, icosphere, sheet, torus
from .tessellation import tessellated


@dataclass(frozen=True)
class MadeScene:
    """A view, a mirror and a diffuse scene."""

    view: View
    mirror: TriangleMesh
    scene: TriangleMesh


def talk_setting(resolution: tuple[int, int], columns: int = 32, rows: int = 31) -> MadeScene:
    """A bulging mirror that fills the picture, before a floor, four balls and a ring of 1,049 vertices and 2,016
    triangles; as the talk sets it, the mirror has 1,056 vertices and 1,984 triangles."""
    def bulge(u, v):
        x, z = 1.1 * (2.0 * u - 1.0), 1.1 * (2.0 * v - 1.0)
        normals = np.stack((0.6 * x, -np.ones_like(x), 0.6 * z), axis=1)
        return np.stack((x, 0.3 * (x * x + z * z), z), axis=1), normals / np.linalg.norm(normals, axis=1)[:, None]

    def floor(u, v):
        upwards = np.broadcast_to((0.0, 0.0, 1.0), (len(u), 3))
        return np.stack((8.0 * (2.0 * u - 1.0), -9.0 * v, np.full_like(u, -1.5)), axis=1), upwards

    balls = [icosphere(centre, radius, 2) for centre, radius in (
        ((-2.6, -2.8, -0.6), 0.9), ((2.7, -3.2, 0.0), 1.1), ((-1.9, -5.5, 1.4), 0.8), ((1.2, -4.5, 2.3), 0.9))]
    scene = combine(sheet(floor, 16, 16), *balls, torus((0.4, -4.2, -1.1), 0.7, 0.25, 16, 7))
    view = View.looking_at((0.0, -6.0, 0.3), (0.0, 0.0, 0.0), resolution, field_of_view=0.3)
    return MadeScene(view, combine(sheet(bulge, columns, rows)), scene)


def with_vertices(vertices: int, resolution: tuple[int, int]) -> MadeScene:
    """The talk's setting with about so many diffuse vertices on the same surfaces."""
    made = talk_setting(resolution)
    return MadeScene(made.view, made.mirror, tessellated(made.scene, vertices)[0])


def with_mirror_triangles(triangles: int, resolution: tuple[int, int]) -> MadeScene:
    """The talk's setting with about so many triangles of the mirror."""
    side = max(1, round((triangles / 2.0) ** 0.5))
    return talk_setting(resolution, side, side)
