"""The scenes of formulas with objects of many small triangles, as scans and sculptures have: vertices come first there.

Bumps make neighbouring triangles turn away from each other, as they do on real surfaces.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from core import TriangleMesh, View
from core.geometry import split
from tests.inputs import shapes
from tests.inputs.scenes import SCENES, Scene

LONGEST = 0.12
"""Scene units that a side of a triangle is long at most."""
BUMPS, WAVES = 0.02, (9.0, 11.0, 7.0)


def dense(name: str, resolution=(1024, 1024), longest: float = LONGEST) -> Scene:
    """A scene of `SCENES`, its objects split until no side is longer than `longest`, and made bumpy."""
    case = SCENES[name](resolution)
    size = np.ptp(case.scene.positions, axis=0).max() / 12.0
    positions, triangles = case.scene.positions, case.scene.triangles
    while True:
        sides = np.stack((triangles, np.roll(triangles, -1, axis=1)), axis=2)
        marked = np.linalg.norm(np.diff(positions[sides], axis=2)[:, :, 0], axis=2) > longest * size
        if not marked.any():
            break
        ends, edge = np.unique(np.sort(sides[marked], axis=1), axis=0, return_inverse=True)
        middle = np.full(triangles.shape, -1)
        middle[marked] = len(positions) + edge.ravel()
        parent, local = split(marked)
        triangles = np.take_along_axis(np.concatenate((triangles, middle), axis=1)[parent], local, axis=1)
        positions = np.concatenate((positions, positions[ends].mean(axis=1)))
    shift = BUMPS * size * np.sin(positions[:, [1, 2, 0]] / size * WAVES + (0.3, 1.1, 2.0))
    return replace(case, scene=TriangleMesh(positions + shift, triangles))


def knots_in_a_ball(resolution=(1024, 1024)) -> Scene:
    """Three bumpy knots of 20,000 vertices on a ground, two of which go through the ball that mirrors them."""
    parts = [shapes.quad((0.0, 0.0, 0.0), (6.0, 0.0, 0.0), (0.0, 6.0, 0.0))]
    for middle, turns, size in (((-1.7, -1.5, 1.1), 3, 0.75), ((1.7, -1.4, 1.1), 5, 0.75), ((0.1, -2.9, 0.7), 7, 0.45)):
        i, j = np.meshgrid(np.arange(379), np.arange(17), indexing="ij")
        u, v = i * 2.0 * np.pi / 379, j * 2.0 * np.pi / 17
        radius = 1.0 + 0.35 * np.cos(turns * u)
        way = np.stack((radius * np.cos(2.0 * u), radius * np.sin(2.0 * u), 0.45 * np.sin(turns * u)), axis=-1)
        thick = 0.16 + 0.02 * np.sin(23.0 * u + 3.0 * v) + 0.012 * np.sin(41.0 * u - 7.0 * v)
        out = np.stack((np.cos(2.0 * u) * np.cos(v), np.sin(2.0 * u) * np.cos(v), np.sin(v)), axis=-1)
        a, b, c, d = ((((i + x) % 379) * 17 + (j + y) % 17).ravel() for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
        parts.append((((way + thick[..., None] * out) * size + middle).reshape(-1, 3),
                      np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1))), None))
    scene = shapes.combine(*parts)
    view = View.looking_at((0.2, -5.4, 2.6), (0.08, 0.0, 1.2), resolution, field_of_view=2.0 * np.arctan(18.0 / 58.0))
    return Scene("knots", view, shapes.combine(shapes.uv_sphere((0.1, 0.2, 1.26), 1.2, 28, 28)),
                 TriangleMesh(scene.positions, scene.triangles))


def posts_in_water(resolution=(512, 512)) -> Scene:
    """Boxes and a ball that stand in waves of 96 x 96 cells."""
    boxes = (shapes.box((-1.2, 0.2, 0.5), (0.6, 0.6, 1.6), 0.5), shapes.box((1.3, 0.6, 0.5), (0.5, 0.5, 1.6), 1.1),
             shapes.icosphere((0.1, 1.0, 0.2), 0.5, 4), shapes.quad((0.0, 4.2, 2.0), (4.0, 0.0, 0.0), (0.0, 0.0, 1.9)))
    view = View.looking_at((0.0, -6.0, 2.8), (0.0, 0.4, 0.2), resolution, field_of_view=0.72)
    return Scene("posts", view, shapes.combine(shapes.water(6.0, 0.01, 1.0, 96)), shapes.combine(*boxes))
