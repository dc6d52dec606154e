"""Choice of the items to leave out if there are too many entries in all."""
from __future__ import annotations

import numpy as np


def crowded(count: np.ndarray, worth: np.ndarray, most: int) -> np.ndarray:
    """Return True for items (n,) to leave out, so that the others have at most `most` entries together.

    Item i has `count[i]` entries; items with the most entries for their `worth` (n,) are left out first.
    """
    out = np.zeros(len(count), dtype=bool)
    if count.sum() > most:
        order = np.argsort(count / worth, kind="stable")
        out[order] = np.cumsum(count[order]) > most
    return out
