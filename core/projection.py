"""Projection: where, and how often, a three-ray camera sees a point."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from . import coplanarity
from .monotone_roots import monotone_roots
from .rounding import UNIT
from .simple_roots import simple_roots
from .vectors import cross, dot

_CHUNK = 8192
"""Pairs that are worked on at once: their arrays stay in the cache."""

_SHORT, _LONG = 2.0 ** -75, 2.0 ** 75
"""Lengths between these, and their ratios, are safe to the twelfth power."""

_HIDDEN = 2.0 ** 20
"""A coefficient this many times its bound owes none of its size to loose bounds."""

_FURTHEST = 0.5
"""Rounding may not move a weight by more: `coplanarity.reach` goes no further."""


@dataclass(frozen=True)
class Images:
    """Images of points in three-ray cameras.

    Attributes
    ----------
    pair : (m,) int64
        Which camera/point pair; sorted, and by rising distance within a pair.
    distance : (m,) float64
        s > 0 in P = Q(W) + s R(W).
    weights : (m, 3) float64
        W >= 0, sum 1.
    parity : (m,) int8
        +1 as a flat mirror shows things, -1 turned over, 0 on a caustic.
    degenerate : (n,) bool
        For each pair, whether its cubic vanishes identically, so that nothing can be said of its images.
    """

    pair: np.ndarray
    distance: np.ndarray
    weights: np.ndarray
    parity: np.ndarray
    degenerate: np.ndarray


def project(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray, *, facing: np.ndarray | None = None) -> Images:
    """Every image of each point in its three-ray camera.

    The camera sees P at the weights W where P = Q(W) + s R(W), s > 0, W >= 0, sum W = 1, with Q(W) = sum W_i V_i and
    R(W) = sum W_i R_i: the triangle whose corners move from V_i along R_i then contains P at the time s, a root of a
    cubic [1]_. There are up to three images. A double root, a point on the caustic, is one image of parity 0. A root at
    which the moved triangle is a line is no image, nor is P on the mirror itself (s = 0). Triangles are closed:
    a point seen along an edge is an image in both triangles that share it. What rounding cannot decide counts as
    equal: double roots, points on the mirror and on edges, and vanishing cubics are told by bounds on the rounding
    errors of the float64 arithmetic on the given numbers, however far from the origin they lie.

    The parity is the sign of the cubic's derivative, R(W) . N(s) with N the moved triangle's normal by its winding,
    times the sign of that normal on the side to which the mirror reflects: that of (R_A + R_B + R_C) . N(0), or
    `facing`. Both change with the winding, so the product does not; the second is one for all images of a camera, so
    within a camera the parity changes only across a caustic. It is the wrong one where shading normals bend the middle
    ray under the flat triangle; a caller who knows where the eye is gives `facing`.

    Parameters
    ----------
    vertices, rays : (n, 3, 3) float64
        Corners V_A, V_B, V_C of each camera's mirror triangle, and their rays R_A, R_B, R_C, not normalised.
    points : (n, 3) float64
        In the same space and units as the vertices.
    facing : (n,), optional
        Positive where the eye sees the corners A, B, C counter-clockwise, negative where clockwise.

    Returns
    -------
    Images

    Raises
    ------
    ValueError
        Where shapes do not fit, or a number is not finite.

    References
    ----------
    .. [1] C. Mei, V. Popescu, E. Sacks, "A Hybrid Backward-Forward Method for Interactive Reflections", GRAPP 2007.
    """
    vertices, rays, points = (np.asarray(given, dtype=np.float64) for given in (vertices, rays, points))
    count = len(points)
    if points.shape != (count, 3) or vertices.shape != (count, 3, 3) or rays.shape != (count, 3, 3):
        raise ValueError("project needs vertices (n, 3, 3), rays (n, 3, 3) and points (n, 3) of the same n.")
    if not all(np.isfinite(given).all() for given in (vertices, rays, points)):
        raise ValueError("Vertices, rays and points must be finite numbers; repair or leave out the others.")
    if facing is not None:
        facing = np.asarray(facing)
        if facing.shape != (count,):
            raise ValueError("project needs one facing sign for each pair.")
    degenerate = np.zeros(count, dtype=bool)
    facing = None if facing is None else np.where(facing < 0, -1.0, 1.0)
    found, hard = [], []
    for start in range(0, max(count, 1), _CHUNK):
        part = slice(start, start + _CHUNK)
        images, uncertain = _ordinary_chunk(vertices[part], rays[part], points[part])
        found.append(_turned(images, start, facing))
        hard.append(np.flatnonzero(uncertain) + start)
    hard = np.concatenate(hard)
    for start in range(0, len(hard), _CHUNK):
        part = hard[start:start + _CHUNK]
        images, degenerate[part] = _hard_chunk(vertices[part], rays[part], points[part])
        found.append(_turned(images, part, facing))
    pair, distance, weights, parity = (np.concatenate(column, axis=-1) for column in zip(*found))
    # stable, since the images of one pair already come by rising distance
    order = np.argsort(pair, kind="stable")
    return Images(pair[order], distance[order], weights.T[order], parity[order], degenerate)


def _turned(images, pairs, facing):
    """Images of a chunk with their pairs (the first pair, or all), and with the parity that `facing` tells."""
    at, distance, weights, parity, side = images
    pair = at + pairs if isinstance(pairs, int) else pairs[at]
    side = side if facing is None else facing[pair]
    return pair, distance, weights, np.where(side < 0.0, -parity, parity)


def _ordinary_chunk(vertices, rays, points):
    """Images in the pairs of a chunk whose cubic has certain roots, and which pairs have none such."""
    with np.errstate(over="ignore", invalid="ignore"):
        still, moving = coplanarity.differences(vertices, rays, points)
        lengths = coplanarity.lengths(still, moving)
        uncertain, roots = simple_roots(coplanarity.coefficients(still, moving), coplanarity.length_bounds(lengths))
    # beyond these, powers of lengths may overflow, or lose digits unseen
    strange = (lengths.min(axis=0) < _SHORT) | (lengths.max(axis=0) > _LONG)
    if strange.any():
        uncertain |= strange
        roots = roots.select(np.flatnonzero(~strange[roots.cubic]))
    return _images(still, moving, lengths, roots, roots.value), uncertain


def _hard_chunk(vertices, rays, points):
    """Images in pairs whatever their cubic, and which of them have none because it vanishes."""
    still, moving = coplanarity.differences(vertices, rays, points)
    length, speed = coplanarity.scale(still, moving)
    still, moving = still * length, moving * speed
    lengths = coplanarity.lengths(still, moving)
    cubics, bounds = coplanarity.coefficients(still, moving), coplanarity.length_bounds(lengths)
    # Where the cubic is so small beside the lengths that their bounds could hide it, closer ones are worth their price.
    small = np.flatnonzero((np.abs(cubics) < _HIDDEN * bounds).all(axis=0))
    if len(small):
        bounds[:, small] = coplanarity.term_bounds(still[:, :, small], moving[:, :, small])
        small = small[(np.abs(cubics[:, small]) <= bounds[:, small]).all(axis=0)]
    if len(small):
        part = (vertices[small] * length[small, None, None], rays[small] * speed[small, None, None],
                points[small] * length[small, None])
        cubics[:, small], bounds[:, small] = coplanarity.long_coefficients(*part)
    roots, degenerate = monotone_roots(cubics, bounds, *coplanarity.reach(still, moving, lengths))
    with np.errstate(divide="ignore"):
        distance = np.where(roots.reversed, 1.0 / roots.value, roots.value) * (speed / length)[roots.cubic]
    return _images(still, moving, lengths, roots, distance), degenerate


def _images(still, moving, lengths, roots, distance):
    """Pair, distance, weights (3, m), parity by the triangle's winding, and that of its side that the rays leave."""
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
    np.subtract(1.0, weights[1], out=weights[0])
    weights[0] -= weights[2]
    near = np.flatnonzero((weights >= -_FURTHEST).all(axis=0))
    at, roots, weights = at.take(near), roots.select(near), weights.take(near, axis=1)
    lengths, turned = lengths.take(at, axis=1), np.flatnonzero(roots.reversed)
    lengths[:3, turned], lengths[3:, turned] = lengths[3:, turned], lengths[:3, turned]
    inside = np.flatnonzero(_inside(weights, np.sqrt(square.take(near)), lengths, roots))
    at, weights = at.take(inside), np.maximum(weights.take(inside, axis=1), 0.0)
    weights /= weights[0] + weights[1] + weights[2]
    side = dot(3.0 * moving[0] + moving[1] + moving[2], cross(still[1], still[2])).take(at)
    return at, distance.take(near.take(inside)), weights, roots.sign.take(inside), side


def _inside(weights, area, lengths, roots):
    """Whether P may lie in the moved triangle as far as rounding goes, and the triangle surely is more than a line.

    p + W_B a + W_C b = 0. Through p, a, b and the products the weight of a corner is off by at most 8 u times the
    lengths that go into them, over the triangle's height at that corner; through the root's error, by the way that P
    moves in that time against the triangle, over the height.
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
