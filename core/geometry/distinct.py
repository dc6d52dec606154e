"""Unique values and sort orders of integers, faster than `np.unique` and `np.argsort`.

NumPy sorts numbers several times as fast as it computes the order of sorting, because processors have instructions for
the first. So each key is packed with its index, in the lower bits, into one number.
"""
from __future__ import annotations

import numpy as np

from ..support import breathe
from .marked import mask

DENSE = 8  # largest key in multiples of the number of keys, up to which a table is used instead of sorting


def distinct(key: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the distinct integers >= 0 (k,) among keys (n,), rising, and for each key its index (n,) in these."""
    most = int(key.max(initial=-1))
    if most > DENSE * len(key):
        values, _, group = first_of(key)
        return values, group
    table = mask(most + 1, key)
    breathe()
    number = np.cumsum(table)
    number -= 1
    return np.flatnonzero(table), number.take(key, mode="wrap")


def first_of(key: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find the distinct integers >= 0 among keys (n,).

    Return the integers (k,), rising, the index (k,) of the first key equal to each, and for each key its index (n,) in
    the integers.
    """
    order, rising = _sorted(key)
    new = np.ones(len(key), dtype=bool)
    np.not_equal(rising[1:], rising[:-1], out=new[1:])
    number, group = np.cumsum(new), np.empty(len(key), dtype=np.int64)
    number -= 1
    breathe()
    group[order] = number
    breathe()
    at = np.flatnonzero(new)
    return rising[at], order[at], group


def in_order(key: np.ndarray) -> np.ndarray:
    """Return the indices (n,) that sort integers >= 0; the sort is stable."""
    return _sorted(key)[0]


def _sorted(key: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices (n,) that sort integers >= 0, and the sorted integers (n,)."""
    bits = max(len(key) - 1, 0).bit_length()
    if int(key.max(initial=0)).bit_length() + bits > 63:
        order = np.argsort(key, kind="stable")
        return order, key[order]
    both = key.astype(np.int64) << bits
    both |= np.arange(len(key))
    breathe()
    both.sort()
    breathe()
    order = both & ((1 << bits) - 1)
    both >>= bits
    return order, both
