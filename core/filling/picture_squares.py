"""Squares of the picture: cameras are cut along their sides, so that each part lies in one square."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..polygons import ConvexParts
from ..support import breathe

CUTS = 64  # halvings one after another: enough for 2^32 squares along both sides of the picture
TOUCHING = 1e-6  # of a square: what reaches less far into it only touches it


def in_squares(cameras: Cameras, size: float) -> tuple[ConvexParts, np.ndarray]:
    """The parts of cameras in squares of `size` pixels, from the picture's lower left corner; beyond the picture
    nothing. And the camera (m,) of each part."""
    view = cameras.view
    width, height = view.resolution
    clip = view.clip(cameras.places.T)[cameras.corners.T]  # as (corner, camera, component)
    depth = clip[..., 3]
    across = np.stack((0.5 * width * (clip[..., 0] + depth), 0.5 * height * (clip[..., 1] + depth)))
    parts, camera = ConvexParts.whole(len(cameras)), np.arange(len(cameras))
    for axis, end in enumerate((width, height)):
        parts = parts.cut(across[axis], 0).cut(end * depth - across[axis], 0)
    for _ in range(CUTS):
        breathe()
        part, low, high = _reaches(parts, camera, across, depth)
        first, last = np.floor(low / size + TOUCHING) + 1.0, np.ceil(high / size - TOUCHING) - 1.0
        sides = last - first + 1.0
        axis = np.argmax(sides, axis=0)
        chosen = np.flatnonzero(sides.max(axis=0, initial=0.0) > 0.0)
        if not len(chosen):
            break
        axis, of = axis[chosen], camera[part[chosen]]
        side = size * np.floor(0.5 * (first + last))[axis, chosen]
        values = across[axis, :, of].T - side * depth[:, of]
        parts, camera = parts.halved(len(camera), part[chosen], values), np.concatenate((camera, of))
    return parts, camera


def _reaches(parts: ConvexParts, camera: np.ndarray, across: np.ndarray,
             depth: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The parts that there are, and the pixels (2, m) from and to which they reach."""
    of = camera[parts.polygon]
    deep = (parts.weights * depth[:, of]).sum(axis=0)
    pixels = (parts.weights * across[:, :, of]).sum(axis=1) / np.where(deep > 0.0, deep, 1.0)
    start = np.flatnonzero(np.append(True, parts.polygon[1:] != parts.polygon[:-1])[:len(of)])
    if not len(start):
        return start, pixels, pixels
    return parts.polygon[start], np.minimum.reduceat(pixels, start, axis=1), np.maximum.reduceat(pixels, start, axis=1)
