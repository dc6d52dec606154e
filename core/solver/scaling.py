"""Scaling of pairs to sizes near 1 by powers of two, which changes no digit of the result, only the distances."""
from __future__ import annotations

import numpy as np


def of_ordinary_size(vertices: np.ndarray, rays: np.ndarray,
                     points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Scale pairs (n) so that their largest place and velocity lie between 1/2 and 1, without overflow or lost digits.

    Returns
    -------
    vertices, rays, points : scaled
    power : (n,) int, multiply distances by 2**power to undo the scaling
    """
    count = len(points)
    places = np.maximum(np.abs(vertices).reshape(count, 9).max(axis=1), np.abs(points).max(axis=1))
    place, speed = (np.frexp(size)[1] for size in (places, np.abs(rays).reshape(count, 9).max(axis=1)))
    vertices, rays, points = (np.ldexp(given.T, -power).T
                              for given, power in ((vertices, place), (rays, speed), (points, place)))
    return vertices, rays, points, place - speed
