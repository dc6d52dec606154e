"""Rasterisation of triangles: the pixels that each covers, or touches, as runs in the picture's rows."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import columns, largest, ranges, shares

ROWS_AT_ONCE = 1 << 14
LEVEL = 1e-30  # pixels: a side that rises less is level


def box(spots: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bounding boxes of triangles: minimum and maximum (2, f) of their corners (2, 3, f).

    Much faster than NumPy's minimum along an axis of three.
    """
    return (np.minimum(np.minimum(spots[:, 0], spots[:, 1]), spots[:, 2]),
            np.maximum(np.maximum(spots[:, 0], spots[:, 1]), spots[:, 2]))


@dataclass(frozen=True)
class Covered:
    """Pairs (k) of a face and a pixel that it covers.

    Attributes
    ----------
    face, pixel : (k,) int64
    order : (k,) float64, depth order of the face at the pixel
    """

    face: np.ndarray
    pixel: np.ndarray
    order: np.ndarray

    @classmethod
    def of(cls, corners: np.ndarray, order: np.ndarray, size: tuple[int, int], touched: bool) -> Covered:
        """Rasterise triangles with `corners` (2, 3, f), in pixels, and depth `order` (3, f) at the corners.

        Parameters
        ----------
        size : (int, int), width and height of the picture
        touched : bool
            If True, find all pixels that a triangle touches, with its greatest order in each; else the pixels whose
            centres it covers.
        """
        none = np.zeros(0, dtype=np.int64)
        parts = [(none, none, np.zeros(0))]
        (_, low), (_, high) = box(corners)
        start, stop = (np.floor(low), np.floor(high) + 1.0) if touched else (np.ceil(low - 0.5), np.ceil(high - 0.5))
        start, stop = (np.clip(bound, 0, size[1]).astype(np.int64) for bound in (start, stop))
        rows_of = np.maximum(stop - start, 0)
        for part in shares(rows_of, ROWS_AT_ONCE):
            own, order_there = corners[:, :, part], order[:, part]
            slope, base = planes(own, order_there)
            steep = 0.5 * np.abs(slope).sum(axis=0)
            y, face = ranges(start[part], rows_of[part])
            left, right = _spans(own, face, y, touched)
            left, right = (np.clip(bound, 0, size[0]).astype(np.int64) for bound in (left, right))
            x, run = ranges(left, np.maximum(right - left, 0))
            near = columns(columns(slope[0], face), run)
            near *= x + 0.5
            in_row = columns(slope[1], face) * (y + 0.5) + columns(base, face)
            near += columns(in_row + columns(steep, face) if touched else in_row, run)
            if touched:
                np.minimum(near, columns(columns(largest(order_there), face), run), out=near)
            x += columns(y * size[0], run)
            parts.append((columns(face + part.start, run), x, near))
        return cls(*(np.concatenate(side) for side in zip(*parts)))


def planes(corners: np.ndarray, order: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Fit planes to values `order` (3, f) at the corners (2, 3, f) of triangles in the picture.

    Returns
    -------
    slope : (2, f) float64, change by pixel in x and y; zero for triangles without an area
    base : (f,) float64, value at the picture's origin
    """
    (ax, ay), (bx, by) = (corners[:, k] - corners[:, 0] for k in (1, 2))
    a, b = (order[k] - order[0] for k in (1, 2))
    area = ax * by - ay * bx
    slope = np.stack((a * by - b * ay, b * ax - a * bx)) / np.where(area != 0.0, area, np.inf)
    return slope, order[0] - (slope * corners[:, 0]).sum(axis=0)


def _spans(corners: np.ndarray, face: np.ndarray, y: np.ndarray, touched: bool) -> tuple[np.ndarray, np.ndarray]:
    """Find the run of pixels that each triangle `face` (r,) covers, or touches, in a row `y` (r,).

    The run lies between the side from the lowest corner to the highest and the two other sides. `corners` (2, 3, f) are
    those of all triangles. Returns the first pixel (r,) of each run, and the pixel (r,) after the last.
    """
    x0, x1, x2, y0, y1, y2, *slopes = columns(_risen(corners), face)

    def beside(height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        from_middle = height - y1
        return slopes[0] * (height - y0) + x0, np.where(from_middle < 0.0, *slopes[1:]) * from_middle + x1

    if not touched:
        one, other = beside(y + 0.5)
        return np.ceil(np.minimum(one, other) - 0.5), np.ceil(np.maximum(one, other) - 0.5)
    low, high = np.maximum(y, y0), np.minimum(y + 1.0, y2)
    spots = [*beside(low), *beside(high), np.where((low <= y1) & (y1 <= high), x1, x0 + slopes[0] * (low - y0))]
    # add the upper end of the longest side: a triangle without a height has only its two ends
    spots.append(np.where(high >= y2, x2, spots[0]))
    left, right = spots[0], spots[0]
    for spot in spots[1:]:
        left, right = np.minimum(left, spot), np.maximum(right, spot)
    return np.floor(left), np.floor(right) + 1.0


def _risen(corners: np.ndarray) -> np.ndarray:
    """Sort the corners (2, 3, f) of triangles by y, and compute the slopes of the sides.

    Returns
    -------
    (9, f) float64: x of the three corners, the lowest first; y of the corners; change of x with y along the sides from
    the lowest to the highest corner, from the lowest to the middle one, and from the middle one to the highest
    """
    x, y = list(corners[0]), list(corners[1])
    for one, other in ((0, 1), (1, 2), (0, 1)):
        turned = y[one] > y[other]
        x[one], x[other] = np.where(turned, x[other], x[one]), np.where(turned, x[one], x[other])
        y[one], y[other] = np.minimum(y[one], y[other]), np.maximum(y[one], y[other])
    slopes = []
    for start, end in ((0, 2), (0, 1), (1, 2)):
        rise = y[end] - y[start]
        slopes.append((x[end] - x[start]) / np.where(rise > LEVEL, rise, np.inf))
    return np.stack((*x, *y, *slopes))
