"""Input validation at the core's public interface: an array of numbers, an array of integers, or one number.

Each function accepts whatever NumPy and Python count as such (lists, any precision and byte order, NumPy scalars) and
raises an error with the caller's message for anything else. Booleans, text and complex numbers are no numbers here, and
floats are no integers, not even 2.0: they show that the caller meant something else.
"""
from __future__ import annotations

from collections.abc import Callable
from numbers import Real
from operator import index

import numpy as np

from .errors import ReflectionError

_TRUTH = (bool, np.bool_)
LARGEST = 1e40
"""Coordinates may be as large: more than Blender can hold, and their products of seven still are numbers."""


def must_be(given, kinds: type | tuple[type, ...], wrong: str) -> None:
    """Raise `ReflectionError` with the message `wrong` if `given` is an instance of none of the `kinds`."""
    if not isinstance(given, kinds):
        raise ReflectionError(wrong)


def numbers(given, shape: tuple, wrong: str) -> np.ndarray:
    """Convert `given` to an array of float64; return the given array itself if it already fits.

    Parameters
    ----------
    given : array_like
    shape : tuple of int or None
        The length of each axis, None for one of any length. A list of nothing has any shape whose first axis may be 0.
    wrong : str
        Message of the error if it is no array of numbers of that shape.

    Raises
    ------
    ValueError
    """
    array = _array(given, shape, wrong)
    if array.dtype.kind not in "iuf" and len(array) and not _all(array, _real):
        raise ValueError(wrong)
    with np.errstate(over="ignore"):  # numbers too large for float64 become infinite
        return _array(array, shape, wrong, np.float64)


def whole_numbers(given, shape: tuple, wrong: str) -> np.ndarray:
    """Convert `given` to an array of int64, as `numbers` does; integers too large for int64 become negative."""
    array = _array(given, shape, wrong)
    if array.dtype.kind not in "iu" and len(array) and not _all(array, _whole):
        raise ValueError(wrong)
    return _array(array, shape, wrong, np.int64)


def number(given) -> float:
    """Convert one real number to a float; return NaN if `given` is none."""
    if isinstance(given, np.ndarray) and not given.ndim:
        given = given[()]
    if not _real(given):
        return float("nan")
    try:
        return float(given)
    except OverflowError:
        return float("inf") if given > 0 else float("-inf")


def whole_number(given) -> int | None:
    """Convert one integer to an int; return None if `given` is none."""
    return index(given) if _whole(given) else None


def _array(given, shape: tuple, wrong: str, dtype: type | None = None) -> np.ndarray:
    try:
        array = np.asarray(given, dtype=dtype)
    except (TypeError, ValueError, OverflowError) as error:
        raise ValueError(wrong) from error
    if array.ndim and not len(array) and not shape[0]:
        return array.reshape(0, *shape[1:])
    if array.ndim != len(shape) or any(want not in (None, length) for want, length in zip(shape, array.shape)):
        raise ValueError(wrong)
    return array


def _all(array: np.ndarray, kind: Callable[[object], bool]) -> bool:
    """Return True for an array of Python objects all of which are of a `kind`, such as fractions or long integers."""
    return array.dtype.kind == "O" and all(kind(part) for part in array.flat)


def _real(given) -> bool:
    return isinstance(given, Real) and not isinstance(given, _TRUTH)


def _whole(given) -> bool:
    if isinstance(given, _TRUTH):
        return False
    try:
        index(given)
    except TypeError:
        return False
    return True
