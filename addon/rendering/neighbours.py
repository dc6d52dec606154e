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


def continued(picture: np.ndarray, known: np.ndarray, needed: np.ndarray,
              rings: int) -> tuple[np.ndarray, np.ndarray]:
    """The picture with unknown pixels, where needed, as the known ones around them, so many rings far; and which
    pixels (height, width) are known then."""
    found, known = np.where(known[..., None], picture, 0.0), known.copy()
    breathe()
    for _ in range(rings):
        open_ = needed & ~known
        if not open_.any():
            break
        weight = sum_around(known.astype(np.float64))
        breathe()
        ring = open_ & (weight > 0.0)
        if not ring.any():
            break
        found[ring] = sum_around(found)[ring] / weight[ring, None]
        known |= ring
        breathe()
    return np.where(known[..., None], found, picture), known
