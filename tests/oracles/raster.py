"""A z-buffer in NumPy: which triangle of a mesh a pixel's centre shows, in float64."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core import TriangleMesh, View
from tests.oracles.ray_hits import plane_hits

FRAGMENTS_AT_ONCE = 4_000_000


@dataclass(frozen=True)
class Raster:
    """What each pixel shows; pixels run along the rows from the lower left corner, n = width x height.

    Attributes
    ----------
    triangle : (n,) int64
        The nearest triangle over the pixel's centre, -1 where there is none.
    weights : (n, 3) float64
        Barycentric coordinates on it (perspective-correct), zero where there is none.
    depth : (n,) float64
        Distance from the eye's plane, infinite where there is none.
    """

    triangle: np.ndarray
    weights: np.ndarray
    depth: np.ndarray

    def interpolate(self, values: np.ndarray, triangles: np.ndarray) -> np.ndarray:
        """Values (n, k) in the pixels of per-vertex `values` (v, k); zero where no triangle is."""
        corners = values[triangles[np.maximum(self.triangle, 0)]] if len(triangles) else np.zeros((1, 3, 3))
        return np.einsum("nk,nkx->nx", self.weights, corners)


def rasterise(view: View, positions: np.ndarray, triangles: np.ndarray) -> Raster:
    """Draw triangles (m, 3) over `positions` (v, 3) into the picture of `view`; either side shows.

    A pixel is drawn where its centre lies in the closed triangle. Edges are computed from their two end points in one
    order, so that triangles that share both leave no crack between them. Parts behind a perspective eye are cut off.
    """
    width, height = view.resolution
    depth, winner = np.full(width * height, np.inf), np.full(width * height, -1)
    if len(triangles):
        depths = view.depths(positions)
        corners, parent = _before_the_eye(view, positions, triangles, depths)
        screen = view.pixels(corners.reshape(-1, 3)).reshape(-1, 3, 2)
        planes = _Planes(_depth_planes(view, positions[triangles]), depths[triangles].min(axis=1),
                         depths[triangles].max(axis=1))
        low = np.clip(np.ceil(screen.min(axis=1) - 0.5), 0, view.resolution)
        high = np.clip(np.floor(screen.max(axis=1) - 0.5), -1, np.array(view.resolution) - 1)
        area = np.prod(np.maximum(high - low + 1, 0), axis=1)
        kept = np.flatnonzero(area > 0)
        batch = np.cumsum(area[kept]) // FRAGMENTS_AT_ONCE
        for part in np.split(kept, np.flatnonzero(np.diff(batch)) + 1):
            _draw(_Picture(view, depth, winner), planes, screen[part], parent[part], low[part, 1], high[part, 1])
    weights = np.zeros((width * height, 3))
    shown = np.flatnonzero(winner >= 0)
    origins, directions = view.rays(np.stack([shown % width, shown // width], axis=1) + 0.5)
    _, found = plane_hits(TriangleMesh(positions, triangles), winner[shown], origins, directions)
    # An edge-on triangle has no plane to hit: its middle stands for it.
    found = np.clip(np.where(np.isfinite(found), found, 1.0 / 3.0), 0.0, 1.0)
    weights[shown] = found / found.sum(axis=1, keepdims=True)
    return Raster(winner, weights, depth)


@dataclass(frozen=True)
class _Picture:
    """What is drawn so far: depth and triangle (n,) of each pixel."""

    view: View
    depth: np.ndarray
    winner: np.ndarray


@dataclass(frozen=True)
class _Planes:
    """Depths of triangles (m,) over the picture: the coefficients of 1, x and y, and those of the corners at the least
    and at the most."""

    slope: np.ndarray
    near: np.ndarray
    far: np.ndarray

    def at(self, view: View, triangle: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Depth (k,) of triangles at places in pixels."""
        a, b, c = self.slope[triangle].T
        with np.errstate(divide="ignore", invalid="ignore"):
            z = a + b * x + c * y
            z = z if view.orthographic else 1.0 / z
        # Rounding in a sliver's plane must not carry a depth beyond the depths of its corners.
        return np.clip(np.where(np.isfinite(z), z, self.far[triangle]), self.near[triangle], self.far[triangle])


