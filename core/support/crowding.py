"""What is left out where there is too much of it."""
from __future__ import annotations

import numpy as np


def crowded(count: np.ndarray, worth: np.ndarray, most: int) -> np.ndarray:
    """Which of those that have `count` (n,) entries each are left out, so that no more than `most` entries are left:
    those first that have the most of them for their `worth` (n,)."""
    out = np.zeros(len(count), dtype=bool)
    if count.sum() > most:
        order = np.argsort(count / worth, kind="stable")
        out[order] = np.cumsum(count[order]) > most
    return out
