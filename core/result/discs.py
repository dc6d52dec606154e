"""Discs: the pieces of surface that the points of a result represent."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Discs:
    """Attributes of the points (n) of a result of the method POINTS, besides the arrays of `ReflectionMesh`.

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

    Examples
    --------
    >>> import numpy as np
    >>> from core import Settings, TriangleMesh, View, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> discs = reflect(view, mirror, scene, Settings(method="POINTS")).discs
    >>> sorted(discs.source_vertex.tolist()), discs.axes.shape
    ([0, 1, 2], (3, 2, 3))
    """

    source_vertex: np.ndarray
    mirror_face: np.ndarray
    mirror_weights: np.ndarray
    radius: np.ndarray
    axes: np.ndarray
