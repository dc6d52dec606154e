"""Pairs of any size worked on near the size 1: a change of scale by powers of two changes no bit, only distances."""
from __future__ import annotations

import numpy as np

_SMALL, _LARGE = 2.0 ** -98, 2.0 ** 98
"""Pairs whose largest place and velocity lie between these need no other scale: lengths of differences, under 4 times
as large, are ordinary to `certain_pairs`."""


def strange_sizes(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which pairs (n,) are so large or small that numbers might overflow or lose digits."""
    return np.any([(size > 0.0) & ((size < _SMALL) | (size > _LARGE)) for size in _sizes(vertices, rays, points)],
                  axis=0)


def of_ordinary_size(vertices: np.ndarray, rays: np.ndarray,
                     points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The pairs (n) with their largest place and their largest velocity between 1/2 and 1, and the powers (n,) of two
    by which their distances are less for it."""
    place, speed = (np.frexp(size)[1] for size in _sizes(vertices, rays, points))
    vertices, rays, points = (np.ldexp(given.T, -power).T
                              for given, power in ((vertices, place), (rays, speed), (points, place)))
    return vertices, rays, points, place - speed


def _sizes(vertices, rays, points):
    count = len(points)
    return (np.maximum(np.abs(vertices).reshape(count, 9).max(axis=1), np.abs(points).max(axis=1)),
            np.abs(rays).reshape(count, 9).max(axis=1))
