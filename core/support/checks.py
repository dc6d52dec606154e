"""What is given to the core, looked at once, at its door: an array of numbers, of whole numbers, or one number.

Each of these takes whatever NumPy and Python count as such a thing (lists, any precision and byte order, scalars of
NumPy) and says the caller's one sentence of everything else. Truth values, text and complex numbers are no numbers
here, and numbers with a fraction are no whole ones, not even 2.0: where one stands, something else was meant.
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
    """Raises `ReflectionError`, which says what is `wrong`, where something is of none of the kinds."""
    if not isinstance(given, kinds):
        raise ReflectionError(wrong)


def numbers(given, shape: tuple, wrong: str) -> np.ndarray:
    """An array as float64, which is the given one where that already fits.

    Parameters
    ----------
    given : array_like
    shape : tuple of int or None
        The length of each axis, None for one of any length. A list of nothing has any shape whose first axis may be 0.
    wrong : str
        What to say where it is no array of numbers of that shape.

    Raises
    ------
    ValueError
    """
    array = _array(given, shape, wrong)
    if array.dtype.kind not in "iuf" and len(array) and not _all(array, _real):
        raise ValueError(wrong)
    with np.errstate(over="ignore"):  # what no float64 can hold is infinite
        return _array(array, shape, wrong, np.float64)


def whole_numbers(given, shape: tuple, wrong: str) -> np.ndarray:
    """The same of whole numbers, as int64; those too large for it come out below zero."""
    array = _array(given, shape, wrong)
    if array.dtype.kind not in "iu" and len(array) and not _all(array, _whole):
        raise ValueError(wrong)
    return _array(array, shape, wrong, np.int64)


def number(given) -> float:
    """One real number as a float: not a number where it is none."""
    if isinstance(given, np.ndarray) and not given.ndim:
        given = given[()]
    if not _real(given):
        return float("nan")
    try:
        return float(given)
    except OverflowError:
        return float("inf") if given > 0 else float("-inf")


def whole_number(given) -> int | None:
    """One whole number as an int, None where it is none."""
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
    """Whether an array of objects holds nothing else, such as fractions or numbers too long for NumPy."""
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
