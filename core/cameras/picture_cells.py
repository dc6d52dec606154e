"""A grid over the picture with a summed-area table, to test whether any box holds a marked cell.

F. C. Crow, "Summed-area tables for texture mapping", SIGGRAPH 1984.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ranges

SIDE = 2.0  # pixels along a cell, unless the grid would have more than MOST cells
MOST = 1 << 21


@dataclass(frozen=True)
class PictureCells:
    """A grid with marked cells.

    Attributes
    ----------
    low : (2,) float64, the low corner of the grid, in pixels
    side : float, pixels along a side of a cell
    before : (height + 1, width + 1) int64, number of marked cells in lower rows and columns: a summed-area table
    """

    low: np.ndarray
    side: float
    before: np.ndarray

    @classmethod
    def empty(cls, low: np.ndarray, high: np.ndarray) -> PictureCells:
        """Return a grid from `low` to `high` (2,) pixels without marked cells."""
        side = max(SIDE, float(np.sqrt(np.prod(high - low) / MOST)), float((high - low).max()) / MOST)
        width, height = np.ceil((high - low) / side).astype(np.int64) + 1
        return cls(low, side, np.zeros((height + 1, width + 1), dtype=np.int64))

    @property
    def high(self) -> np.ndarray:
        """The high corner (2,) of the grid, in pixels."""
        return self.low + self.side * self._size[:, 0]

    @property
    def _size(self) -> np.ndarray:
        """Width and height in cells, as (2, 1)."""
        return np.subtract(self.before.shape, 1)[::-1, None]

    def _cell(self, spots: np.ndarray) -> np.ndarray:
        """Return column and row (2, n) of `spots` (2, n) in pixels, clamped to the grid."""
        with np.errstate(invalid="ignore"):
            cell = np.floor((spots - self.low[:, None]) / self.side)
        return np.clip(np.nan_to_num(cell), 0, self._size - 1).astype(np.int64)

    def with_lines(self, start: np.ndarray, end: np.ndarray) -> PictureCells:
        """Return the grid with marks only on and around lines from `start` to `end` (2, n), in pixels."""
        count = np.ceil(np.abs(end - start).max(axis=0) / (0.5 * self.side)).astype(np.int64) + 1
        step, line = ranges(np.zeros(len(count), dtype=np.int64), count)
        spots = start[:, line] + step / np.maximum(count - 1, 1)[line] * (end - start)[:, line]
        return self.with_boxes(spots - self.side, spots + self.side)

    def with_boxes(self, low: np.ndarray, high: np.ndarray) -> PictureCells:
        """Return the grid with marks only on cells that boxes from `low` to `high` (2, n), in pixels, overlap."""
        marked = box_counts(self._cell(low), self._cell(high) + 1, self._size.ravel()) > 0.5
        return PictureCells(self.low, self.side, cells_before(marked))

    def touched(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return True (n,) for boxes from `low` to `high` (2, n), in pixels, that touch a marked cell.

        Boxes are clamped to the grid.
        """
        return cells_between(self.before, self._cell(low), self._cell(high) + 1) > 0

    def holds(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return True (n,) for boxes from `low` to `high` (2, n), in pixels, that lie completely in the grid."""
        with np.errstate(invalid="ignore"):
            return ((low > self.low[:, None]) & (high < self.high[:, None])).all(axis=0)


def box_counts(first: np.ndarray, end: np.ndarray, size: np.ndarray | tuple[int, ...]) -> np.ndarray:
    """Count for each cell of a grid the boxes that hold it, as (height, width) float64.

    Parameters
    ----------
    first, end : (2, n) int64, first column and row of each box, and the column and row after its last
    size : (width, height) of the grid
    """
    width, height = np.add(size, 1)
    change = np.zeros(height * width)
    for x, y, sign in ((first, first, 1.0), (end, first, -1.0), (first, end, -1.0), (end, end, 1.0)):
        change += sign * np.bincount(y[1] * width + x[0], minlength=len(change))
    return change.reshape(height, width).cumsum(axis=0).cumsum(axis=1)[:-1, :-1]


def cells_before(marked: np.ndarray) -> np.ndarray:
    """Return the summed-area table (height + 1, width + 1) of the `marked` (height, width) bool cells."""
    before = np.zeros(np.add(marked.shape, 1), dtype=np.int64)
    np.cumsum(marked.cumsum(axis=0), axis=1, out=before[1:, 1:])
    return before


def cells_between(before: np.ndarray, first: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Count the marked cells (n,) in boxes.

    Parameters
    ----------
    before : (height + 1, width + 1) int64, summed-area table of the marked cells
    first, end : (2, n) int64, first column and row of each box, and the column and row after its last
    """
    (x0, y0), (x1, y1) = first, end
    return before[y1, x1] - before[y0, x1] - before[y1, x0] + before[y0, x0]
