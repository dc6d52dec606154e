"""Pixels of a picture and those beside them."""
from __future__ import annotations

import numpy as np

from ...core import breathe


def sum_around(values: np.ndarray) -> np.ndarray:
    """The sum of each pixel and its eight neighbours, of a picture (height, width) or (height, width, channels)."""
    padded = np.pad(values, ((1, 1), (1, 1)) + ((0, 0),) * (values.ndim - 2))
    breathe()
    across = padded[:, :-2] + padded[:, 1:-1] + padded[:, 2:]
    breathe()
    return across[:-2] + across[1:-1] + across[2:]


def grown(mask: np.ndarray, rings: int) -> np.ndarray:
    """A mask (height, width) and so many rings of pixels around it."""
    for _ in range(rings):
        mask = sum_around(mask.astype(np.uint8)) > 0
    return mask