def _draw(picture: _Picture, planes: _Planes, screen, parent, bottom, top):
    width = picture.view.resolution[0]
    span_triangle, row = _runs(bottom, top)
    y = row + 0.5
    left, right = np.full(len(y), np.inf), np.full(len(y), -np.inf)
    for first, second in ((0, 1), (1, 2), (2, 0)):
        p, q = screen[:, first], screen[:, second]
        swap = ((p[:, 1] > q[:, 1]) | ((p[:, 1] == q[:, 1]) & (p[:, 0] > q[:, 0])))[:, None]
        p, q = np.where(swap, q, p), np.where(swap, p, q)
        with np.errstate(divide="ignore", invalid="ignore"):
            gradient = ((q[:, 0] - p[:, 0]) / (q[:, 1] - p[:, 1]))[span_triangle]
        p, q = p[span_triangle], q[span_triangle]
        crosses = (p[:, 1] <= y) & (y <= q[:, 1]) & (p[:, 1] < q[:, 1])
        with np.errstate(invalid="ignore"):
            x = np.where(y == q[:, 1], q[:, 0], p[:, 0] + (y - p[:, 1]) * gradient)
        left = np.where(crosses, np.minimum(left, x), left)
        right = np.where(crosses, np.maximum(right, x), right)
    first_column = np.clip(np.ceil(left - 0.5), 0, width)
    last_column = np.clip(np.floor(right - 0.5), -1, width - 1)
    span, column = _runs(first_column, last_column)
    pixel = row[span] * width + column
    triangle = parent[span_triangle[span]]
    z = planes.at(picture.view, triangle, column + 0.5, y[span])
    np.minimum.at(picture.depth, pixel, z)
    wins = z == picture.depth[pixel]
    picture.winner[pixel[wins]] = triangle[wins]


def _runs(first: np.ndarray, last: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Owner and value of every integer of the closed runs `first`..`last`."""
    count = np.maximum(last - first + 1, 0).astype(np.int64)
    owner = np.repeat(np.arange(len(count)), count)
    offset = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
    return owner, first[owner].astype(np.int64) + offset


def _depth_planes(view: View, corners: np.ndarray) -> np.ndarray:
    """Coefficients (m, 3) of 1, x and y, in pixels, of each triangle's depth, or of 1 / depth in a perspective."""
    origins, directions = view.rays(np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]))
    directions = directions / (directions @ view.forward)[:, None]
    start = corners[:, 0, None, :] - origins
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    toward, away = np.einsum("mx,kx->mk", normal, directions), np.einsum("mx,mkx->mk", normal, start)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = away / toward if view.orthographic else toward / away
        return np.stack([at[:, 0], at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]], axis=1)


def _before_the_eye(view, positions, triangles, depths):
    """Corners (k, 3, 3) of what lies before a perspective eye, and the triangle each piece is of."""
    corners, parent = positions[triangles], np.arange(len(triangles))
    if view.orthographic:
        return corners, parent
    z = depths[triangles] - 1e-6 * max(depths.max(), 0.0)
    behind = (z <= 0.0).sum(axis=1)
    pieces, parents = [corners[behind == 0]], [parent[behind == 0]]
    for count in (1, 2):
        cut = np.flatnonzero(behind == count)
        # The corner that stands alone on its side of the plane comes first.
        alone = (z[cut] <= 0.0 if count == 1 else z[cut] > 0.0).argmax(axis=1)
        turn = (alone[:, None] + np.arange(3)) % 3
        p, d = np.take_along_axis(corners[cut], turn[:, :, None], axis=1), np.take_along_axis(z[cut], turn, axis=1)
        ab = p[:, 0] + (d[:, 0] / (d[:, 0] - d[:, 1]))[:, None] * (p[:, 1] - p[:, 0])
        ac = p[:, 0] + (d[:, 0] / (d[:, 0] - d[:, 2]))[:, None] * (p[:, 2] - p[:, 0])
        new = [(ab, p[:, 1], p[:, 2]), (ab, p[:, 2], ac)] if count == 1 else [(p[:, 0], ab, ac)]
        pieces += [np.stack(piece, axis=1) for piece in new]
        parents += [cut] * len(new)
    return np.concatenate(pieces), np.concatenate(parents)
