"""Discs: what a result of points knows of the pieces of surface that its points stand for."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Discs:
    """What a result of points (n) knows beside `ReflectionMesh`'s own arrays.

    Attributes
    ----------
    source_vertex : (n,) int64
        Vertex of the diffuse scene.
    mirror_face : (n,) int64
        Triangle of the mirror.
    mirror_weights : (n, 3) float64
        Barycentric coordinates of Q in it.
    radius : (n,) float64
        The longer half axis of the ellipse that the eye sees, in scene units at the place where the disc lies.
    axes : (n, 2, 3) float64
        The half axes of the disc itself, at right angles to each other, in scene units.
    """

    source_vertex: np.ndarray
    mirror_face: np.ndarray
    mirror_weights: np.ndarray
    radius: np.ndarray
    axes: np.ndarray
