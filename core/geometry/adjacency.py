"""Adjacency of triangles: neighbours across sides, border vertices, and connected components."""
from __future__ import annotations

import numpy as np

from ..support import breathe, portions
from .distinct import distinct, in_order
from .subdivision import edge_numbers, following, others

AT_ONCE = 16384  # triangles per chunk, whose arrays fit the CPU cache
SCATTERED = np.uint64(0x9E3779B97F4A7C15)  # 2**64 over the golden ratio, for multiplicative hashing


def corners_beyond(triangles: np.ndarray) -> np.ndarray:
    """Return for each corner of triangles (m, 3) the opposite corner of the neighbour across its opposite side.

    The result (m, 3) holds indices into the flattened triangles, -1 where there is no neighbour, or more than one.
    """
    # name each side by the corner opposite to it; it goes from the next corner to the previous one
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
    """Return True (count,) for vertices at which the surface of triangles (m, 3) ends, or changes its orientation."""
    # hash each index to 31 bits; two multiplications, because sums of simple multiples are equal if the sums of the
    # indices are; as floats, which `add.at` adds ten times as fast as types that it has to convert
    mixed = np.arange(count, dtype=np.uint64) * SCATTERED
    number = (((mixed ^ (mixed >> np.uint64(32))) * SCATTERED) >> np.uint64(33)).astype(np.float64)
    # around an inner vertex, each neighbour comes once after it and once before it: the sum is zero
    total = np.zeros(count)
    for part in portions(len(triangles), AT_ONCE):
        corner = triangles[part].T
        named = number.take(corner, mode="wrap")
        for k in range(3):
            after, before = others(k)
            np.add.at(total, corner[k], named[after] - named[before])
    return total != 0.0


def connected(triangles: np.ndarray) -> np.ndarray:
    """Return the connected component (m,) int64 of each triangle.

    `triangles` (m, k) may be any rows of indices; rows that share an index are connected. Components are numbered from
    0 on, in the order of their lowest indices.

    In each round, each root is attached to its lowest neighbour, and then connected roots are merged (Y. Shiloach,
    U. Vishkin, "An O(log n) parallel connectivity algorithm", 1982).
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
