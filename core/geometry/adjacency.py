"""Which triangles lie beyond each other's sides, and which hang together."""
from __future__ import annotations

import numpy as np

from ..support import breathe
from .distinct import distinct, in_order
from .subdivision import following, shared_edges


def corners_beyond(triangles: np.ndarray) -> np.ndarray:
    """For each corner of triangles (m, 3) the one beyond the opposite side, an entry of the flattened triangles, or -1
    where there is none, or more than one."""
    _, _, edge = shared_edges(triangles)
    # edge k runs from corner k to the next; the side opposite to corner j is edge j + 1
    edge = following(edge).ravel()
    order = in_order(edge)
    one, other = order[np.bincount(edge)[edge[order]] == 2].reshape(-1, 2).T
    beyond = np.full(len(edge), -1)
    beyond[one], beyond[other] = other, one
    return beyond.reshape(-1, 3)


def connected(triangles: np.ndarray) -> np.ndarray:
    """(m,) int64: triangles (m, k), or whatever else has numbers, that hang together by shared ones have the same
    number, from 0 on in the order of their lowest ones."""
    part, width = np.arange(int(triangles.max(initial=-1)) + 1), triangles.shape[1]
    while True:
        # the lowest number of a triangle's corners spreads to all three, then each number's own number is followed
        breathe()
        low = part[triangles].min(axis=1)
        lower = part.copy()
        breathe()
        np.minimum.at(lower, triangles.ravel(), np.repeat(low, width))
        breathe()
        np.minimum.at(lower, part[triangles].ravel(), np.repeat(low, width))
        lower = lower[lower]
        if (lower == part).all():
            return distinct(part[triangles[:, 0]])[1]
        part = lower
