"""Test for cameras whose rays may cross: only there images may be mirrored, and a point may have several images."""
from __future__ import annotations

import numpy as np

from ..geometry import cross, dot, norm
from .three_ray_cameras import Cameras


def may_fold(cameras: Cameras) -> np.ndarray:
    """Return True (n,) for cameras whose rays may cross at some distance s.

    They may if the area of the moved triangle across a corner's ray, n0 + s n1 + s^2 n2, has coefficients of both
    signs.
    """
    places, rays = cameras.origins[:, cameras.corners], cameras.rays[:, cameras.corners]
    p, q = places[:, :, 1] - places[:, :, 0], places[:, :, 2] - places[:, :, 0]
    r, t = rays[:, :, 1] - rays[:, :, 0], rays[:, :, 2] - rays[:, :, 0]
    normals = cross(p, q), cross(p, t) + cross(r, q), cross(r, t)
    coefficients = np.stack([dot(normal[:, :, None], rays) for normal in normals])
    # treat coefficients below rounding, as on flat mirrors, as zero: places and rays may have different units
    size, turn = norm(p) + norm(q), norm(r) + norm(t)
    size, turn, length = size[:, None], turn[:, None], norm(rays)
    noise = 1e-12 * length * np.stack((size * size + 0.0 * length, size * length, turn * length))
    return (coefficients > noise).any(axis=(0, 2)) & (coefficients < -noise).any(axis=(0, 2))
