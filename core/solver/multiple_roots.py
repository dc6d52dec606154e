"""Error bounds of roots, and merging of roots that rounding cannot tell apart."""
from __future__ import annotations

import numpy as np

from .roots import Roots
from .rounding import UNIT, derivatives, slope_bound, value_bound


def root_errors(c: np.ndarray, bounds: np.ndarray, x: np.ndarray,
                 sign: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute `Roots.error` and `Roots.spread`; set the `sign` of roots whose slope rounding hides to 0, in place.

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
        error[flat] = shift(c, level[flat], at) + 4.0 * UNIT * at
        spread[flat] = np.fmin(np.sqrt(12.0 * bound / np.abs(2.0 * c[2] + 6.0 * c[3] * at)),
                               np.cbrt(2.0 * bound / np.abs(c[3]))) + error[flat]
    return error, spread


def shift(c: np.ndarray, level: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Bound the displacement (n,) of an extremum at x (n,) due to an error of the slope f' of at most D (`level`).

    It is D / |f''|, or sqrt(D / |3 c3|) if f'' vanishes.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.fmin(level / np.abs(2.0 * c[2] + 6.0 * c[3] * x), np.sqrt(level / np.abs(3.0 * c[3])))


def merged(roots: Roots, slot: np.ndarray, ends: np.ndarray, flat: np.ndarray, c: np.ndarray,
           bounds: np.ndarray) -> Roots:
    """Replace pairs of roots close to both sides of a flat extremum by one double root there; return all roots.

    Near an extremum of curvature f'' a root at the distance d has the slope f'' d and the error 2 B / (f'' d), and the
    extremum is f'' d^2 / 2 high. Flat ones are at most 4 B high: then d is at most 4 times the error. Roots further off
    are there whatever rounding does to the extremum, which is large only because it is far out.

    Parameters
    ----------
    slot : (m,) int64, the interval that each root was found in
    ends : (4, n) float64, of the intervals
    flat : (2, n) bool, whether the extrema may be zero
    c, bounds : (4, n) float64
    """
    k = np.flatnonzero((roots.cubic[1:] == roots.cubic[:-1]) & (slot[1:] == slot[:-1] + 1))
    k = k[flat[slot[k], roots.cubic[k]]]
    if not len(k):
        return roots
    at = ends[slot[k] + 1, roots.cubic[k]]
    near = np.ones(len(k), dtype=bool)
    for j in (k, k + 1):
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            s = np.where(roots.reversed[j], 1.0 / roots.value[j], roots.value[j])
            near &= np.abs(at - s) <= 4.0 * roots.error[j] / roots.value[j] * np.minimum(s, at)
    k, at = k[near], at[near]
    turned = at > 1.0
    x = np.where(turned, 1.0 / at, at)
    c, bounds = c[:, roots.cubic[k]], bounds[:, roots.cubic[k]]
    c[:, turned], bounds[:, turned] = c[::-1, turned], bounds[::-1, turned]
    sign = np.zeros(len(k), dtype=np.int8)
    error, spread = root_errors(c, bounds, x, sign)
    for whole, part in ((roots.value, x), (roots.reversed, turned), (roots.sign, sign), (roots.error, error),
                        (roots.spread, spread)):
        whole[k] = part
    return roots.select(np.delete(np.arange(len(roots.cubic)), k + 1))
