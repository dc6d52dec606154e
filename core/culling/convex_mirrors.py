"""Mirrors that bound one convex body, as balls and lenses do: from outside they never see themselves."""
from __future__ import annotations

import numpy as np

from ..cameras import MirrorSurface
from ..geometry import TriangleMesh, dot, rows, spread_directions

DIRECTIONS = 64  # in which a body's farthest corner is looked for


def outer_side(mirrors: TriangleMesh, surface: MirrorSurface, beyond: np.ndarray, room: float) -> float:
    """On which side of their triangles mirrors bound one convex body from without: 1 on that of their normals, -1 on
    the other; 0 where they do not, or not all round. Of `beyond`, the corners (3, m, 3) of the triangles across each
    side, what rises by less than `room` does not count."""
    heights = dot(beyond - surface.a[:, :, None], surface.face_normal[:, :, None])
    for side in (1.0, -1.0):
        if (side * heights <= room).all():  # not where there is nothing beyond
            break
    else:
        return 0.0
    # a surface that winds about itself is convex everywhere but as a whole
    corners = rows(mirrors.positions[mirrors.used])
    for direction in spread_directions(DIRECTIONS):
        farthest = corners[:, np.argmax(dot(direction, corners))]
        if (side * dot(farthest[:, None] - surface.a, surface.face_normal) > room).any():
            return 0.0
    return side
