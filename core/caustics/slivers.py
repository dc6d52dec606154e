"""Slivers: faces that are too thin to carry light or to be stored.

The outline of a mirror and the outline of a receiver may fall on the same line, for instance if both are squares with
the same diagonal. Rotation in single precision then leaves a strip between them whose width is rounding. Stored in
single precision again, its faces overlap, and engines draw them as a line.
"""
from __future__ import annotations

import numpy as np

from ..geometry import areas, connected, distinct, edge_lengths, following
from ..result import ReflectionMesh
from .energy import SINGLE

THINNEST = 8.0 * SINGLE  # width over the extent


def without_slivers(seen: ReflectionMesh) -> np.ndarray:
    """Return True (m,) for faces of a lamp's reflection that are not thin both in its picture and on the receivers.

    Faces that are thin in one of them alone are kept: near a focus they carry all of the light, and where light grazes
    they cover all of the receiver.
    """
    view = seen.maps[0].view
    picture = np.pad(view.pixels(seen.mirror_position), ((0, 0), (0, 1)))
    points = seen.reflected_position
    extent = np.ptp(points, axis=0).max(initial=0.0)
    return ~(_are_thin(picture[seen.triangles], max(view.resolution)) & _are_thin(points[seen.triangles], extent))


def merged(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Merge the ends of edges that single precision cannot tell apart.

    Returns
    -------
    vertices : (k,) int64, those of the `positions` (n, 3) that are left
    triangles : (m, 3) int64, between these
    faces : (m,) int64, those of the `triangles` that still have three vertices
    """
    short = edge_lengths(positions[triangles]) <= SINGLE * np.ptp(positions, axis=0).max(initial=0.0)
    every = np.arange(len(positions))
    ends = np.stack((triangles[short], following(triangles)[short]), axis=1)
    part = connected(np.concatenate((np.stack((every, every), axis=1), ends)))[:len(every)]
    _, first = np.unique(part, return_index=True)
    triangles = first[part[triangles]]
    faces = np.flatnonzero((triangles != following(triangles)).all(axis=1))
    vertices, corner = distinct(triangles[faces].ravel())
    return vertices, corner.reshape(-1, 3), faces


def _are_thin(corners: np.ndarray, extent: float) -> np.ndarray:
    """Return True (m,) for triangles with `corners` (m, 3, 3) whose height is nothing beside an extent."""
    return 2.0 * areas(corners) <= THINNEST * extent * edge_lengths(corners).max(axis=1, initial=0.0)
