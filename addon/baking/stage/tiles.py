"""Tiles of a picture that overlap and are faded into each other: Cycles denoises what it bakes in one, a large picture
for seconds."""
from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from ..texels import UNTOUCHED

LONGEST = 320  # texels along a side, which take Cycles a third of a second on two cores
OVERLAP = 32   # texels that tiles share, in which the one fades into the other
Tile = tuple[slice, slice]


def tiles(height: int, width: int) -> list[Tile]:
    """Rows and columns of tiles of one size all over a picture."""
    return [(rows, columns) for rows in _along(height) for columns in _along(width)]


def _along(length: int) -> list[slice]:
    count = max(math.ceil((length - OVERLAP) / (LONGEST - OVERLAP)), 1)
    size = math.ceil((length + (count - 1) * OVERLAP) / count)
    starts = np.linspace(0, length - size, count).round().astype(int)
    return [slice(start, start + size) for start in starts.tolist()]


def in_tiles(values: np.ndarray, changed: Callable[[Tile], np.ndarray]) -> Iterator[float]:
    """Put what becomes of each tile into a picture (height, width, 4), `UNTOUCHED` where nothing is, when all of it is
    known; yields before each tile what part is done."""
    height, width = values.shape[:2]
    total, weights = np.zeros_like(values), np.zeros((height, width, 1), dtype=np.float32)
    wanted = [tile for tile in tiles(height, width) if (values[tile][..., 3] != UNTOUCHED).any()]
    for number, tile in enumerate(wanted):
        yield number / len(wanted)
        found = changed(tile)
        weight = np.multiply.outer(*map(_fade, found.shape[:2]))[..., None] * (found[..., 3:] != UNTOUCHED)
        total[tile] += weight * found
        weights[tile] += weight
    known = weights[..., 0] > 0.0
    values[known] = total[known] / weights[known]


def _fade(length: int) -> np.ndarray:
    """How much a tile counts, (length,) float32, from side to side."""
    from_side = np.minimum(np.arange(length), np.arange(length)[::-1])
    return (np.minimum(from_side + 1, OVERLAP) / OVERLAP).astype(np.float32)
