"""Those of many things that are chosen, as a mask, and with numbers of their own."""
from __future__ import annotations

import numpy as np


def mask(count: int, chosen: np.ndarray) -> np.ndarray:
    """Which of so many things are `chosen`, by their indices in whatever shape: (count,) bool."""
    found = np.zeros(count, dtype=bool)
    found[chosen] = True
    return found


def numbered(count: int, chosen: np.ndarray, start: int = 0) -> np.ndarray:
    """(count,) int64: numbers from `start` on for those of so many things that are `chosen`, by indices or a mask, in
    their order; -1 for the others."""
    found = np.full(count, -1)
    found[chosen] = start + np.arange(int(chosen.sum()) if chosen.dtype == bool else len(chosen))
    return found
