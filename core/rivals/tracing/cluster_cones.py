"""Bounding cones round given rays, a cone for each cluster of them."""
from __future__ import annotations

import numpy as np

from ...geometry import norm, unit
from ...trees import Cones

WIDE = 0.7  # half the length between the axis and a ray from which on a cone holds everything


def cones_around(places: np.ndarray, rays: np.ndarray, start: np.ndarray) -> Cones:
    """A cone round each run of rays.

    Parameters
    ----------
    places, rays : (3, n) float64
        Where the rays start and their unit directions, those of one cluster side by side.
    start : (c,) int64
        Where each cluster begins; none is empty.
    """
    size = np.diff(np.append(start, places.shape[1]))
    low, high = np.minimum.reduceat(places, start, axis=1), np.maximum.reduceat(places, start, axis=1)
    centre = 0.5 * (low + high)
    radius = np.maximum.reduceat(norm(places - np.repeat(centre, size, axis=1)), start)
    total = np.add.reduceat(rays, start, axis=1)
    axis = unit(total)
    half = 0.5 * np.maximum.reduceat(norm(rays - np.repeat(axis, size, axis=1)), start) + 1e-12
    wide = (half >= WIDE) | (norm(total) < 1e-6 * size)
    cosine = np.where(wide, -1.0, 1.0 - 2.0 * half**2)
    sine = 2.0 * half * np.sqrt(np.maximum(1.0 - half**2, 0.0))
    return Cones(centre, radius * (1.0 + 1e-12), axis, sine, cosine)
