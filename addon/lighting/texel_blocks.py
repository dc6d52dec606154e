"""Blocks: rectangles of texels, packed into one picture."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

MARGIN = 5          # texels around each block
# Texels along the sides of cells that faces may be sorted into. What is seen in small places all over a mirror needs
# far fewer texels by cells: 1.1 million in place of 3.3 for a mirror of 250,000 triangles that sees itself.
CELLS = (np.inf, 256.0, 64.0)
MOST_CELLS = 1 << 16    # along each axis
# share of the texels at which smaller cells pay: at the borders of blocks the denoiser leaves lines of 1/255
SAVES = 0.5


@dataclass
class Block:
    """A rectangle of texels: width and height, `size` (2,); lowest column and row in the picture, `corner` (2,)."""

    size: np.ndarray
    corner: np.ndarray


def blocks_of(group: np.ndarray, spots: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[Block]]:
    """Sort faces into blocks. Each group has one block, or one for each cell of a grid where that halves the texels.

    Parameters
    ----------
    group : (k,) int64
        Group of each face.
    spots : (k, 3, 2) float64
        Columns and rows of its corners.

    Returns
    -------
    block : (k,) int64
        The block of each face.
    low : (b, 2) int64
        Lowest column and row of each block, in the coordinates of `spots`.
    blocks : list of Block
        Their places in the picture are not known yet.
    """
    group = np.unique(group, return_inverse=True)[1]
    count, middle = group.max(initial=-1) + 1, spots.mean(axis=1)
    fewest, chosen = np.full(count, np.inf), group
    for side in CELLS:
        column, row = np.clip(middle / side, 0, MOST_CELLS - 1).astype(np.int64).T
        key = (row * MOST_CELLS + column) * count + group
        kinds, block = np.unique(key, return_inverse=True)
        low, high = _bounds(block, spots, len(kinds))
        texels = np.bincount(kinds % count, weights=(high - low).prod(axis=1), minlength=count)
        better = texels < SAVES * fewest
        fewest[better] = texels[better]
        chosen = np.where(better[group], key, chosen)
    kinds, block = np.unique(chosen, return_inverse=True)
    low, high = _bounds(block, spots, len(kinds))
    return block, low, [Block(size, np.zeros(2, dtype=np.int64)) for size in high - low]


def pack(blocks: Sequence[Block]) -> np.ndarray:
    """Stack blocks in shelves, the highest first; return the size of the whole."""
    texels = sum(float(np.prod(block.size)) for block in blocks)
    width = max(max((int(block.size[0]) for block in blocks), default=1), int(np.sqrt(texels)))
    shelf = used = height = 0
    for block in sorted(blocks, key=lambda block: -block.size[1]):
        if used + block.size[0] > width:
            shelf, used = shelf + height, 0
        if used == 0:
            height = int(block.size[1])
        block.corner = np.array((used, shelf))
        used += int(block.size[0])
    return np.array((width, max(shelf + height, 1)))


def _bounds(block: np.ndarray, spots: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the lowest column and row (b, 2) of each of `count` blocks with its margin, and one past the highest."""
    low, high = np.full((count, 2), np.inf), np.zeros((count, 2))
    np.minimum.at(low, block, spots.min(axis=1))
    np.maximum.at(high, block, spots.max(axis=1))
    return np.floor(low).astype(np.int64) - MARGIN, np.ceil(high).astype(np.int64) + MARGIN
