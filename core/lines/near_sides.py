"""Search for picture positions that lie on line segments, with a grid, so that only neighbours are compared."""
from __future__ import annotations

import numpy as np

from ..geometry import between, groups, in_order, ranges, shares
from ..support import breathe

BESIDE = 0.05  # pixels: a spot no farther from a line lies on it
CELL = 0.25  # pixels: side of a cell; spots and lines more than two cells apart are not compared
MOST = 64  # largest number of spots compared in three cells: at the tip of a fan, there may be more
AT_ONCE = 1 << 18
FARTHEST = 1 << 14  # pixels: longer lines are ignored, because they reach far out of any picture


def lengths(ways: np.ndarray) -> np.ndarray:
    """Return the lengths (n,) of vectors (n, 2)."""
    return np.hypot(ways[:, 0], ways[:, 1])


def beside(spots: np.ndarray, start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find spots that lie on lines.

    Parameters
    ----------
    spots : (n, 2) float64, in pixels
    start, end : (m, 2) float64, ends of the lines, in pixels

    Returns
    -------
    spot, line : (k,) int64, pairs of a spot and a line that it lies on
    along : (k,) float64, distance of the spot from the line's start, in pixels
    """
    if not (len(spots) and len(start)):
        return np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0)
    low = spots.min(axis=0) - 2.0 * CELL
    own = np.floor((spots - low) / CELL).astype(np.int64)
    width = int(own[:, 0].max()) + 3
    key = own[:, 1] * width + own[:, 0]
    order = in_order(key)
    key = key[order]
    line, cell = _crossed(start, end, low)
    way = end - start
    length = np.maximum(lengths(way), 1e-300)
    lines = (*start.T.copy(), *(way.T / length), length)
    places = spots.T.copy()
    found = []
    for row in (-1, 0, 1):
        middle = (cell[:, 1] + row) * width + cell[:, 0]
        first, count = between(key, middle - 1, middle + 1)
        count = np.minimum(count, MOST)
        for part in shares(count, AT_ONCE):
            index, run = ranges(first[part], count[part])
            breathe()
            found.append(_near(places, lines, order[index], line[part][run]))
    spot, line, along = (np.concatenate(part) for part in zip(*found, strict=True))
    some, _ = groups(spot, line)
    return spot[some], line[some], along[some]


def _crossed(start: np.ndarray, end: np.ndarray, low: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return pairs of a line (k,) and a cell (k, 2) that it crosses; cells are counted from `low`.

    Samples one cell apart are used, so cells that a line crosses only at a corner may be missing.
    """
    length = lengths(end - start)
    count = np.where(length < FARTHEST, np.ceil(length / CELL) + 1.0, 0.0).astype(np.int64)
    step, line = ranges(np.zeros(len(count), dtype=np.int64), count)
    share = (step / np.maximum(count - 1, 1)[line])[:, None]
    cell = start[line] * (1.0 - share) + end[line] * share - low
    cell = np.floor(cell / CELL).astype(np.int64)
    breathe()
    new = (np.diff(line, prepend=-1) != 0) | (np.diff(cell, axis=0, prepend=-1) != 0).any(axis=1)
    return line[new], cell[new]


def _near(spots: np.ndarray, lines: tuple, spot: np.ndarray,
          line: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Select pairs of a spot and a line that lie together; return their spots, lines, and distances along the lines.

    Parameters
    ----------
    spots : (2, n) float64
    lines : tuple of (m,) float64, x and y of the start, x and y of the unit direction, length
    spot, line : (k,) int64, pairs to test
    """
    start_x, start_y, way_x, way_y, length = lines
    right, up = spots[0][spot] - start_x[line], spots[1][spot] - start_y[line]
    near = np.flatnonzero(np.abs(right * way_y[line] - up * way_x[line]) <= BESIDE)
    right, up, spot, line = right[near], up[near], spot[near], line[near]
    along = right * way_x[line] + up * way_y[line]
    near = np.flatnonzero((along >= 0.0) & (along <= length[line]))
    return spot[near], line[near], along[near]
