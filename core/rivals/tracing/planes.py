"""Rays and planes."""
from __future__ import annotations

import numpy as np

from ...geometry import dot


def plane_distance(corners: np.ndarray, origins: np.ndarray, directions: np.ndarray) -> np.ndarray:
    """Distances (n,) at which rays (3, n) meet the planes of triangles with `corners` (3, n, 3)."""
    a, b, c = np.moveaxis(corners, 2, 0)
    normal = np.stack(((b - a)[1] * (c - a)[2] - (b - a)[2] * (c - a)[1],
                       (b - a)[2] * (c - a)[0] - (b - a)[0] * (c - a)[2],
                       (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]))
    with np.errstate(divide="ignore", invalid="ignore"):
        return dot(a - origins, normal) / dot(directions, normal)
