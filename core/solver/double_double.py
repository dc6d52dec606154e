"""Numbers of twice the length: unevaluated sums of two float64 (high, low), good to about 2^-104.

T. Dekker, "A floating-point technique for extending the available precision", Numer. Math. 18, 1971; the error-free sum
is D. Knuth's. Nothing may overflow, and the products' errors must not underflow: scale first.
"""
from __future__ import annotations

import numpy as np

PRECISION = 2.0 ** -102
"""Relative error of one sum or product, of the numbers that enter it, with room to spare."""

_SPLITTER = 2.0 ** 27 + 1.0

Number = tuple[np.ndarray, np.ndarray]


def difference(a: np.ndarray, b: np.ndarray) -> Number:
    """a - b of float64 numbers, exactly."""
    return _exact_sum(a, -b)


def add(a: Number, b: Number) -> Number:
    high, low = _exact_sum(a[0], b[0])
    more, least = _exact_sum(a[1], b[1])
    high, low = _short_sum(high, low + more)
    return _short_sum(high, low + least)


def subtract(a: Number, b: Number) -> Number:
    return add(a, (-b[0], -b[1]))


def multiply(a: Number, b: Number) -> Number:
    high = a[0] * b[0]
    (a1, a2), (b1, b2) = _halves(a[0]), _halves(b[0])
    low = ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2
    return _short_sum(high, low + (a[0] * b[1] + a[1] * b[0]))


def dot(a: list[Number], b: list[Number]) -> Number:
    return add(add(multiply(a[0], b[0]), multiply(a[1], b[1])), multiply(a[2], b[2]))


def cross(a: list[Number], b: list[Number]) -> list[Number]:
    return [subtract(multiply(a[i], b[k]), multiply(a[k], b[i])) for i, k in ((1, 2), (2, 0), (0, 1))]


def _exact_sum(a: np.ndarray, b: np.ndarray) -> Number:
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _short_sum(a: np.ndarray, b: np.ndarray) -> Number:
    """Add a and b exactly, where |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def _halves(a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    big = _SPLITTER * a
    high = big - (big - a)
    return high, a - high
