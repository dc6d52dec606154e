"""A grid over the picture that tells, for any box, whether something marked lies in it, by sums over its cells.

F. C. Crow, "Summed-area tables for texture mapping", SIGGRAPH 1984.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ranges

SIDE = 2.0  # pixels along a cell, where that does not make too many
MOST = 1 << 21


@dataclass(frozen=True)
class PictureCells:
    """Cells of which some are marked.

    Attributes
    ----------
    low : (2,) float64, the corner of the grid, in pixels
    side : float, pixels along a side of a cell
    before : (height + 1, width + 1) int64, how many marked cells lie before each row and column
    """

    low: np.ndarray
    side: float
    before: np.ndarray

    @classmethod
    def empty(cls, low: np.ndarray, high: np.ndarray) -> PictureCells:
        """A grid from `low` to `high` (2,) pixels."""
        side = max(SIDE, float(np.sqrt(np.prod(high - low) / MOST)), float((high - low).max()) / MOST)
        width, height = np.ceil((high - low) / side).astype(np.int64) + 1
        return cls(low, side, np.zeros((height + 1, width + 1), dtype=np.int64))

    @property
    def high(self) -> np.ndarray:
        """(2,): the opposite corner, in pixels."""
        return self.low + self.side * self._size[:, 0]

    @property
    def _size(self) -> np.ndarray:
        """(2, 1): width and height in cells."""
        return np.subtract(self.before.shape, 1)[::-1, None]

    def _cell(self, spots: np.ndarray) -> np.ndarray:
        """Column and row (2, n) of spots (2, n), those outside as at the rim."""
        with np.errstate(invalid="ignore"):
            cell = np.floor((spots - self.low[:, None]) / self.side)
        return np.clip(np.nan_to_num(cell), 0, self._size - 1).astype(np.int64)

    def with_lines(self, start: np.ndarray, end: np.ndarray) -> PictureCells:
        """The same cells, of which those are marked that lie on lines (2, n) from `start` to `end`, or beside such a
        cell."""
        count = np.ceil(np.abs(end - start).max(axis=0) / (0.5 * self.side)).astype(np.int64) + 1
        step, line = ranges(np.zeros(len(count), dtype=np.int64), count)
        spots = start[:, line] + step / np.maximum(count - 1, 1)[line] * (end - start)[:, line]
        return self.with_boxes(spots - self.side, spots + self.side)

    def with_boxes(self, low: np.ndarray, high: np.ndarray) -> PictureCells:
        """The same cells, of which those are marked that boxes from `low` to `high` (2, n) touch."""
        marked = box_counts(self._cell(low), self._cell(high) + 1, self._size.ravel()) > 0.5
        return PictureCells(self.low, self.side, cells_before(marked))

    def touched(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Whether boxes from `low` to `high` (2, n) touch a marked cell, those outside of the grid one at its rim."""
        return cells_between(self.before, self._cell(low), self._cell(high) + 1) > 0

    def holds(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Whether boxes from `low` to `high` (2, n) lie in the grid whole."""
        with np.errstate(invalid="ignore"):
            return ((low > self.low[:, None]) & (high < self.high[:, None])).all(axis=0)


def box_counts(first: np.ndarray, end: np.ndarray, size: np.ndarray | tuple[int, ...]) -> np.ndarray:
    """How many of the boxes from columns and rows `first` to before their `end` (2, n) hold each cell of a grid of
    `size` (width, height), as (height, width) float64."""
    width, height = np.add(size, 1)
    change = np.zeros(height * width)
    for x, y, sign in ((first, first, 1.0), (end, first, -1.0), (first, end, -1.0), (end, end, 1.0)):
        change += sign * np.bincount(y[1] * width + x[0], minlength=len(change))
    return change.reshape(height, width).cumsum(axis=0).cumsum(axis=1)[:-1, :-1]


def cells_before(marked: np.ndarray) -> np.ndarray:
    """How many of the `marked` (height, width) cells lie before each row and column, (height + 1, width + 1)."""
    before = np.zeros(np.add(marked.shape, 1), dtype=np.int64)
    np.cumsum(marked.cumsum(axis=0), axis=1, out=before[1:, 1:])
    return before


def cells_between(before: np.ndarray, first: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How many marked cells, of which so many lie `before` each row and column, boxes (n,) hold that go from columns
    and rows `first` to before their `end` (2, n)."""
    (x0, y0), (x1, y1) = first, end
    return before[y1, x1] - before[y0, x1] - before[y1, x0] + before[y0, x0]
