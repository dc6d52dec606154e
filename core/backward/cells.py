"""Cells of a lattice: squares of adaptive size, which at most one straight outline crosses."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LARGEST = 4     # base-2 logarithm of the largest cell's side: sixteen lattice steps
LARGEST_CUT = 3     # the same for cells that an outline crosses
AROUND = ((0, 0), (0, 1), (1, 1), (1, 0))   # row and column offsets of a cell's corners, counterclockwise


@dataclass(frozen=True)
class Labels:
    """Keys, vertices and outlines at the points of a lattice.

    Attributes
    ----------
    key : (rows, columns) int64, equal for points that see the same source triangle after as many bounces, -1 for none
    node : (rows, columns) int64, the vertex at each point, -1 for none
    right, up : (2, rows, columns) int64
        Vertices where an outline crosses the side to the next point to the right, and up: one vertex for the key of
        this point, one for the key of the next point; -1 for none.
    right_share, up_share : (rows, columns) float64
        Place of the outline along these sides, from 0 to 1; infinite for none.
    rough : (rows, columns) float64
        Error of two faces over a cell of two steps, as a share of the tolerance.
    """

    key: np.ndarray
    node: np.ndarray
    right: np.ndarray
    up: np.ndarray
    right_share: np.ndarray
    up_share: np.ndarray
    rough: np.ndarray


@dataclass(frozen=True)
class Cells:
    """Cells of one size.

    Attributes
    ----------
    side : int, in steps of the lattice
    rows, columns : (n,) int64, of their first corners
    """

    side: int
    rows: np.ndarray
    columns: np.ndarray

    def __len__(self) -> int:
        return len(self.rows)

    def points(self) -> tuple[np.ndarray, np.ndarray]:
        """Return rows and columns (n, 4 side) of the lattice's points around each cell, counterclockwise."""
        along, none, side = np.arange(self.side), np.zeros(self.side, dtype=np.int64), self.side
        return (self.rows[:, None] + np.concatenate((none, along, none + side, side - along)),
                self.columns[:, None] + np.concatenate((along, none + side, side - along, none)))

    def sides(self, right: np.ndarray, up: np.ndarray) -> np.ndarray:
        """Gather values (2, n, 4 side) on the lattice sides around each cell, from each of the `points` to the next.

        `right` and `up` (2, rows, columns) hold two values for each lattice side, at its start and at its end. The
        result holds first the value at the end that comes first counterclockwise.
        """
        rows, columns = self.points()
        side = self.side
        values = np.empty((2, len(self), 4 * side), dtype=right.dtype)
        for k, (where, ahead, back) in enumerate(((right, 0, 0), (up, 0, 0), (right, 1, 1), (up, 1, 1))):
            part = slice(k * side, (k + 1) * side)
            # in the directions left and down, a side is stored at the point where it ends
            row, column = rows[:, part] - (back if k == 3 else 0), columns[:, part] - (back if k == 2 else 0)
            values[0, :, part], values[1, :, part] = where[ahead, row, column], where[1 - ahead, row, column]
        return values


