"""Roots of cubics by monotone intervals: safe for every degree, for multiple roots and for vanishing coefficients."""
from __future__ import annotations

import numpy as np

from .roots import Roots
from .rounding import UNIT, derivatives, horner, slope_bound, value_bound

_FAR = 2.0 ** 300
"""Extrema beyond this count as infinitely far: their cubes still fit a float64."""

_QUICK_STEPS, _MOST_STEPS = 5, 160
"""Steps of Halley's method that every root takes, and the bound for the few that need more: they gain a factor of 1/2 a
step even at a triple root, or halve their bracket instead."""


def monotone_roots(coefficients: np.ndarray, bounds: np.ndarray, low: np.ndarray,
                   high: np.ndarray) -> tuple[Roots, np.ndarray]:
    """Every root between `low` and `high`, whatever the cubic.

    Coefficients at either end that rounding cannot tell from zero are taken as zero: their roots lie at 0 or at
    infinity as far as anyone can know, and are no positive roots. What is left is split at the extrema into monotone
    intervals; the sign of the cubic at their ends says which of them hold a root, and Halley's method, kept inside its
    bracket, finds it [1]_. An extremum at which rounding cannot tell the cubic from zero is one double root.

    Parameters
    ----------
    coefficients, bounds : (4, n) float64
        c0 to c3, and bounds on their absolute errors.
    low, high : (n,) float64

    Returns
    -------
    roots : Roots
    degenerate : (n,) bool
        Cubics that rounding cannot tell from zero; they have no roots here.

    References
    ----------
    .. [1] C. Yuksel, "High-Performance Polynomial Root Finding for Graphics", Proc. ACM Comput. Graph. Interact.
       Tech. 5 (3), 2022.
    """
    count = coefficients.shape[1]
    coefficients, first, last, degenerate = _without_noise(coefficients, bounds)
    ends, signs = _monotone_intervals(coefficients, bounds, first, last, low, high)

    # The one root of an interval whose ends differ in sign, or the double root at an extremum that counts as zero:
    # no interval next to such an extremum changes sign, so its slot is free to hold it.
    found = np.empty((count, 3), dtype=bool)
    found[...] = (signs[:-1] * signs[1:] < 0).T
    found[:, 0] |= signs[1] == 0
    found[:, 2] |= (signs[2] == 0) & (signs[1] != 0)
    found[degenerate] = False
    slots = np.flatnonzero(found)
    cubic = slots // 3
    slot = slots - 3 * cubic
    at = slot * count + cubic
    low, high = ends.ravel()[at], ends.ravel()[at + count]
    low_sign, high_sign = signs.ravel()[at], signs.ravel()[at + count]
    double = np.flatnonzero(low_sign * high_sign == 0)
    low[double] = high[double] = np.where(slot[double] == 0, high[double], low[double])

    # A root between 0 and 1 is found as it is, one above as the inverse of a root of the reversed cubic.
    inverse = low >= 1.0
    across = np.flatnonzero((low < 1.0) & (high > 1.0))
    inverse[across] = coefficients[:, cubic[across]].sum(axis=0) * low_sign[across] > 0.0
    c, e = coefficients.take(cubic, axis=1), bounds.take(cubic, axis=1)
    turn = np.flatnonzero(inverse)
    c[:, turn], e[:, turn] = c[::-1, turn], e[::-1, turn]
    with np.errstate(divide="ignore"):
        low[turn], high[turn] = 1.0 / high[turn], 1.0 / low[turn]
    low, high = np.minimum(low, 1.0), np.minimum(high, 1.0)
    value = _bracketed_root(_without_zeros(c), low, high, np.where(inverse, high_sign, low_sign))
    value[double] = low[double]
    high_sign[double] = 0
    return Roots(cubic, value, inverse, high_sign, *_root_errors(c, e, value, high_sign)), degenerate


def _without_noise(c: np.ndarray, bounds: np.ndarray):
    """The cubics less the outer coefficients within their bounds, and the first and last coefficient left."""
    known = np.abs(c) > bounds
    degenerate = ~(known[0] | known[1] | known[2] | known[3])
    if known[0].all() and known[3].all():
        return c, c[0], c[3], degenerate
    up = np.logical_or.accumulate(known, axis=0)
    down = np.logical_or.accumulate(known[::-1], axis=0)[::-1]
    c = np.where(up & down, c, 0.0)
    first = np.where(known[0], c[0], np.where(known[1], c[1], np.where(known[2], c[2], c[3])))
    last = np.where(known[3], c[3], np.where(known[2], c[2], np.where(known[1], c[1], c[0])))
    return c, first, last, degenerate


def _without_zeros(c: np.ndarray) -> np.ndarray:
    """The cubics divided by s as often as they allow, which leaves no root at 0 for a bracket to end in."""
    for _ in range(3):
        at = np.flatnonzero(c[0] == 0.0)
        if not len(at):
            break
        c = c.copy()
        c[:, at] = np.roll(c[:, at], -1, axis=0)
    return c


