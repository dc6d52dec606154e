"""Pairs of any size worked on near the size 1: a change of scale by powers of two changes no bit, only distances."""
from __future__ import annotations

import numpy as np


def of_ordinary_size(vertices: np.ndarray, rays: np.ndarray,
                     points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The pairs (n) with their largest place and their largest velocity between 1/2 and 1, so that no number overflows
    or loses digits; and the powers (n,) of two by which their distances are less for it."""
    count = len(points)
    places = np.maximum(np.abs(vertices).reshape(count, 9).max(axis=1), np.abs(points).max(axis=1))
    place, speed = (np.frexp(size)[1] for size in (places, np.abs(rays).reshape(count, 9).max(axis=1)))
    vertices, rays, points = (np.ldexp(given.T, -power).T
                              for given, power in ((vertices, place), (rays, speed), (points, place)))
    return vertices, rays, points, place - speed