def cells_of(labels: Labels, step: float, straight: float) -> list[Cells]:
    """Divide the lattice into cells, the largest first; cells without a key at any corner are left out.

    Parameters
    ----------
    step : float
        Distance of lattice points, in pixels.
    straight : float
        Largest distance of an outline from a straight line through a cell, in pixels.
    """
    key = labels.key
    crossed = np.isfinite(labels.right_share), np.isfinite(labels.up_share)
    taken = np.ones((key.shape[0] - 1, key.shape[1] - 1), dtype=bool)
    for row, column in AROUND:
        taken &= key[row:key.shape[0] - 1 + row, column:key.shape[1] - 1 + column] < 0
    found = []
    for power in reversed(range(LARGEST + 1)):
        side = 1 << power
        rows, columns = (count // side for count in taken.shape)
        free = ~taken[:rows * side, :columns * side].reshape(rows, side, columns, side).any(axis=(1, 3))
        if power:
            free &= _block_max(labels.rough, rows, columns, side) * (0.25 * side**2) <= 1.0
        cells = Cells(side, *(side * at for at in np.nonzero(free)))
        if power:
            cells = _undivided(cells, labels, crossed, power <= LARGEST_CUT, straight / step)
        for row in range(side):
            for column in range(side):
                taken[cells.rows + row, cells.columns + column] = True
        found.append(cells)
    return found


def _block_max(values: np.ndarray, rows: int, columns: int, side: int) -> np.ndarray:
    """Return the largest value (rows, columns) at the points of each block of `side` steps, including its border."""
    found = values[:rows * side, :columns * side].reshape(rows, side, columns, side).max(axis=(1, 3))
    right = values[:rows * side, side:columns * side + 1:side].reshape(rows, side, columns).max(axis=1)
    top = values[side:rows * side + 1:side, :columns * side].reshape(rows, columns, side).max(axis=2)
    return np.maximum(found, np.maximum(right, top))


def _undivided(cells: Cells, labels: Labels, crossed: tuple[np.ndarray, np.ndarray], cut: bool,
               straight: float) -> Cells:
    """Return the cells that no outline crosses, and, if `cut`, the cells that one straight outline crosses.

    `crossed` says which lattice sides to the right, and up, an outline crosses, (rows, columns) bool each. `straight`
    is the largest distance of the outline from a straight line, in lattice steps.
    """
    side, around = cells.side, np.zeros(len(cells), dtype=np.int64)
    every, offsets = np.zeros(len(cells), dtype=np.int64), []
    for which, where in enumerate(crossed):
        for along in range(side):
            for across in range(side + 1):
                row, column = (across, along) if which == 0 else (along, across)
                count = where[cells.rows + row, cells.columns + column]
                every += count
                if across in (0, side):
                    around += count
                else:
                    offsets.append((which, row, column))
    whole = every == 0
    if not cut:
        return Cells(side, cells.rows[whole], cells.columns[whole])
    some = np.flatnonzero((around == 2) & (every > 0))
    part = Cells(side, cells.rows[some], cells.columns[some])
    spots, own = _ring_spots(part, labels), np.arange(len(part))
    at = np.sort(np.where(np.isfinite(spots).all(axis=2), np.arange(4 * side), 4 * side), axis=1)
    first, last = spots[own, at[:, 0]], spots[own, at[:, 1]]
    way = last - first
    length = np.linalg.norm(way, axis=1)
    good = length > 0.0
    for which, row, column in offsets:
        share = (labels.right_share, labels.up_share)[which][part.rows + row, part.columns + column]
        known = np.isfinite(share)
        share = np.where(known, share, 0.0)
        spot = np.stack((column + share * (which == 0), row + share * (which == 1)), axis=1)
        away = way[:, 0] * (spot - first)[:, 1] - way[:, 1] * (spot - first)[:, 0]
        good &= ~known | (np.abs(away) <= straight * length)
    chosen = np.sort(np.concatenate((np.flatnonzero(whole), some[good])))
    return Cells(side, cells.rows[chosen], cells.columns[chosen])


def _ring_spots(cells: Cells, labels: Labels) -> np.ndarray:
    """Return the crossings (n, 4 side, 2) of outlines with the lattice sides around cells, infinite for none.

    Coordinates are columns and rows, relative to the first corner of each cell.
    """
    share = cells.sides(np.stack((labels.right_share,) * 2), np.stack((labels.up_share,) * 2))[0]
    rows, columns = cells.points()
    row, column = (rows - cells.rows[:, None]).astype(float), (columns - cells.columns[:, None]).astype(float)
    side = cells.side
    column[:, :side] += share[:, :side]
    row[:, side:2 * side] += share[:, side:2 * side]
    column[:, 2 * side:3 * side] += share[:, 2 * side:3 * side] - 1.0
    row[:, 3 * side:] += share[:, 3 * side:] - 1.0
    return np.stack((column, row), axis=2)
