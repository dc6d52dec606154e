"""One root of each of many cubics, in a bracket that it cannot leave: Halley's method, and halving where that fails."""
from __future__ import annotations

import numpy as np

from .rounding import UNIT, derivatives, horner

_QUICK_STEPS, _MOST_STEPS = 5, 160
"""Steps of Halley's method that every root takes, and the bound for the few that need more: they gain a factor of 1/2 a
step even at a triple root, or halve their bracket instead."""


def bracketed_root(c: np.ndarray, low: np.ndarray, high: np.ndarray, low_sign: np.ndarray) -> np.ndarray:
    """Find the root of each cubic `c` (4, n) in its bracket [low, high] within [0, 1].

    The cubic is monotone in the bracket and changes sign there; `low_sign` (n,) is its sign at `low` (n,).
    """
    c = _without_zeros(c)
    at_low, at_high = horner(c, low), horner(c, high)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        x = low + (high - low) * (at_low / (at_low - at_high))
        for _ in range(_QUICK_STEPS):
            value, slope, bend = derivatives(c, x)
            x = np.minimum(np.maximum(x - value * slope / (slope * slope - value * bend), low), high)
    x = np.where(x >= 0.0, x, 0.5 * (low + high))
    active = np.flatnonzero(~(np.abs(horner(c, x)) <= 2.0 * UNIT * horner(np.abs(c), x)))
    c, y, low, high, low_sign = c[:, active], x[active], low[active], high[active], low_sign[active].astype(np.float64)
    for _ in range(_MOST_STEPS):
        y, moved = _bracketed_step(c, y, low, high, low_sign)
        x[active] = y
        if not moved.any():
            break
        active, c, y, low, high, low_sign = (part[..., moved] for part in (active, c, y, low, high, low_sign))
    return x


def _bracketed_step(c, x, low, high, low_sign):
    """Take one step of Halley's method, or halve the bracket if the step leaves it or stalls at an extremum.

    Narrows `low` and `high` (n,) in place. Returns the new x (n,), and True (n,) if rounding allows another step.
    """
    value, slope, bend = derivatives(c, x)
    below = value * low_sign > 0.0
    np.copyto(low, x, where=below)
    np.copyto(high, x, where=~below)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        new = x - value * slope / (slope * slope - value * bend)
    useful = (new >= low) & (new <= high) & (slope * slope >= np.abs(value * bend))
    new = np.where(useful, new, 0.5 * (low + high))
    open_ = np.abs(value) > 2.0 * UNIT * horner(np.abs(c), x)
    return np.where(open_, new, x), open_ & (np.abs(new - x) > 2.0 * UNIT * x)


def _without_zeros(c: np.ndarray) -> np.ndarray:
    """Divide out the roots at 0 of cubics `c` (4, n), so that no bracket ends in one."""
    for _ in range(3):
        at = np.flatnonzero(c[0] == 0.0)
        if not len(at):
            break
        c = c.copy()
        c[:, at] = np.roll(c[:, at], -1, axis=0)
    return c
