"""Pairs of cameras and triangles that may lie over one another in the picture, by boxes on a grid."""
from __future__ import annotations

from collections.abc import Generator, Iterable

import numpy as np

from ..cameras import Cameras, box_counts
from ..geometry import TriangleMesh, between, in_order, ranges, rows, shares
from ..support import breathe
from ..views import View

COARSER = 9  # times that the cells may be doubled
MOST_PAIRS = 1 << 26
PAIRS_AT_ONCE = 1 << 17


def pairs_in_picture(cameras: Cameras, mesh: TriangleMesh, owner: np.ndarray, taken: np.ndarray,
                     scale: float) -> Iterable[tuple[np.ndarray, np.ndarray]] | None:
    """Find pairs of cameras and triangles whose bounding boxes overlap in the picture, in portions, each pair once.

    Boxes are compared by cells of a grid, as coarse as gives the least work. Cameras and triangles that are not before
    the eye have no box.

    Parameters
    ----------
    mesh : TriangleMesh, with m triangles
    owner : (m,) int64
        Mirror triangle that each is a part of, -1 for none; a camera is not paired with parts of its own triangle.
    taken : (height, width) bool
        Cells to search; boxes must overlap in one of them or beside it.
    scale : float, cells per pixel

    Returns
    -------
    Iterable of cameras (p,) and triangles (p,), or None if there would be more than `MOST_PAIRS`
    """
    view = cameras.view
    height, width = taken.shape
    around = np.pad(taken, 1)
    around = np.logical_or.reduce([around[y:y + height, x:x + width] for y in range(3) for x in range(3)])
    if not around.any():
        return ()
    boxes, others = (_boxes(view, corners, scale) for corners in
                     (cameras.places[:, cameras.corners], rows(mesh.positions[mesh.triangles])))
    levels = [around]
    for _ in range(COARSER):
        levels.append(_halved(levels[-1]))
    work = []
    for level, taken in enumerate(levels):
        breathe()
        one, other = (box_counts(*_extents(part, level, taken), taken.shape[::-1]) for part in (boxes, others))
        work.append((one * other * taken).sum())
    level = int(np.argmin(work))
    if work[level] > MOST_PAIRS:
        return None
    cells = [_cells(part, level, levels[level]) for part in (boxes, others)]
    return _meeting(cameras, owner, (boxes, others), cells)


def _meeting(cameras: Cameras, owner: np.ndarray, boxes: tuple,
             cells: list) -> Generator[tuple[np.ndarray, np.ndarray], None, None]:
    """Yield pairs of n cameras and m triangles whose boxes overlap, in portions of two index arrays (p,) and (p,).

    Only boxes that share a cell are compared. A pair that shares several cells is yielded once.

    Parameters
    ----------
    owner : (m,) int64
        Mirror triangle that each triangle is a part of, -1 for none. A camera on this mirror triangle, as in
        `cameras.face`, is not paired with it.
    boxes : tuple of two results of `_boxes`
        Lowest and highest corners of the boxes of the cameras, (n, 2) each, and of the triangles, (m, 2) each.
    cells : list of two results of `_cells`
        Numbers of cells, and the cameras whose boxes touch them, (j,) each; the same for the triangles, (k,) each.
    """
    (cell, camera), (other_cell, column) = cells
    boxes, others = boxes
    order = in_order(camera)  # all that is said of one camera comes together
    cell, camera = cell[order], camera[order]
    order = in_order(other_cell)
    other_cell, column = other_cell[order], column[order]
    start, count = between(other_cell, cell, cell)
    ends = np.append(0, np.flatnonzero(np.diff(camera, append=-1)) + 1)
    before = np.append(0, np.cumsum(count))[ends]
    for part in shares(np.diff(before), PAIRS_AT_ONCE):
        own = slice(ends[part.start], ends[part.stop])
        entry, run = ranges(start[own], count[own])
        near, far = camera[own][run], column[entry]
        meet = ((boxes[0][near] < others[1][far]) & (others[0][far] < boxes[1][near])).all(axis=1)
        meet &= cameras.face[near] != owner[far]
        pairs = np.unique(near[meet] * len(owner) + far[meet])
        if len(pairs):
            yield pairs // len(owner), pairs % len(owner)


def _boxes(view: View, corners: np.ndarray, scale: float) -> tuple[np.ndarray, np.ndarray]:
    """Compute bounding boxes of triangles with `corners` (3, n, 3), from `low` to `high` (n, 2), in cells of the grid.

    Triangles that are not before the eye get an empty box, with `low` above `high`.
    """
    flat = corners.reshape(3, -1).T
    before = np.all((view.depths(flat) > 0.0).reshape(-1, 3), axis=1)
    pixels = np.nan_to_num(view.pixels(flat)).reshape(-1, 3, 2) * scale
    return (np.where(before[:, None], pixels.min(axis=1), 0.0),
            np.where(before[:, None], pixels.max(axis=1), -1.0))


def _halved(taken: np.ndarray) -> np.ndarray:
    """Halve the resolution of the cells `taken`: a coarse cell is taken if any of its four cells is."""
    taken = np.pad(taken, ((0, taken.shape[0] % 2), (0, taken.shape[1] % 2)))
    return taken[::2, ::2] | taken[1::2, ::2] | taken[::2, 1::2] | taken[1::2, 1::2]


def _extents(boxes: tuple[np.ndarray, np.ndarray], level: int, taken: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the first cell of each box and the cell after its last, (2, n) each, as column and row."""
    size = taken.shape[::-1]
    first = np.clip(np.floor(boxes[0] / 2.0**level), 0, size).astype(np.int64)
    behind = np.clip(np.floor(boxes[1] / 2.0**level) + 1, 0, size).astype(np.int64)
    return first.T, np.maximum(behind, first).T


def _cells(boxes: tuple[np.ndarray, np.ndarray], level: int, taken: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs (p,) of a cell, of those `taken`, and a box that touches it."""
    first, behind = _extents(boxes, level, taken)
    y, row = ranges(first[1], behind[1] - first[1])
    x, run = ranges(first[0, row], (behind - first)[0, row])
    cell, box = y[run] * taken.shape[1] + x, row[run]
    kept = taken.ravel()[cell]
    return cell[kept], box[kept]
