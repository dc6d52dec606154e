"""Squares of the picture: cameras are cut along their sides, so that each part lies in one square."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..polygons import ConvexPolygons, Line
from ..support import breathe

CUTS = 64  # halvings one after another: enough for 2^32 squares along both sides of the picture
TOUCHING = 1e-6  # of a square: what reaches less far into it only touches it


def first_side(size: float) -> float:
    """Where squares of `size` pixels begin, so that the first pixel's middle is in the middle of one: where pixels hold
    a whole number of squares or squares an odd number of pixels, that is so for all."""
    return (0.5 - 0.5 * size) % size


def in_squares(cameras: Cameras, size: float) -> ConvexPolygons:
    """The parts of cameras in squares of `size` pixels; beyond the picture nothing."""
    width, height = cameras.view.resolution
    clip = cameras.view.clip(cameras.places.T)[cameras.corners.T]  # as (corner, camera, component)
    depth = clip[..., 3]
    across = np.stack((0.5 * width * (clip[..., 0] + depth), 0.5 * height * (clip[..., 1] + depth)))
    parts = ConvexPolygons.whole(len(cameras))
    for axis, end in enumerate((width, height)):
        for values in (across[axis], end * depth - across[axis]):
            breathe()
            parts = parts.cut(values[:, parts.owner], Line.HIDDEN)
            parts = parts.select(parts.size >= 3)
    across -= first_side(size) * depth
    for _ in range(CUTS):
        breathe()
        low, high = _reaches(parts, across, depth)
        first, last = np.floor(low / size + TOUCHING) + 1.0, np.ceil(high / size - TOUCHING) - 1.0
        sides = last - first + 1.0
        breathe()
        axis = np.argmax(sides, axis=0)
        chosen = np.flatnonzero(sides.max(axis=0, initial=0.0) > 0.0)
        if not len(chosen):
            break
        axis, of = axis[chosen], parts.owner[chosen]
        side = size * np.floor(0.5 * (first + last))[axis, chosen]
        breathe()
        parts = parts.halved(chosen, across[axis, :, of].T - side * depth[:, of])
        breathe()
        parts = parts.select(parts.size >= 3)
    return parts


def _reaches(parts: ConvexPolygons, across: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pixels (2, q) from and to which the parts reach."""
    of = parts.owner[parts.polygon]
    deep = (parts.weights * depth[:, of]).sum(axis=0)
    pixels = (parts.weights * across[:, :, of]).sum(axis=1) / np.where(deep > 0.0, deep, 1.0)
    if not len(parts):
        return pixels, pixels
    return (np.minimum.reduceat(pixels, parts.start[:-1], axis=1),
            np.maximum.reduceat(pixels, parts.start[:-1], axis=1))
