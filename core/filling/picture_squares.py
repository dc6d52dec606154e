"""A grid of squares in the picture; cameras are cut along its lines, so that each part lies in one square."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..polygons import ConvexPolygons, Line
from ..support import breathe

CUTS = 64  # successive halvings: enough for 2^32 squares along both sides of the picture
TOUCHING = 1e-6  # share of a square's side: polygons that overlap a square less only touch it
ASIDE = np.array([0.005, 0.0])  # offset from the centre, in squares: off the pixel centres, far above single precision


@dataclass(frozen=True)
class SquareGrid:
    """A grid of squares that covers the pictures of some cameras.

    Attributes
    ----------
    low : (2,) float64, low corner of the first square, in pixels
    side : float, side of a square, in pixels
    size : (width, height), number of squares
    """

    low: np.ndarray
    side: float
    size: tuple[int, int]

    @classmethod
    def over(cls, cameras: Cameras, side: float) -> SquareGrid:
        """Return the grid over the cameras of squares with a `side` in pixels that lie completely in the picture."""
        first = first_side(side)
        resolution = np.array(cameras.view.resolution, dtype=np.float64)
        pixels = np.clip(np.nan_to_num(cameras.view.pixels(cameras.places.T)), 0.0, resolution)[cameras.corners.ravel()]
        low = np.maximum(np.floor((pixels.min(axis=0) - first) / side), 0.0)
        high = np.minimum(np.ceil((pixels.max(axis=0) - first) / side), np.floor((resolution - first) / side))
        width, height = (max(int(count), 0) for count in high - low)
        return cls(first + low * side, side, (width, height))

    def spots(self, pixels: np.ndarray) -> np.ndarray:
        """Convert positions (2, ...) in pixels to columns and rows (2, ...) of the grid."""
        return (pixels - self.low.reshape(2, *(1,) * (pixels.ndim - 1))) / self.side

    def pixels(self, column: np.ndarray, row: np.ndarray) -> np.ndarray:
        """Convert columns and rows (n,) of the grid to positions (n, 2) in pixels."""
        return self.low + self.side * np.stack((column, row), axis=1)


def first_side(size: float) -> float:
    """Return the offset in pixels of a grid of squares of `size` pixels, such that square centres hit pixel centres.

    The centre of the first pixel is the centre of a square. This holds for all pixels if a pixel is a whole number of
    squares, or a square an odd number of pixels.
    """
    return (0.5 - 0.5 * size) % size


def in_squares(cameras: Cameras, size: float,
               done: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> ConvexPolygons:
    """Cut cameras along squares of `size` pixels; parts outside of the picture are dropped.

    `done` takes boxes from low to high (2, n), in pixels, and returns True (n,) for boxes whose polygons to drop.
    """
    width, height = cameras.view.resolution
    clip = cameras.view.clip(cameras.places.T)[cameras.corners.T]  # [corner, camera, component]
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
    """Return the low and the high corner (2, q) of the parts' bounding boxes, in pixels."""
    of = parts.owner[parts.polygon]
    deep = (parts.weights * depth[:, of]).sum(axis=0)
    return parts.extents((parts.weights * across[:, :, of]).sum(axis=1) / np.where(deep > 0.0, deep, 1.0))
