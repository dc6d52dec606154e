"""Positive roots of cubics, each with bounds on its error."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays


@dataclass(frozen=True)
class Roots(ColumnArrays):
    """Roots s > 0 of many cubics, in rising order for each, but in no order of the cubics.

    A large root may be stored as 1 / `value`, where `value` is a root of the reversed cubic, so that neither infinitely
    large numbers nor vanishing leading coefficients need care.

    Attributes
    ----------
    cubic : (m,) int64, index of the cubic
    value : (m,) float64, at least 0, and at most 1 where reversed
    reversed : (m,) bool, True if the root is 1 / `value`
    sign : (m,) int8
        Sign of the cubic's derivative by s at the root, 0 where rounding cannot tell it from a multiple root.
    error : (m,) float64, bound on the error of `value`, to first order in the unit roundoff
    spread : (m,) float64
        How far from `value` the separate roots may lie that count as one multiple root; `error` for a simple one.
    """

    cubic: np.ndarray
    value: np.ndarray
    reversed: np.ndarray
    sign: np.ndarray
    error: np.ndarray
    spread: np.ndarray
