"""Which pixels of the picture triangles cover, or touch: row by row, the runs that lie in each."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ranges, shares
from ..patches import Patch
from ..support import breathe

ROWS_AT_ONCE = 1 << 14
MOST_SAMPLES = 1 << 23


def box(spots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The lowest and highest (2, f) of three corners (2, 3, f): much faster than along an axis of three."""
    return (np.minimum(np.minimum(spots[:, 0], spots[:, 1]), spots[:, 2]),
            np.maximum(np.maximum(spots[:, 0], spots[:, 1]), spots[:, 2]))


@dataclass(frozen=True)
class Grid:
    """Samples of what the picture shows of the patch: pixels, unless these are too many."""

    low: np.ndarray
    scale: float
    size: tuple[int, int]

    @classmethod
    def over(cls, patch: Patch) -> Grid:
        resolution = np.array(patch.view.resolution, dtype=np.float64)
        low = np.clip(np.floor(patch.border.low), 0.0, resolution)
        high = np.clip(np.ceil(patch.border.high), 0.0, resolution)
        scale = min(1.0, float(np.sqrt(MOST_SAMPLES / max(np.prod(high - low), 1.0))))
        width, height = (max(int(side), 1) for side in np.ceil((high - low) * scale))
        return cls(low, scale, (width, height))

    def spots(self, pixels: np.ndarray) -> np.ndarray:
        """Spots (2, f, 3) of the picture on the grid."""
        return (pixels - self.low[:, None, None]) * self.scale


@dataclass(frozen=True)
class Covered:
    """Which faces cover which pixels.

    Attributes
    ----------
    face, pixel : (k,) int64
    order : (k,) float64, of the faces there
    """

    face: np.ndarray
    pixel: np.ndarray
    order: np.ndarray

    @classmethod
    def of(cls, corners: np.ndarray, order: np.ndarray, size: tuple[int, int], touched: bool) -> Covered:
        """Pixels whose middles lie in triangles with `corners` (2, 3, f) and the `order` (3, f) there; or all that they
        touch, with the greatest order in them."""
        none = np.zeros(0, dtype=np.int64)
        parts = [(none, none, np.zeros(0))]
        (_, low), (_, high) = box(corners)
        start, stop = (np.floor(low), np.floor(high) + 1.0) if touched else (np.ceil(low - 0.5), np.ceil(high - 0.5))
        start, stop = (np.clip(bound, 0, size[1]).astype(np.int64) for bound in (start, stop))
        rows_of = np.maximum(stop - start, 0)
        for part in shares(rows_of, ROWS_AT_ONCE):
            breathe()
            own, order_there = corners[:, :, part], order[:, part]
            slope, base, steep = _planes(own, order_there)
            y, face = ranges(start[part], rows_of[part])
            left, right = _spans(own[:, :, face], y, touched)
            left, right = (np.clip(bound, 0, size[0]).astype(np.int64) for bound in (left, right))
            x, run = ranges(left, np.maximum(right - left, 0))
            face, y = face[run], y[run]
            near = base[face] + slope[0, face] * (x + 0.5) + slope[1, face] * (y + 0.5)
            if touched:
                greatest = np.maximum(np.maximum(order_there[0], order_there[1]), order_there[2])
                near = np.minimum(near + steep[face], greatest[face])
            parts.append((face + part.start, y * size[0] + x, near))
        return cls(*(np.concatenate(side) for side in zip(*parts)))


def _planes(corners: np.ndarray, order: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Slopes (2, f) over the picture and base (f,) of what is `order` (3, f) at the corners (2, 3, f); and by how much
    it is greater at most in a pixel than in its middle."""
    (ax, ay), (bx, by) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    a, b = (order[k] - order[0] for k in (1, 2))
    area = ax * by - ay * bx
    slope = np.stack((a * by - b * ay, b * ax - a * bx)) / np.where(area != 0.0, area, np.inf)
    return slope, order[0] - (slope * corners[:, 0]).sum(axis=0), 0.5 * np.abs(slope).sum(axis=0)


def _spans(corners: np.ndarray, y: np.ndarray, touched: bool) -> tuple[np.ndarray, np.ndarray]:
    """The first pixel, and the one after the last, of the runs of triangles (2, 3, r) in rows y (r,)."""
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    heights = [y, y + 1.0] if touched else [y + 0.5]
    for k in range(3):
        (x0, y0), (x1, y1) = corners[:, k], corners[:, (k + 1) % 3]
        low, high = np.minimum(y0, y1), np.maximum(y0, y1)
        rise = y1 - y0
        turn = (x1 - x0) / np.where(rise != 0.0, rise, np.inf)
        for height in heights:
            if touched:
                meets = (high >= heights[0]) & (low <= heights[-1])
                at = np.clip(height, low, high)
            else:
                meets, at = (low <= height) & (height < high), height
            x = x0 + (at - y0) * turn
            left = np.where(meets, np.minimum(left, x), left)
            right = np.where(meets, np.maximum(right, x), right)
            if touched:  # a level edge has its ends
                level = meets & (rise == 0.0)
                left = np.where(level, np.minimum(left, np.minimum(x0, x1)), left)
                right = np.where(level, np.maximum(right, np.maximum(x0, x1)), right)
    none = left > right
    left, right = np.where(none, 0.0, left), np.where(none, 0.0, right)
    return (np.floor(left), np.where(none, 0.0, np.floor(right) + 1.0)) if touched else \
        (np.ceil(left - 0.5), np.ceil(right - 0.5))


def least_around(front: np.ndarray) -> np.ndarray:
    """The least value of each pixel (height, width) and the eight round it; of those outside, the nearest inside."""
    front = np.pad(front, 1, mode="edge")
    rows_least = np.minimum(np.minimum(front[:-2], front[1:-1]), front[2:])
    return np.minimum(np.minimum(rows_least[:, :-2], rows_least[:, 1:-1]), rows_least[:, 2:])
