"""Squares of the picture: cameras are cut along their sides, so that each part lies in one square."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..polygons import ConvexPolygons, Line
from ..support import breathe

CUTS = 64  # halvings one after another: enough for 2^32 squares along both sides of the picture
TOUCHING = 1e-6  # of a square: what reaches less far into it only touches it
ASIDE = np.array([0.005, 0.0])  # squares: from the middle, where pixels look; far more than single precision rounds by


@dataclass(frozen=True)
class SquareGrid:
    """Squares of the picture round all that some cameras cover of it.

    Attributes
    ----------
    low : (2,) float64, where the first one begins, in pixels
    side : float, in pixels
    size : (width, height), in squares
    """

    low: np.ndarray
    side: float
    size: tuple[int, int]

    @classmethod
    def over(cls, cameras: Cameras, side: float) -> SquareGrid:
        """Those of the squares with a `side` of so many pixels that lie in the picture whole."""
        first = first_side(side)
        resolution = np.array(cameras.view.resolution, dtype=np.float64)
        pixels = np.clip(np.nan_to_num(cameras.view.pixels(cameras.places.T)), 0.0, resolution)[cameras.corners.ravel()]
        low = np.maximum(np.floor((pixels.min(axis=0) - first) / side), 0.0)
        high = np.minimum(np.ceil((pixels.max(axis=0) - first) / side), np.floor((resolution - first) / side))
        width, height = (max(int(count), 0) for count in high - low)
        return cls(first + low * side, side, (width, height))

    def spots(self, pixels: np.ndarray) -> np.ndarray:
        """Places (2, ...) in the picture, as columns and rows of the grid."""
        return (pixels - self.low.reshape(2, *(1,) * (pixels.ndim - 1))) / self.side

    def pixels(self, column: np.ndarray, row: np.ndarray) -> np.ndarray:
        """(n, 2): where columns and rows (n,) lie in the picture."""
        return self.low + self.side * np.stack((column, row), axis=1)


def first_side(size: float) -> float:
    """Where squares of `size` pixels begin, so that the first pixel's middle is in the middle of one: where pixels hold
    a whole number of squares or squares an odd number of pixels, that is so for all."""
    return (0.5 - 0.5 * size) % size


def in_squares(cameras: Cameras, size: float,
               done: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> ConvexPolygons:
    """The parts of cameras in squares of `size` pixels; beyond the picture nothing, and nothing that lies in boxes from
    low to high (2, n) pixels that are `done`."""
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
        low, high = _reaches(parts, across, depth)
        if done is not None:
            left = ~done(low + first_side(size), high + first_side(size))
            parts, low, high = parts.select(left), low[:, left], high[:, left]
        first, last = np.floor(low / size + TOUCHING) + 1.0, np.ceil(high / size - TOUCHING) - 1.0
        sides = last - first + 1.0
        axis = np.argmax(sides, axis=0)
        chosen = np.flatnonzero(sides.max(axis=0, initial=0.0) > 0.0)
        if not len(chosen):
            break
        axis, of = axis[chosen], parts.owner[chosen]
        side = size * np.floor(0.5 * (first + last))[axis, chosen]
        parts = parts.halved(chosen, across[axis, :, of].T - side * depth[:, of])
        parts = parts.select(parts.size >= 3)
    return parts


def _reaches(parts: ConvexPolygons, across: np.ndarray, depth: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The pixels (2, q) from and to which the parts reach."""
    of = parts.owner[parts.polygon]
    deep = (parts.weights * depth[:, of]).sum(axis=0)
    return parts.extents((parts.weights * across[:, :, of]).sum(axis=1) / np.where(deep > 0.0, deep, 1.0))
