"""Bounds on the rounding errors of a cubic's value and of its slope."""
from __future__ import annotations

import numpy as np

UNIT = 2.0 ** -53
"""Unit roundoff of float64."""

LEAST = 2.0 ** -1000
"""Smaller coefficients may have lost digits, of lengths of the order of 1."""


def horner(c: np.ndarray, x: np.ndarray) -> np.ndarray:
    """c[0] + c[1] x + c[2] x^2 + ... by Horner's rule."""
    value = c[-1]
    for row in c[-2::-1]:
        value = value * x + row
    return value


def derivatives(c: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the values of the cubics `c` (4, n) at x (n,), their slopes, and half their second derivatives."""
    value = c[3] * x
    bend = 3.0 * value + c[2]
    return ((value + c[2]) * x + c[1]) * x + c[0], (bend + c[2]) * x + c[1], bend


def value_bound(c: np.ndarray, bounds: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Bound on the error of `horner`: twice the coefficients' errors, for an outer one that was taken as zero while
    its true value may be as large, and the 2 k roundings of Horner's rule of degree k (Higham 2002, section 5.1)."""
    return horner(2.0 * bounds + 6.0 * UNIT * np.abs(c), x)


def slope_bound(c: np.ndarray, bounds: np.ndarray, x: np.ndarray) -> np.ndarray:
    """The same of the derivative, whose coefficients are the cubic's times 1, 2, 3."""
    factors = [[1.0], [2.0], [3.0]]
    return value_bound(c[1:] * factors, bounds[1:] * factors, x)
