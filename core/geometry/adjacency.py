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
    number, from 0 on in the order of their lowest ones.

    Each root is hung below the lowest one beside it, and what hangs together so far is one number in the next round
    (Y. Shiloach, U. Vishkin, "An O(log n) parallel connectivity algorithm", 1982).
    """
    part = np.arange(int(triangles.max(initial=-1)) + 1)
    first, *others = triangles.T
    one, other = np.tile(first, len(others)), np.concatenate([first[:0], *others])
    while True:
        apart = np.flatnonzero(one != other)
        if not len(apart):
            return distinct(part[first])[1]
        breathe()
        low, high = np.minimum(one[apart], other[apart]), np.maximum(one[apart], other[apart])
        root = np.arange(len(part))
        np.minimum.at(root, high, low)
        breathe()
        while (root[root] != root).any():
            root = root[root]
            breathe()
        part, one, other = root[part], root[low], root[high]
