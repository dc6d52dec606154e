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
    """Pairs of cameras and triangles of a mesh, parts of the mirror's triangles that `owner` (m,) names, -1 for none,
    and no camera's own, whose boxes in the picture overlap in some of the cells `taken` (height, width), `scale` of
    them a pixel, or beside one; each once, in shares. What is not before the eye has no box.

    Cells are made as coarse as gives the least work: large triangles share many small cells. None where
    there would be more than `MOST_PAIRS`.
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
    """Pairs whose boxes, of cameras and of triangles, overlap, found by the cells that they share."""
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
    """Boxes `low` and `high` (n, 2) of triangles (3, n, 3) in cells of the grid; those that are not before the eye
    have none: theirs end before they begin."""
    flat = corners.reshape(3, -1).T
    before = np.all((view.depths(flat) > 0.0).reshape(-1, 3), axis=1)
    pixels = np.nan_to_num(view.pixels(flat)).reshape(-1, 3, 2) * scale
    return (np.where(before[:, None], pixels.min(axis=1), 0.0),
            np.where(before[:, None], pixels.max(axis=1), -1.0))


def _halved(taken: np.ndarray) -> np.ndarray:
    """Cells of twice the size, which hold any of those `taken`."""
    taken = np.pad(taken, ((0, taken.shape[0] % 2), (0, taken.shape[1] % 2)))
    return taken[::2, ::2] | taken[1::2, ::2] | taken[::2, 1::2] | taken[1::2, 1::2]


def _extents(boxes: tuple[np.ndarray, np.ndarray], level: int, taken: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """First cell of each box and the cell behind its last, (2, n) each, column and row."""
    size = taken.shape[::-1]
    first = np.clip(np.floor(boxes[0] / 2.0**level), 0, size).astype(np.int64)
    behind = np.clip(np.floor(boxes[1] / 2.0**level) + 1, 0, size).astype(np.int64)
    return first.T, np.maximum(behind, first).T


def _cells(boxes: tuple[np.ndarray, np.ndarray], level: int, taken: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The cells among those `taken` that each box touches, and which box."""
    first, behind = _extents(boxes, level, taken)
    y, row = ranges(first[1], behind[1] - first[1])
    x, run = ranges(first[0, row], (behind - first)[0, row])
    cell, box = y[run] * taken.shape[1] + x, row[run]
    kept = taken.ravel()[cell]
    return cell[kept], box[kept]
