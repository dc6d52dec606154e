"""Spots of the picture that lie on lines, looked for in its pixels: no spot is compared with a line far away."""
from __future__ import annotations

import numpy as np

from ..geometry import between, groups, in_order, ranges, shares
from ..support import breathe

BESIDE = 0.05  # pixels: a spot that is no farther from a line lies on it
CELL = 0.25  # pixels: what is farther apart than two of these is not compared
MOST = 64  # of the spots in three cells: where more lie, as at the tip of a fan, not all are compared
AT_ONCE = 1 << 18
FARTHEST = 1 << 14  # pixels: longer lines reach far out of any picture


def lengths(ways: np.ndarray) -> np.ndarray:
    """Of ways (n, 2)."""
    return np.hypot(ways[:, 0], ways[:, 1])


def beside(spots: np.ndarray, start: np.ndarray, end: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Which of the spots (n, 2) lie on which of the lines from `start` to `end` (m, 2), and how far along them."""
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
    """Lines, and cells (k, 2) counted from `low` that each goes through, but for those that it only touches."""
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
    """Which pairs (k,) of one of the spots (2, n) and one of the lines, of which start, unit way and length are told,
    lie together, and how far along."""
    start_x, start_y, way_x, way_y, length = lines
    right, up = spots[0][spot] - start_x[line], spots[1][spot] - start_y[line]
    near = np.flatnonzero(np.abs(right * way_y[line] - up * way_x[line]) <= BESIDE)
    right, up, spot, line = right[near], up[near], spot[near], line[near]
    along = right * way_x[line] + up * way_y[line]
    near = np.flatnonzero((along >= 0.0) & (along <= length[line]))
    return spot[near], line[near], along[near]
