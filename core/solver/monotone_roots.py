"""Roots of cubics by monotone intervals: safe for every degree, for multiple roots and for vanishing coefficients."""
from __future__ import annotations

import numpy as np

from .bracketed_root import bracketed_root
from .multiple_roots import merged, root_errors, shift
from .roots import Roots
from .rounding import derivatives, horner, slope_bound, value_bound

_FAR = 2.0 ** 300
"""Extrema beyond this count as infinitely far: their cubes still fit a float64."""


def monotone_roots(coefficients: np.ndarray, bounds: np.ndarray, low: np.ndarray,
                   high: np.ndarray) -> tuple[Roots, np.ndarray]:
    """Find every root between `low` and `high` of any cubic.

    Coefficients at either end that rounding cannot tell from zero are taken as zero: their roots lie at 0 or at
    infinity as far as anyone can know, and are no positive roots. What is left is split at the extrema into monotone
    intervals; the sign of the cubic at their ends says which of them hold a root, and Halley's method, kept inside its
    bracket, finds it [1]_. Where rounding cannot tell the cubic from zero at an extremum, it has a double root there:
    in place of the two roots to either side, if they are that close, or of none.

    Parameters
    ----------
    coefficients, bounds : (4, n) float64, c0 to c3, and bounds on their absolute errors
    low, high : (n,) float64

    Returns
    -------
    roots : Roots
    degenerate : (n,) bool, cubics that rounding cannot tell from zero; they have no roots here

    References
    ----------
    .. [1] C. Yuksel, "High-Performance Polynomial Root Finding for Graphics", Proc. ACM Comput. Graph. Interact.
       Tech. 5 (3), 2022.
    """
    count = coefficients.shape[1]
    coefficients, first, last, degenerate = _without_noise(coefficients, bounds)
    ends, signs, flat = _monotone_intervals(coefficients, bounds, first, last, low, high)

    # The one root of an interval whose ends differ in sign, or the double root at a flat extremum which the cubic may
    # touch without crossing: no interval next to that changes sign, so its slot is free to hold it.
    found = np.empty((count, 3), dtype=bool)
    found[...] = (signs[:-1] * signs[1:] < 0).T
    touch = flat & (signs[:-2] == signs[1:-1]) & (signs[1:-1] == signs[2:])
    touch[0] |= signs[1] == 0
    touch[1] &= signs[1] != 0
    found[:, 0] |= touch[0]
    found[:, 2] |= touch[1]
    found[degenerate] = False
    slots = np.flatnonzero(found)
    cubic = slots // 3
    slot = slots - 3 * cubic
    at = slot * count + cubic
    low, high = ends.ravel()[at], ends.ravel()[at + count]
    low_sign, high_sign = signs.ravel()[at], signs.ravel()[at + count]
    double = np.flatnonzero(((slot == 0) & touch[0, cubic]) | ((slot == 2) & touch[1, cubic]))
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
    value = bracketed_root(c, low, high, np.where(inverse, high_sign, low_sign))
    value[double] = low[double]
    high_sign[double] = 0
    roots = Roots(cubic, value, inverse, high_sign, *root_errors(c, e, value, high_sign))
    return merged(roots, slot, ends, flat, coefficients, bounds), degenerate


def _without_noise(c: np.ndarray, bounds: np.ndarray):
    """Set outer coefficients of the cubics `c` (4, n) to zero that lie within their `bounds` (4, n).

    Returns
    -------
    c : (4, n) float64
    first, last : (n,) float64, the first and last coefficient that is not within its bound
    degenerate : (n,) bool, True for cubics all of whose coefficients are within their bounds
    """
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


def _monotone_intervals(c: np.ndarray, bounds: np.ndarray, first: np.ndarray, last: np.ndarray, low: np.ndarray,
                        high: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Split the range from `low` (n,) to `high` (n,) at the cubic's extrema into three intervals; any may be empty.

    Returns
    -------
    ends : (4, n) float64, low, extremum, extremum, high
    signs : (4, n) int8, of the cubic at the ends, 0 at a triple root
    flat : (2, n) bool, True for extrema where rounding cannot tell the cubic from zero
    """
    high = np.maximum(low, high)
    ends = np.empty((4, c.shape[1]))
    ends[0], ends[3] = low, np.where(high < _FAR, high, np.inf)
    flat = np.zeros((2, c.shape[1]), dtype=bool)
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
    # Put both extrema at the inflection if rounding cannot tell the slope there from zero.
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
        flat[k - 1] = inside & _flat(c, bounds, x)
        signs[k] = np.where(inside, np.where(horner(c, x) < 0.0, -1, 1), np.where(end > low, signs[3], signs[0]))
        ends[k] = end
    # Two flat extrema in a row are one triple root, between them; not if one is so large that it drowns by itself.
    triple = np.flatnonzero(flat[0] & flat[1] & (ends[2] <= 2.0 * ends[1]))
    ends[1, triple] = 0.5 * (ends[1, triple] + ends[2, triple])
    signs[1:3, triple] = 0
    flat[:, triple] = False
    return ends, signs, flat


def _flat(c: np.ndarray, bounds: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return True (n,) for cubics that may have a double root near their extremum x (n,).

    At the double root that the exact cubic has, this one is at most its bound B and its slope at most that slope's
    bound D. So the root is within d of x (see `shift`), and the value here at most B + D d. As D d is seldom above
    3 B, this is looked at closely up to 4 B.
    """
    size, bound = np.abs(horner(c, x)), value_bound(c, bounds, x)
    near = np.flatnonzero((size > bound) & (size <= 4.0 * bound))
    if len(near):
        part, at = c[:, near], x[near]
        level = slope_bound(part, bounds[:, near], at)
        bound[near] += level * shift(part, level, at)
    return size <= bound
