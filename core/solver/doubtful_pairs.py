"""Images in doubtful pairs: the closest look, with bounds for each pair alone, whatever its cubic."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import cross, dot
from . import cubic
from .monotone_roots import monotone_roots
from .rounding import LEAST, UNIT

_HIDDEN = 2.0 ** 20
"""A coefficient this many times its bound owes none of its size to loose bounds."""

_BLURRED = 2.0 ** 10
"""A coefficient this many times its bound is good to three digits."""

_FURTHEST = 0.5
"""Rounding may not move a weight by more: `cubic.reach` goes no further."""

_ROUGH = 2.0 ** -30
"""A simple root that is off by more than this part of itself is worth twice the digits."""


def doubtful_images(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray):
    """Compute the images in pairs (n) of a camera and a point, with error bounds for each pair alone.

    Quantities that rounding cannot tell apart count as equal.

    Parameters
    ----------
    vertices, rays : of the cameras' corners, pair after pair
    points : of the pairs

    Returns
    -------
    images : as `certain_images` returns them
    degenerate : (n,) bool, True for cubics that rounding cannot tell from zero
    """
    still, moving = cubic.differences(vertices, rays, points)
    length, speed = cubic.scale(still, moving)
    still, moving = still * length, moving * speed
    lengths = cubic.lengths(still, moving)
    cubics, bounds = cubic.coefficients(still, moving), cubic.length_bounds(lengths)
    # Compute tighter, costlier bounds if all coefficients are so small that the bounds from lengths could hide them.
    small = np.flatnonzero((np.abs(cubics) < _HIDDEN * bounds).all(axis=0))
    if len(small):
        bounds[:, small] = cubic.term_bounds(still[:, :, small], moving[:, :, small])
    reach = cubic.reach(still, moving, lengths)

    def sharpen(pairs):
        cubics[:, pairs], long_bounds = cubic.long_coefficients(
            vertices[pairs], rays[pairs], points[pairs], length[pairs], speed[pairs])
        bounds[:, pairs] = np.maximum(long_bounds, LEAST)

    np.maximum(bounds, LEAST, out=bounds)
    drowned = _drowned(np.abs(cubics), bounds)
    if drowned.any():
        sharpen(np.flatnonzero(drowned))
    roots, degenerate = monotone_roots(cubics, bounds, *reach)
    rough = (roots.error > _ROUGH * roots.value) & (roots.sign != 0) & ~drowned[roots.cubic]
    if rough.any():
        pairs = np.unique(roots.cubic[rough])
        sharpen(pairs)
        again, degenerate[pairs] = monotone_roots(cubics[:, pairs], bounds[:, pairs], reach[0][pairs], reach[1][pairs])
        roots = roots.joined((roots.select(~np.isin(roots.cubic, pairs)), replace(again, cubic=pairs[again.cubic])))
    roots = roots.select(~_may_have_met(roots, cubics, bounds))
    with np.errstate(divide="ignore"):
        distance = np.where(roots.reversed, 1.0 / roots.value, roots.value) * (speed / length)[roots.cubic]
    return _images(still, moving, lengths, roots, distance), degenerate


def _drowned(size, bounds):
    """Return True for cubics (n,) that need double-double precision.

    These are cubics that may vanish, cubics with a coefficient that exceeds its bound only a little, and cubics all of
    whose coefficients are small beside the largest bound.

    Parameters
    ----------
    size, bounds : (4, n) float64, absolute coefficients, and bounds on their errors
    """
    known = size > bounds
    small = size.max(axis=0) < _BLURRED * bounds.max(axis=0)
    return small | ~known.any(axis=0) | (known & (size < _BLURRED * bounds)).any(axis=0)


def _may_have_met(roots, cubics, bounds):
    """Return True for imprecise roots beside a coefficient that counts as zero.

    Such a root may coincide with the root that this coefficient would add, at 0 or at infinity.

    Between 0 and a root x of slope f', f rises to |f' x| / 4 or, from a double root at 0, to 4/27 of it: more than its
    bound B if the error 2 B / |f'| is below a quarter of x.
    """
    unsure = (roots.error > 0.25 * roots.value) & (roots.sign != 0)
    at = np.flatnonzero(unsure)
    end = np.where(roots.reversed[at], 3, 0), roots.cubic[at]
    unsure[at] = np.abs(cubics[end]) <= bounds[end]
    return unsure


def _images(still, moving, lengths, roots, distance):
    """Return the images as `certain_images` does: pair, distance, weights, sign and side of each.

    Parameters
    ----------
    still, moving : (3, 3, n) float64, places and velocities of all pairs
    lengths : (6, n) float64, bounds on them
    roots : Roots (m)
    distance : (m,) float64, s at each root
    """
    at, count = roots.cubic, still.shape[2]
    place, velocity = still.reshape(9, count).take(at, axis=1), moving.reshape(9, count).take(at, axis=1)
    # The reversed cubic is that of the same triangle with places and velocities exchanged: p + s r = s (r + p / s).
    turned = np.flatnonzero(roots.reversed)
    place[:, turned], velocity[:, turned] = velocity[:, turned], place[:, turned]
    velocity *= roots.value
    place += velocity
    p, a, b = place.reshape(3, 3, -1)
    normal = cross(a, b)
    square, weights = dot(normal, normal), np.empty((3, len(at)))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        np.divide(dot(cross(b, p), normal), square, out=weights[1])
        np.divide(dot(cross(p, a), normal), square, out=weights[2])
        np.subtract(1.0, weights[1] + weights[2], out=weights[0])
    near = np.flatnonzero(np.minimum(np.minimum(weights[0], weights[1]), weights[2]) >= -_FURTHEST)
    at, roots, weights = at.take(near), roots.select(near), weights.take(near, axis=1)
    lengths, turned = lengths.take(at, axis=1), np.flatnonzero(roots.reversed)
    lengths[:3, turned], lengths[3:, turned] = lengths[3:, turned], lengths[:3, turned]
    inside = np.flatnonzero(_inside(weights, np.sqrt(square.take(near)), lengths, roots))
    at, weights = at.take(inside), np.maximum(weights.take(inside, axis=1), 0.0)
    weights /= weights[0] + weights[1] + weights[2]
    side = dot(3.0 * moving[0] + moving[1] + moving[2], cross(still[1], still[2])).take(at)
    return at, distance.take(near.take(inside)), weights.T, roots.sign.take(inside), side


def _inside(weights, area, lengths, roots):
    """Return True (n,) if the point may lie in the moved triangle within rounding, and the triangle surely has an area.

    The triangle's corners have moved along their rays by s, the root of the cubic. The weight of a corner is off by two
    errors, both over the triangle's height at that corner: that of rounding, at most 8 units of roundoff times the
    lengths involved; and that of s, times the speed of the point against the triangle.

    Parameters
    ----------
    weights : (3, n) float64, barycentric coordinates of the point at the root
    area : (n,) float64, doubled area of the moved triangle
    lengths : (6, n) float64
        Bounds: of the way from the point to the first corner, of two sides, and of what these change by for s = 1.
    roots : with `value`, `error` and `spread`, (n,) each
    """
    x, e1, e2, r, d1, d2 = lengths
    t = roots.value
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        long1, long2 = e1 + t * d1, e2 + t * d2
        both = long1 + long2
        still, moving = 8.0 * UNIT * (x + t * r + both) / area, (r + d1 + d2) / area
        # Off by a whole height: the triangle is a line as far as anyone can know.
        inside = area > 10.0 * UNIT * long1 * long2 + (d1 * long2 + long1 * d2) * roots.error
        inside &= (still + moving * roots.error) * both < 1.0
        height = -(still + moving * roots.spread)
        inside &= weights[0] >= height * both
        inside &= weights[1] >= height * long2
        inside &= weights[2] >= height * long1
    return inside
