"""A z-buffer: the triangle seen at the centre of each pixel, and the barycentric coordinates there.

Triangles are drawn in homogeneous coordinates (M. Olano, T. Greer, "Triangle scan conversion using 2D homogeneous
coordinates", Graphics Hardware 1997): the three edge functions of a triangle are the rows of the inverse of the matrix
of its corners, and their values at a pixel are the barycentric coordinates over the depth. Triangles that pass the
eye need no clipping, and two triangles that share an edge compute it with opposite signs, digit for digit.
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..geometry import cross, dot, ranges
from ..support import breathe
from ..views.view import View

FRAGMENTS_AT_ONCE = 1_000_000


@dataclass(frozen=True)
class Drawn:
    """Visible triangle at each pixel, along the rows from below; n = width x height.

    Attributes
    ----------
    triangle : (n,) int64, -1 where there is none
    weights : (3, n) float64, barycentric coordinates, zero where there is none
    depth : (n,) float64, distance from the eye's plane, infinite where there is none
    """

    triangle: np.ndarray
    weights: np.ndarray
    depth: np.ndarray

    def interpolate(self, values: np.ndarray, triangles: np.ndarray, pixel: np.ndarray) -> np.ndarray:
        """Interpolate `values` (v, 3) at the vertices of `triangles` (t, 3) to (3, m) at pixels (m,) that show one."""
        corners = triangles[self.triangle[pixel]]
        return sum(self.weights[k, pixel] * values[corners[:, k]].T for k in range(3))


def draw(view: View, positions: np.ndarray, triangles: np.ndarray) -> Drawn:
    """Draw triangles (m, 3) over `positions` (v, 3); either side shows, and edges belong to what they bound.

    Examples
    --------
    >>> import numpy as np
    >>> from core import View, draw
    >>> view = View.looking_at((0, 0, 4), (0, 0, 0), (2, 2), orthographic_scale=2.0)
    >>> draw(view, np.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0]]), np.array([[0, 1, 2]])).triangle.tolist()
    [0, 0, 0, -1]
    """
    width, height = view.resolution
    drawn = Drawn(np.full(width * height, -1), np.zeros((3, width * height)), np.full(width * height, np.inf))
    for triangle, pixel, shares, z in fragments(view, positions, triangles):
        nearer = np.flatnonzero(z < drawn.depth[pixel])
        # farthest first: of the fragments of one pixel the nearest is written last
        nearer = nearer[np.argsort(-z[nearer], kind="stable")]
        at = pixel[nearer]
        drawn.depth[at], drawn.triangle[at] = z[nearer], triangle[nearer]
        drawn.weights[:, at] = shares[:, nearer]
    return drawn


def fragments(view: View, positions: np.ndarray, triangles: np.ndarray) -> Iterator[tuple]:
    """Yield the pixels whose centres each triangle covers, in chunks.

    Parameters
    ----------
    positions : (v, 3) float64, in world space
    triangles : (m, 3) int64

    Yields
    ------
    triangle : (k,) int64
    pixel : (k,) int64, along the rows from below
    shares : (3, k) float64, barycentric coordinates in the triangle
    depth : (k,) float64, distance from the eye's plane
    """
    width, height = view.resolution
    if not len(triangles):
        return
    clip = view.clip(positions)
    w = clip[:, 3]
    # pixels times w: divided only where a picture is certain to exist
    pixel = np.stack((0.5 * (clip[:, 0] + w) * width, 0.5 * (clip[:, 1] + w) * height, w))
    depth = view.depths(positions)
    breathe()
    edges = _edge_functions(pixel[:, triangles])
    breathe()
    low, high = _bounds(pixel, triangles, view.resolution)
    breathe()
    lines = np.maximum(high[1] - low[1] + 1, 0)
    lines[~np.isfinite(edges).all(axis=(0, 1))] = 0
    kept = np.flatnonzero(lines)
    # a part has about so many lines, and each line at most `width` fragments
    part_of = np.cumsum(lines[kept]) * 64 // FRAGMENTS_AT_ONCE
    for part in np.split(kept, np.flatnonzero(np.diff(part_of)) + 1):
        yield from _fragments(part, edges, depth[triangles].T, (low, high[0], lines), width)


def _edge_functions(corners: np.ndarray) -> np.ndarray:
    """(3, 3, m): for each corner of (3, m, 3) the coefficients of x, y and 1 of its weight over w."""
    a, b, c = np.moveaxis(corners, 2, 0)
    sides = cross(b, c), cross(c, a), cross(a, b)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.stack(sides) / dot(a, sides[0])


def _bounds(pixel: np.ndarray, triangles: np.ndarray, resolution: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """First and last column and row, (2, m) each, of each triangle; all where a corner lies beside or behind the eye.

    They also keep triangles seen edge on, whose edge functions are but rounding, where they are.
    """
    size = np.array(resolution)[:, None]
    w = pixel[2]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.where(w > 0.0, pixel[:2] / w, np.nan)[:, triangles]
    least, most = at.min(axis=2), at.max(axis=2)
    front = np.isfinite(least).all(axis=0)
    gone = (w[triangles] <= 0.0).all(axis=1)
    low = np.where(front, np.ceil(np.clip(least, 0, size) - 0.5), 0)
    high = np.where(front, np.floor(np.clip(most, -1, size) - 0.5), size - 1)
    return low.astype(np.int64), np.where(gone, -1, np.minimum(high, size - 1)).astype(np.int64)


def _fragments(part, edges, depth, extent, width) -> Iterator[tuple]:
    low, rightmost, lines = extent
    row, owner = ranges(low[1, part], lines[part])
    owner = part[owner]
    y = row + 0.5
    first, last = low[0, owner] + 0.5, rightmost[owner] + 0.5
    for x_, y_, one in edges:
        breathe()
        slope, rest = x_[owner], y_[owner] * y + one[owner]
        with np.errstate(divide="ignore", invalid="ignore"):
            crossing = -rest / slope
        first = np.where(slope > 0.0, np.maximum(first, crossing), first)
        last = np.where(slope < 0.0, np.minimum(last, crossing), last)
        last = np.where((slope == 0.0) & (rest < 0.0), -np.inf, last)
    breathe()
    # a line that is nowhere within its edges may begin at infinity
    inside = last >= first
    column = np.ceil(np.where(inside, first, 0.5) - 0.5).astype(np.int64)
    length = np.where(inside, np.floor(np.maximum(last, 0.0) - 0.5) - column + 1, 0).astype(np.int64)
    length = np.maximum(length, 0)
    # parts of whole lines that hold about as many fragments
    for chosen in np.split(np.arange(len(row)), np.flatnonzero(np.diff(np.cumsum(length) // FRAGMENTS_AT_ONCE)) + 1):
        breathe()
        x, line = ranges(column[chosen], length[chosen])
        line = chosen[line]
        triangle, pixel = owner[line], row[line] * width + x
        breathe()
        values = [one[0, triangle] * (x + 0.5) + one[1, triangle] * y[line] + one[2, triangle] for one in edges]
        breathe()
        shares = np.maximum(values, 0.0)
        with np.errstate(divide="ignore", invalid="ignore"):
            shares /= shares.sum(axis=0)
            z = sum(share * corner[triangle] for share, corner in zip(shares, depth))
        breathe()
        yield triangle, pixel, shares, z
