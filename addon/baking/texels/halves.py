"""Triangles that are two halves of one parallelogram, as those of floors and walls are."""
from __future__ import annotations

import numpy as np

ASTRAY = 1e-3  # of a diagonal, from where the fourth corner would be


def halves(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which triangles, one after the other, make a parallelogram with the side that both have as its diagonal.

    Parameters
    ----------
    places : (n, 3, 3) float64
        The corners of triangles in space, first the one opposite the side that others may have too.

    Returns
    -------
    second : (n,) bool
        The later halves; the triangle before each is its other half. None is half of two.
    alike : (n,) bool
        Those of them that name the ends of the diagonal in the same order as the other half.
    """
    before, after = places[:-1], places[1:]
    alike = (before[:, 1:] == after[:, 1:]).all(axis=(1, 2))
    joined = alike | (before[:, 1:] == after[:, :0:-1]).all(axis=(1, 2))
    diagonal = np.linalg.norm(before[:, 2] - before[:, 1], axis=1)
    astray = np.linalg.norm(before[:, 0] + after[:, 0] - before[:, 1] - before[:, 2], axis=1)
    joined &= astray <= ASTRAY * diagonal
    index = np.arange(len(joined))
    # of three in a row, the third begins anew
    last = np.maximum.accumulate(np.where(joined, -1, index)) if len(index) else index
    chosen = np.r_[np.zeros(min(len(places), 1), bool), joined & ((index - last) % 2 == 1)]
    return chosen, chosen & np.r_[np.zeros(min(len(places), 1), bool), alike]
