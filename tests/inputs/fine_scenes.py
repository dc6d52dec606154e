"""Scenes finer than their picture, of which something would be missed if it were drawn together as one surface."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from core import TriangleMesh
from tests.inputs import shapes
from tests.inputs.scenes import SCENES, Scene


def crown(resolution=(128, 128), leaves: int = 9000, size: float = 0.012) -> Scene:
    """A ball of leaves, each a triangle for itself and a fraction of a pixel wide."""
    rng = np.random.default_rng(11)
    middle = rng.normal(size=(leaves, 3))
    middle *= 0.55 / np.linalg.norm(middle, axis=1, keepdims=True)
    corners = middle[:, None] + (-1.2, -2.4, 1.2) + rng.normal(scale=size, size=(leaves, 3, 3))
    triangles = np.arange(3 * leaves).reshape(-1, 3)
    return _before_a_ball("crown", resolution, TriangleMesh(corners.reshape(-1, 3), triangles))


def fence(resolution=(128, 128), wires: int = 60, thick: float = 0.004) -> Scene:
    """Upright wires, a fraction of a pixel thick, one of three sides."""
    turn = np.arange(3) * 2.0 * np.pi / 3.0
    ring = thick * np.stack((np.cos(turn), np.sin(turn), 0.0 * turn), axis=1)
    heights = np.linspace(0.1, 1.6, 60)
    points = ring[None] + heights[:, None, None] * (0.0, 0.0, 1.0)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(59), np.arange(3), indexing="ij"))
    a, b, c, d = i * 3 + j, i * 3 + (j + 1) % 3, (i + 1) * 3 + (j + 1) % 3, (i + 1) * 3 + j
    one = np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1)))
    positions = points.reshape(-1, 3)[None] + np.linspace((-2.2, -2.6, 0.0), (1.6, -2.6, 0.0), wires)[:, None]
    triangles = one[None] + (np.arange(wires) * points.shape[0] * 3)[:, None, None]
    return _before_a_ball("fence", resolution, TriangleMesh(positions.reshape(-1, 3), triangles.reshape(-1, 3)))


def coat(resolution=(96, 96), between: float = 0.004) -> Scene:
    """A ball with a skin around it, closer than a pixel, each of small triangles."""
    balls = [shapes.icosphere((-1.0, -2.6, 0.9), radius, 5) for radius in (0.6, 0.6 + between)]
    return _before_a_ball("coat", resolution, shapes.combine(*balls))


def _before_a_ball(name: str, resolution, scene: TriangleMesh) -> Scene:
    case = SCENES["sphere"](resolution)
    return replace(case, name=name, scene=scene)
