"""Distinct integers, and the order in which they rise, by sorts of whole numbers alone.

NumPy sorts numbers several times as fast as it tells in which order they come (processors have instructions for the
one). So each key takes its index along, in the lower bits of one number.
"""
from __future__ import annotations

import numpy as np

from ..support import breathe
from .marked import mask

DENSE = 8  # times the keys: numbers up to so many are marked in a table


def distinct(key: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The distinct integers >= 0 among keys (n,), rising; and which of them each key is."""
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
    """The distinct integers >= 0 among keys (n,), rising; where each occurs first; and which of them each key is."""
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
    """The order (n,) in which integers >= 0 rise, equal ones as they come."""
    return _sorted(key)[0]


def _sorted(key: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The order in which integers >= 0 rise, and they themselves."""
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
