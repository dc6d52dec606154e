"""Ordinary cubics: simple roots in closed form, each certified; all other cubics are marked."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import columns
from .roots import Roots
from .rounding import UNIT, derivatives

_KNOWN = 2.0 ** 27
"""Coefficients this many times their bounds have certain signs, and are known to 1e-8."""

_APART = 2.0 ** -21
"""The discriminant of an ordinary cubic, as a part of its terms: over 50 times what errors of 1e-8 make of it."""

_TINY = 2.0 ** -960
"""Products below this may have lost digits."""

_CLOSE = 2.0 ** -10
"""Newton's method gains ten bits or more with every step where its first one is so small beside slope over bend."""

_SHARP = 2.0 ** -20
"""Error of an ordinary root, as a part of it."""


def simple_roots(c: np.ndarray, bounds: np.ndarray,
                 noise: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> tuple[np.ndarray, Roots]:
    """The roots s > 0 of those cubics whose roots are certain.

    With t = y - A, A = c2 / 3 c3, a cubic is y^3 - 3 q y + 2 r = 0, with three real roots where D = q^3 - r^2 > 0 and
    one where D < 0 [1]_. Where all coefficients stand out of their noise, Descartes' rule tells how many roots are
    positive: none or one where there are so few changes of sign, or else, where D is far enough from zero, as many as
    there are changes if all are real, and one or none by their parity if one is. The closed form must find as many, and
    one step d = f / f' of Newton's makes them sharp: by Taylor's theorem it leaves |f| <= |f''| d^2 / 2 and the noise B
    of its evaluation. There is a root within 3 |f| / |f'| [2]_, so that 3.1 (|f''| d^2 / 2 + B) / |f'| bounds its error
    where d is too small for f' to change by much.

    Parameters
    ----------
    c : (4, n) float64, coefficients c0 to c3
    bounds : (4, n) float64, bounds on their absolute errors
    noise : function of cubics (m,) and values (m,), bound on the error of these cubics' values there, rounding included

    Returns
    -------
    uncertain : (n,) bool, cubics of which that cannot be said; they have no roots here
    roots : Roots

    References
    ----------
    .. [1] W. Press et al., "Numerical Recipes", 3rd ed. 2007, section 5.6.
    .. [2] P. Henrici, "Applied and Computational Complex Analysis", vol. 1, 1974, theorem 6.4g.
    """
    with np.errstate(all="ignore"):
        places, many, apart = _closed_form(c)
        below, positive = c < 0.0, places > 0.0
        positive[1:] &= many
        changes = (below[:-1] ^ below[1:]).view(np.int8)
        changes = changes[0] + changes[1] + changes[2]
        found = positive.view(np.int8)
        ordinary = found[0] + found[1] + found[2] == changes & (1 + 2 * many.view(np.int8))
        for row in np.abs(c) > _KNOWN * bounds:
            ordinary &= row
        ordinary &= apart | (changes < 2)
        positive &= ordinary
        cubic = np.flatnonzero(positive)
        value = places.ravel().take(cubic)
        count = c.shape[1]
        second, third = np.searchsorted(cubic, (count, 2 * count))
        cubic[second:third] -= count
        cubic[third:] -= 2 * count
        residual, slope, bend = derivatives(columns(c, cubic), value)
        step = residual / slope
        value -= step
        rest = np.abs(step * (bend / slope))
        blurred = ~(rest < _CLOSE)
        rest *= np.abs(step)
        blurred |= ~(rest <= 2.0 * UNIT * value)
        error = noise(cubic, value) / np.abs(slope)
        error += rest
        error *= 3.1
        error += 4.0 * UNIT * value
        blurred |= ~(error < _SHARP * value)
    if blurred.any():
        ordinary[cubic[blurred]] = False
        kept = np.flatnonzero(ordinary[cubic])
        cubic, value, slope, error = cubic[kept], value[kept], slope[kept], error[kept]
    sign = 1 - 2 * (slope < 0.0).view(np.int8)
    return ~ordinary, Roots(cubic, value, np.zeros(len(cubic), dtype=bool), sign, error, error)


def _closed_form(c: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve cubics in closed form.

    Parameters
    ----------
    c : (4, n) float64, rows c0 to c3 of c0 + c1 x + c2 x^2 + c3 x^3

    Returns
    -------
    roots : (3, n) float64, increasing; only the first is valid if there is one
    many : (n,) bool, True for cubics with three real roots
    apart : (n,) bool, True if the discriminant is surely not zero, so that no roots coincide
    """
    third, b, d = c[2] / c[3], c[1] / c[3], c[0] / c[3]
    third *= 1.0 / 3.0
    b *= 1.0 / 3.0
    d *= 0.5
    square = third * third
    q = square - b
    r = third * (square - 1.5 * b)
    r += d
    discriminant = q * q
    discriminant *= q
    discriminant -= r * r
    size, most = np.abs(b, out=b), np.abs(d, out=d)
    size += square
    most += np.abs(third) * (1.5 * size)
    least = size * size
    least *= size
    least += most * most
    least *= _APART
    apart = np.abs(discriminant) > np.maximum(least, _TINY)
    many = discriminant > 0.0

    return _of_depressed(third, q, r, many), many, apart


def _of_depressed(third: np.ndarray, q: np.ndarray, r: np.ndarray, many: np.ndarray) -> np.ndarray:
    """Solve y^3 - 3 q y + 2 r = 0 and return the roots y - `third` (3, n); overwrites `r`.

    Cubics that are `many` (n,) have three roots; of all others only the first is valid.
    """
    # Functions are taken of ratios alone, so that a change of scale by a power of two changes no bit.
    # Three: with 3 phi the arc cosine of r / q^1.5, -2 sqrt(q) cos(phi) and those a third of a turn to either side;
    # tan(phi / 2) gives cosine and sine at once.
    roots = np.empty((3, len(q)))
    size = np.abs(q)
    scale = np.sqrt(size)
    size *= scale
    ratio = np.divide(r, size, out=r)
    half = np.tan(np.arccos(np.minimum(np.maximum(ratio, -1.0), 1.0)) * (1.0 / 6.0))
    square = half * half
    cosine = 1.0 + square
    np.divide(scale, cosine, out=cosine)
    sine = cosine * half
    cosine *= 1.0 - square
    sine *= 2.0 * 3.0 ** 0.5
    np.subtract(-2.0 * cosine, third, out=roots[0])
    cosine -= third
    np.subtract(cosine, sine, out=roots[1])
    np.add(cosine, sine, out=roots[2])
    # One: with R = |r / q^1.5|, sqrt|q| times the sum of the cube root y of R + sqrt(R^2 - 1) and its inverse; times
    # that of R + sqrt(R^2 + 1) less its inverse where q < 0.
    one = np.copysign(1.0, q)
    y = ratio * ratio
    y -= one
    np.sqrt(y, out=y)
    y += np.abs(ratio)
    np.cbrt(y, out=y)
    y += one / y
    y *= scale
    roots[0] = np.where(many, roots[0], -np.copysign(y, ratio) - third)
    return roots
