"""Which triangles lie beyond each other's sides, and which hang together."""
from __future__ import annotations

import numpy as np

from ..support import breathe, portions
from .distinct import distinct, in_order
from .subdivision import edge_numbers, following, others

AT_ONCE = 16384  # triangles: what their arrays take fits the cache
SCATTERED = np.uint64(0x9E3779B97F4A7C15)  # 2**64 over the golden ratio: multiples of it lie all over


def corners_beyond(triangles: np.ndarray) -> np.ndarray:
    """For each corner of triangles (m, 3) the one beyond the opposite side, an entry of the flattened triangles, or -1
    where there is none, or more than one."""
    # each side by the corner opposite to it, from the next one to that before
    one, other = following(triangles).ravel(), np.roll(triangles, 1, axis=1).ravel()
    key = edge_numbers(one, other, int(triangles.max(initial=0)) + 1)
    order = in_order(key)
    rising = key[order]
    same = rising[1:] == rising[:-1]
    twice = same.copy()
    twice[1:] &= ~same[:-1]
    twice[:-1] &= ~same[1:]
    first = np.flatnonzero(twice)
    one, other = order[first], order[first + 1]
    beyond = np.full(len(key), -1)
    beyond[one], beyond[other] = other, one
    return beyond.reshape(-1, 3)


def borders(triangles: np.ndarray, count: int) -> np.ndarray:
    """Which of `count` vertices, that triangles (m, 3) name, are such at which the surface ends, or turns its other
    side."""
    # 31 bits of each, multiplied twice, since sums of mere multiples are equal wherever those of the indices are; as
    # floats, which `add.at` adds up ten times as fast as what it has to convert
    mixed = np.arange(count, dtype=np.uint64) * SCATTERED
    number = (((mixed ^ (mixed >> np.uint64(32))) * SCATTERED) >> np.uint64(33)).astype(np.float64)
    # round an inner vertex each neighbour comes once after it and once before it
    total = np.zeros(count)
    for part in portions(len(triangles), AT_ONCE):
        corner = triangles[part].T
        named = number.take(corner, mode="wrap")
        for k in range(3):
            after, before = others(k)
            np.add.at(total, corner[k], named[after] - named[before])
    return total != 0.0


def connected(triangles: np.ndarray) -> np.ndarray:
    """(m,) int64: triangles (m, k), or whatever else has numbers, that hang together by shared ones have the same
    number, from 0 on in the order of their lowest ones.

    Each root is hung below the lowest one beside it, and what hangs together so far is one number in the next round
    (Y. Shiloach, U. Vishkin, "An O(log n) parallel connectivity algorithm", 1982).
    """
    part = np.arange(int(triangles.max(initial=-1)) + 1)
    first, *rest = triangles.T
    one, other = np.tile(first, len(rest)), np.concatenate([first[:0], *rest])
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
