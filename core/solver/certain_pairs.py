"""Images in ordinary pairs: those about which rough bounds leave no doubt.

Most pairs are far from every limit: the signs that decide anything are far above the rounding that the largest
coordinates alone allow. (Such tests are called floating-point filters in computational geometry.) The first bounds are
those of the largest coordinates of all pairs together, which cost next to nothing; pairs that they leave open get
their own, and what is still doubtful is left to the closer look of `doubtful_pairs`. What the first bounds decide, the
second would decide alike: nothing that is told of one pair depends on the others.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import columns, cross, dot
from . import cubic
from .rounding import UNIT
from .simple_roots import simple_roots

_LONGEST, _UNLIKE = 2.0 ** 100, 2.0 ** 100
"""Places and velocities whose longest is between the inverse of this and this, and at most so many times as long as
the shortest, neither overflow nor lose digits when four are multiplied."""

_COMMON = 2.0 ** 35
"""Common lengths between the inverse of this and this: a pair whose coefficients stand out of the noise of these has
lengths of its own within the wider limits above."""

_ROUND = 3.0 ** 0.5 + 2.0 ** -50
"""A vector is at most this many times as long as its largest coordinate."""


@np.errstate(over="ignore", invalid="ignore", divide="ignore")
def certain_images(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray,
                   lengths_of: Callable[[np.ndarray, np.ndarray], np.ndarray]):
    """Compute the images in pairs (n) of a camera and a point, except in pairs that rounding leaves in doubt.

    Parameters
    ----------
    vertices, rays : (n, 3, 3) float64
    points : (n, 3) float64
    lengths_of : function of places and velocities, `common_lengths` or `own_lengths`

    Returns
    -------
    pair : (m,) int64, of each image, in no order, but rising in distance for each pair
    distance : (m,) float64
    weights : (m, 3) float64
    sign : (m,) int8, of the cubic's derivative
    side : (m,) float64, positive where the rays leave on the side of the triangle's normal by its winding
    doubtful : (n,) bool, True for pairs that were left out
    """
    still, moving = cubic.differences(vertices, rays, points)
    lengths = lengths_of(still, moving)
    x, e, r, d = lengths
    ee, ed, dd = e * e, e * d, d * d

    def own(pair):
        return lengths if lengths.shape[1] == 1 else columns(lengths, pair)

    def noise(pair, t):
        """The sum of the bounds times powers of t, and as much again for the roundings of the sum: 6 u |c|."""
        x, e, r, d = own(pair)
        edge = e + t * d
        edge *= edge
        edge *= x + t * r
        edge *= 24.0 * UNIT
        return edge

    bounds = np.stack((x * ee, 2.0 * x * ed + r * ee, x * dd + 2.0 * r * ed, r * dd))
    bounds *= 12.0 * UNIT
    doubtful, roots = simple_roots(cubic.coefficients(still, moving), bounds, noise)
    pair, t = roots.cubic, roots.value
    place, velocity = (columns(part.reshape(9, -1), pair) for part in (still, moving))
    velocity *= t
    place += velocity
    p, a, b = place.reshape(3, 3, -1)
    normal = cross(a, b)
    square = dot(normal, normal)
    second, third = dot(cross(b, p), normal), dot(cross(p, a), normal)
    # All three weights are off by less than this, times the square: see `doubtful_pairs`.
    margin = _margin(own(pair), t, roots.error)
    margin *= np.sqrt(square)
    least = np.minimum(second, third)
    np.minimum(least, square - second - third, out=least)
    inside = least > margin
    open_ = ~inside
    open_ &= ~((least < -margin) & (margin < square))
    if open_.any():
        doubtful[pair[open_]] = True
        inside &= ~doubtful[pair]
    kept = np.flatnonzero(inside)
    pair = pair.take(kept)
    weights = np.empty((len(kept), 3))
    square = square.take(kept)
    np.divide(second.take(kept), square, out=weights[:, 1])
    np.divide(third.take(kept), square, out=weights[:, 2])
    weights[:, 0] = 1.0 - weights[:, 1] - weights[:, 2]
    side = dot(3.0 * moving[0] + moving[1] + moving[2], cross(still[1], still[2])).take(pair)
    return pair, t.take(kept), weights, roots.sign.take(kept), side, doubtful


def _margin(lengths: np.ndarray, t: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Bound the error of all three weights at the root t (n,), times the length of the normal.

    Parameters
    ----------
    lengths : (4, n) float64, as from `own_lengths`
    error : (n,) float64, bound on the error of t
    """
    x, e, r, d = lengths
    both = t * d
    both += e
    both *= 2.0
    margin = t * r
    margin += x
    margin += both
    margin *= 8.0 * UNIT
    margin += error * (r + 2.0 * d)
    margin *= both
    return margin


def own_lengths(still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """Bound (4, n) |p|, |a| and |b|, |r|, |u| and |v| by their largest coordinates; NaN for pairs outside the limits.

    `still` and `moving` (3, 3, n) are p, a, b and r, u, v, as from `cubic.differences`.
    """
    lengths = np.empty((4, still.shape[2]))
    for (first, edges), part in zip((lengths[:2], lengths[2:]), (np.abs(still), np.abs(moving))):
        part[0].max(axis=0, out=first)
        part[1:].max(axis=(0, 1), out=edges)
    lengths *= _ROUND
    # NaN leaves a pair in doubt, since all comparisons with it are false
    lengths[:, ~(_ordinary(*lengths[:2]) & _ordinary(*lengths[2:]))] = np.nan
    return lengths


def _ordinary(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return True where two lengths (n,), of places or of velocities, are in range and of similar size."""
    longest, shortest = np.maximum(one, other), np.minimum(one, other)
    return (longest >= 1.0 / _LONGEST) & (longest <= _LONGEST) & (longest <= _UNLIKE * shortest)


def common_lengths(still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """Bound the lengths of all pairs together (4, 1), as `own_lengths`; NaN unless well inside the limits."""
    parts = (still[0], still[1:], moving[0], moving[1:])
    lengths = np.array([[max(part.max(), -part.min())] for part in parts]) if still.size else np.ones((4, 1))
    lengths *= _ROUND
    return lengths if (lengths >= 1.0 / _COMMON).all() and (lengths <= _COMMON).all() else np.full((4, 1), np.nan)
