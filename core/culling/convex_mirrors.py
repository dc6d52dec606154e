"""Test for mirrors that bound one convex body, such as balls: seen from outside, they never see themselves."""
from __future__ import annotations

import numpy as np

from ..cameras import MirrorSurface
from ..geometry import TriangleMesh, dot, rows, spread_directions

DIRECTIONS = 64  # directions in which the farthest corner of a body is searched


def outer_side(mirrors: TriangleMesh, surface: MirrorSurface, beyond: np.ndarray, room: float) -> float:
    """Return the outer side of mirrors that bound one closed convex body: 1 where normals point outwards, else -1.

    Return 0 if the mirrors are not closed or not convex.

    Parameters
    ----------
    beyond : (3, m, 3) float64, far corners of the triangles across each side, NaN for none
    room : float, tolerance for heights above a plane, in scene units
    """
    heights = dot(beyond - surface.a[:, :, None], surface.face_normal[:, :, None])
    for side in (1.0, -1.0):
        if (side * heights <= room).all():  # False for NaN, at open borders
            break
    else:
        return 0.0
    # a surface that winds around itself is locally convex but not a convex body
    corners = rows(mirrors.positions[mirrors.used])
    for direction in spread_directions(DIRECTIONS):
        farthest = corners[:, np.argmax(dot(direction, corners))]
        if (side * dot(farthest[:, None] - surface.a, surface.face_normal) > room).any():
            return 0.0
    return side
