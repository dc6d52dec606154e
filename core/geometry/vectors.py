"""Dot and cross products on component-first arrays: three rows x, y, z of any length.

Rows that are contiguous in memory make these several times faster than `np.cross` and `np.einsum` on (n, 3) arrays, and
the method spends most of its time in such products. Functions that gather entries also yield (`breathe`): nearly all
steps call them often, so that the program stays responsive.
"""
from __future__ import annotations

from collections.abc import Generator

import numpy as np

from ..support import breathe
from .distinct import distinct, first_of


def rows(points: np.ndarray) -> np.ndarray:
    """Return a component-first copy (3, ...) of points (..., 3)."""
    breathe()
    return np.ascontiguousarray(np.moveaxis(points, -1, 0))


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    total = a[0] * b[0]
    total += a[1] * b[1]
    total += a[2] * b[2]
    return total


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    first = a[1] * b[2]
    product = np.empty((3, *first.shape))
    np.subtract(first, a[2] * b[1], out=product[0])
    np.subtract(a[2] * b[0], a[0] * b[2], out=product[1])
    np.subtract(a[0] * b[1], a[1] * b[0], out=product[2])
    return product


def columns(a: np.ndarray, index: np.ndarray) -> np.ndarray:
    """Return a[..., index] for valid indices; twice as fast as NumPy's indexing, because bounds are not checked."""
    breathe()
    return a.take(index, axis=-1, mode="wrap")


def largest(a: np.ndarray) -> np.ndarray:
    """Return the maximum (n,) of three rows (3, n); much faster than NumPy's maximum along so short an axis."""
    return np.maximum(np.maximum(a[0], a[1]), a[2])


def smallest(a: np.ndarray) -> np.ndarray:
    """Return the minimum (n,) of three rows (3, n)."""
    return np.minimum(np.minimum(a[0], a[1]), a[2])


def norm(a: np.ndarray) -> np.ndarray:
    return np.sqrt(dot(a, a))


def unit(a: np.ndarray) -> np.ndarray:
    """Return a / |a|, and zero where a is zero."""
    length = norm(a)
    return a / np.where(length > 0.0, length, 1.0)


def across(axis: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return two unit vectors (3, n) perpendicular to the unit vectors `axis` (3, n) and to each other."""
    other = np.where(np.abs(axis[:1]) < 0.6, np.array([[1.0], [0.0], [0.0]]), np.array([[0.0], [1.0], [0.0]]))
    first = unit(cross(axis, other))
    return first, cross(axis, first)


def solve(c0: np.ndarray, c1: np.ndarray, c2: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solve x0 c0 + x1 c1 + x2 c2 = right for x (3, n), by Cramer's rule; zero where the columns are dependent."""
    normal = cross(c1, c2)
    determinant = dot(c0, normal)
    inverse = np.divide(1.0, determinant, out=np.zeros_like(determinant), where=np.abs(determinant) > 1e-300)
    turned = cross(right, c0)
    return np.stack((dot(right, normal), -dot(turned, c2), dot(turned, c1))) * inverse


def spread_directions(count: int) -> np.ndarray:
    """Return unit vectors (count, 3), distributed about evenly over the sphere.

    They are a Fibonacci spiral with steps of the golden angle (R. Swinbank, R. J. Purser, "Fibonacci grids", 2006).
    """
    turn = np.arange(count) + 0.5
    height, angle = 1.0 - 2.0 * turn / count, np.pi * (1.0 + np.sqrt(5.0)) * turn
    ring = np.sqrt(1.0 - height * height)
    return np.stack((ring * np.cos(angle), ring * np.sin(angle), height), axis=1)


def ranges(starts: np.ndarray, lengths: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Concatenate the indices of the runs [start, start + length); return them and the run that each belongs to."""
    run = np.repeat(np.arange(len(lengths)), lengths)
    before = np.cumsum(lengths) - lengths
    return np.arange(len(run)) - np.repeat(before - starts, lengths), run


def between(rising: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find in sorted numbers `rising` those from `low` to `high` (n,), both included.

    Return the index (n,) of the first one, and their count (n,).
    """
    start = np.searchsorted(rising, low)
    return start, np.searchsorted(rising, high, side="right") - start


def shares(lengths: np.ndarray, most: int) -> Generator[slice, None, None]:
    """Yield slices of runs of `lengths` (n,) with about `most` entries each; no run is divided.

    Calls `breathe` before each slice.
    """
    before = np.append(0, np.cumsum(lengths))
    cuts = np.unique(np.concatenate(([0], np.searchsorted(before, np.arange(0, before[-1], most)), [len(lengths)])))
    for start, stop in zip(cuts[:-1], cuts[1:]):
        breathe()
        yield slice(start, stop)


def groups(*keys: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Group rows of several keys (n,) of integers >= 0 by value.

    Return the index of the first row of each group, and the group (n,) of each row.
    """
    group = keys[0]
    for key in keys[1:]:
        _, group = distinct(group)
        breathe()
        group = group * (int(key.max(initial=0)) + 1) + key
    _, first, group = first_of(group)
    return first, group
