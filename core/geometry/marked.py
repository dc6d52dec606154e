"""Conversion of indices to boolean masks and to consecutive numbers."""
from __future__ import annotations

import numpy as np


def mask(count: int, chosen: np.ndarray) -> np.ndarray:
    """Return a mask (count,) bool that is True at the indices `chosen`, an array of any shape."""
    found = np.zeros(count, dtype=bool)
    found[chosen] = True
    return found


def numbered(count: int, chosen: np.ndarray, start: int = 0) -> np.ndarray:
    """Number the `chosen` entries, given by indices or a mask, from `start` on, in their order.

    Return (count,) int64: the numbers, and -1 for entries not chosen.
    """
    found = np.full(count, -1)
    found[chosen] = start + np.arange(int(chosen.sum()) if chosen.dtype == bool else len(chosen))
    return found