def _monotone_intervals(c: np.ndarray, bounds: np.ndarray, first: np.ndarray, last: np.ndarray, low: np.ndarray,
                        high: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Ends (4, n) of the three intervals low, extremum, extremum, high (any of them empty), and the signs there."""
    high = np.maximum(low, high)
    ends = np.empty((4, c.shape[1]))
    ends[0], ends[3] = low, np.where(high < _FAR, high, np.inf)
    signs = np.empty((4, c.shape[1]), dtype=np.int8)
    # A zero at an end is no root that is looked for, so either sign will do there.
    signs[0] = np.where(np.where(low > 0.0, horner(c, np.minimum(low, _FAR)), first) < 0.0, -1, 1)
    signs[3] = np.where(np.where(high < _FAR, horner(c, np.minimum(high, _FAR)), last) < 0.0, -1, 1)

    discriminant = c[2] * c[2] - 3.0 * c[3] * c[1]
    q = np.sqrt(np.maximum(discriminant, 0.0))
    q = -(c[2] + np.copysign(q, c[2]))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        one, other = q / (3.0 * c[3]), c[1] / q
    real = discriminant > 0.0
    # Where rounding cannot tell the slope at the inflection from zero, both extrema are there.
    near = np.flatnonzero(~real & (discriminant > -0.1 * c[2] * c[2]) & (c[2] * c[3] < 0.0))
    if len(near):
        part = c[:, near]
        inflection = -part[2] / (3.0 * part[3])
        level = np.abs(derivatives(part, inflection)[1]) <= slope_bound(part, bounds[:, near], inflection)
        near = near[level]
        one[near] = other[near] = inflection[level]
        real[near] = True
    # A missing extremum makes an empty interval at the lower end, one beyond the upper end an empty interval there.
    one, other = (np.where(real & (end > low), end, low) for end in (one, other))
    for k, end in ((1, np.minimum(one, other)), (2, np.maximum(one, other))):
        end = np.minimum(end, ends[3])
        inside = (end > low) & (end < ends[3])
        x = np.minimum(end, _FAR)
        sign = _sign_at_extremum(c, bounds, x)
        signs[k] = np.where(inside, sign, np.where(end > low, signs[3], signs[0]))
        ends[k] = end
    # Two extrema in a row that count as zero are one triple root, between them.
    triple = np.flatnonzero((signs[1] == 0) & (signs[2] == 0) & (ends[2] < ends[3]))
    ends[1, triple] = 0.5 * (ends[1, triple] + ends[2, triple])
    return ends, signs


def _sign_at_extremum(c: np.ndarray, bounds: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Sign of each cubic at its extremum x, 0 where there may be a double root nearby.

    At the double root that the exact cubic has, this one is at most its bound B and its slope at most that slope's
    bound D. So the root is within d of x (see `_shift`), and the value here at most B + D d. As D d is seldom above
    3 B, this is looked at closely up to 4 B.
    """
    value, bound = horner(c, x), value_bound(c, bounds, x)
    size = np.abs(value)
    near = np.flatnonzero((size > bound) & (size <= 4.0 * bound))
    if len(near):
        part, at = c[:, near], x[near]
        level = slope_bound(part, bounds[:, near], at)
        bound[near] += level * _shift(part, level, at)
    return _sign(value, bound)


def _shift(c: np.ndarray, level: np.ndarray, x: np.ndarray) -> np.ndarray:
    """How far an extremum at x may move where the slope f' is off by no more than its bound D (`level`): D / |f''|, and
    where that vanishes sqrt(D / |3 c3|)."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.fmin(level / np.abs(2.0 * c[2] + 6.0 * c[3] * x), np.sqrt(level / np.abs(3.0 * c[3])))


def _bracketed_root(c: np.ndarray, low: np.ndarray, high: np.ndarray, low_sign: np.ndarray) -> np.ndarray:
    """The root of each cubic (4, n) in [low, high], a part of [0, 1], where it is monotone and changes sign."""
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
    """One step of Halley's, or a halving where that leaves the bracket or, for want of slope, rests at an extremum;
    narrows `low` and `high` in place. Also whether rounding still allows another step."""
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


def _root_errors(c: np.ndarray, bounds: np.ndarray, x: np.ndarray,
                 sign: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """`Roots.error` and `Roots.spread`; clears the signs (in place) of roots with no slope to speak of.

    A simple root of slope f' and curvature f'' whose extremum is further from zero than the bound B has
    f'^2 > 2 B |f''|, and then |f' d| - |f'' d^2| / 2 = B gives d <= 2 B / |f'|. At a double root |f| <= B leaves a
    true value up to 2 B, so f'' d^2 / 2 (1 - 2/3 d / D) = 2 B gives a spread d <= sqrt(12 B / |f''|) as far as the
    other extremum, at the distance D; at a triple root c3 d^3 = 2 B.
    """
    bound = value_bound(c, bounds, x)
    steep = np.abs(derivatives(c, x)[1])
    level = slope_bound(c, bounds, x)
    sign[steep <= level] = 0
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        error = 2.0 * bound / steep + 4.0 * UNIT * x
        spread = error.copy()
        flat = np.flatnonzero(sign == 0)
        c, bound, at = c[:, flat], bound[flat], x[flat]
        error[flat] = _shift(c, level[flat], at) + 4.0 * UNIT * at
        spread[flat] = np.fmin(np.sqrt(12.0 * bound / np.abs(2.0 * c[2] + 6.0 * c[3] * at)),
                               np.cbrt(2.0 * bound / np.abs(c[3]))) + error[flat]
    return error, spread


def _sign(value: np.ndarray, bound) -> np.ndarray:
    """-1, 0 where |value| <= bound, 1."""
    return (value > bound).view(np.int8) - (value < -bound).view(np.int8)
