"""Pieces of triangles that hold points of these: by a grid for each triangle, for all of them at once."""
from __future__ import annotations

import numpy as np

from ..geometry import between, distinct, in_order, ranges
from ..support import breathe

TOUCHING = 1e-9     # tolerance of barycentric coordinates for points on an edge
FLAT = 1e-15        # share of a triangle's area: smaller pieces are degenerate and contain no point


def holders(owner: np.ndarray, corners: np.ndarray, face: np.ndarray, points: np.ndarray
            ) -> tuple[np.ndarray, np.ndarray]:
    """Find pairs of points and pieces that contain them, as indices (p,) of points and (p,) of pieces.

    Parameters
    ----------
    owner : (k,) int64, triangle that each piece lies in
    corners : (k, 3, 3) float64, barycentric coordinates of the piece's corners there
    face : (n,) int64, triangle that each point lies in
    points : (n, 3) float64, its barycentric coordinates there
    """
    point, piece = _near(owner, corners[:, :, 1:], face, points[:, 1:])
    breathe()
    area = np.linalg.det(corners)
    breathe()
    area[np.abs(area) < FLAT] = np.nan
    held = _held(corners[:, :, 1:], area, piece, points[point, 1:].T)
    return point[held], piece[held]


def _held(corners: np.ndarray, area: np.ndarray, piece: np.ndarray, spot: np.ndarray) -> np.ndarray:
    """Return True for each `spot` (2, n) that lies in its `piece` (n,).

    The pieces have `corners` (k, 3, 2) and doubled areas `area` (k,).
    """
    (x0, y0), (x1, y1), (x2, y2) = (corners[:, corner].T for corner in range(3))
    breathe()
    x, y = spot[0] - x0[piece], spot[1] - y0[piece]
    breathe()
    second = (x * ((y2 - y0) / area)[piece] - y * ((x2 - x0) / area)[piece])
    breathe()
    third = (y * ((x1 - x0) / area)[piece] - x * ((y1 - y0) / area)[piece])
    return (second >= -TOUCHING) & (third >= -TOUCHING) & (second + third <= 1.0 + TOUCHING)


def _near(owner: np.ndarray, corners: np.ndarray, face: np.ndarray, points: np.ndarray) -> tuple:
    """Find pairs of points and pieces of the same triangle whose bounding box contains the point.

    Each triangle has a grid of about as many cells as it has pieces. Its rows and columns hold equal numbers of
    corners, since pieces are dense where the mirror magnifies.

    Parameters
    ----------
    owner, face : (k,) and (n,) int64, triangle of each piece, and of each point
    corners : (k, 3, 2) float64, of the pieces
    points : (n, 2) float64
    """
    _, both = distinct(np.concatenate((owner, face)))
    owner, face = both[:len(owner)], both[len(owner):]
    number = np.bincount(owner, minlength=int(both.max()) + 1)
    across = np.ceil(np.sqrt(number)).astype(np.int64)
    start = np.cumsum(across**2) - across**2

    def keys(of: np.ndarray, place: np.ndarray) -> np.ndarray:
        return 2.0 * of[:, None] + np.clip(place, 0.0, 1.0)
    lines = np.sort(keys(np.repeat(owner, 3), corners.reshape(-1, 2)), axis=0)
    before = 3 * (np.cumsum(number) - number)

    def cell(of: np.ndarray, place: np.ndarray) -> np.ndarray:
        rank = np.stack([np.searchsorted(lines[:, k], key) for k, key in enumerate(keys(of, place).T)], axis=1)
        return np.clip((rank - before[of, None]) * across[of, None] // np.maximum(3 * number[of, None], 1), 0,
                       np.maximum(across[of, None] - 1, 0))
    breathe()
    low = cell(owner, corners.min(axis=1))
    breathe()
    high = cell(owner, corners.max(axis=1))
    breathe()
    size = high - low + 1
    step, piece = ranges(np.zeros(len(owner), dtype=np.int64), size.prod(axis=1))
    breathe()
    column, row = low[piece, 0] + step % size[piece, 0], low[piece, 1] + step // size[piece, 0]
    held_by = start[owner[piece]] + row * across[owner[piece]] + column
    breathe()
    order = in_order(held_by)
    breathe()
    asked = np.flatnonzero(number[face] > 0)
    column, row = cell(face[asked], points[asked]).T
    breathe()
    wanted = start[face[asked]] + row * across[face[asked]] + column
    rising = held_by[order]
    breathe()
    first, count = between(rising, wanted, wanted)
    breathe()
    entry, point = ranges(first, count)
    breathe()
    point, piece = asked[point], piece[order[entry]]
    lowest, highest = corners.min(axis=1) - TOUCHING, corners.max(axis=1) + TOUCHING
    for axis in (0, 1):
        breathe()
        at = points[point, axis]
        close = (at >= lowest[piece, axis]) & (at <= highest[piece, axis])
        point, piece = point[close], piece[close]
    return point, piece
