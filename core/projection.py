"""Projection: where, and how often, a three-ray camera sees a point."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cubic import UNIT, positive_roots
from .vectors import cross, dot, norm

_CHUNK = 16384
"""Pairs that are worked on at once: their arrays stay in the cache."""

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
    parts = [(np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((3, 0)), np.zeros(0, dtype=np.int8))]
    for start in range(0, count, _CHUNK):
        part = slice(start, start + _CHUNK)
        pair, *rest, degenerate[part] = _project_chunk(vertices[part], rays[part], points[part],
                                                       None if facing is None else facing[part])
        parts.append((pair + start, *rest))
    pair, distance, weights, parity = (np.concatenate(column, axis=-1) for column in zip(*parts))
    return Images(pair, distance, np.ascontiguousarray(weights.T), parity, degenerate)


def _project_chunk(vertices, rays, points, facing):
    """pair, distance, weights (3, m), parity and degenerate of one chunk."""
    count = len(points)
    still, moving, seconds = _scaled(vertices, rays, points)
    coefficients, bounds, lengths = _coefficients(still, moving)
    roots, degenerate = positive_roots(coefficients, bounds, *_reach(still, moving, lengths))

    at, turned = roots.cubic, np.flatnonzero(roots.reversed)
    place, velocity = still.reshape(9, count).take(at, axis=1), moving.reshape(9, count).take(at, axis=1)
    lengths = lengths.take(at, axis=1)
    # The reversed cubic is that of the same triangle with places and velocities exchanged: p + s r = s (r + p / s).
    place[:, turned], velocity[:, turned] = velocity[:, turned], place[:, turned]
    lengths[:3, turned], lengths[3:, turned] = lengths[3:, turned], lengths[:3, turned]
    velocity *= roots.value
    place += velocity
    weights, sure, solid = _weights(place.reshape(3, 3, -1), lengths, roots)

    inside = solid & (weights >= -sure).all(axis=0)
    at, weights = at[inside], np.maximum(weights[:, inside], 0.0)
    weights /= weights[0] + weights[1] + weights[2]
    value = roots.value[inside]
    with np.errstate(divide="ignore"):
        distance = np.where(roots.reversed[inside], 1.0 / value, value) * seconds[at]
    if facing is None:
        e1, e2 = still.reshape(9, count)[3:].take(at, axis=1).reshape(2, 3, -1)
        r, d1, d2 = moving.reshape(9, count).take(at, axis=1).reshape(3, 3, -1)
        facing = dot(3.0 * r + d1 + d2, cross(e1, e2))
    else:
        facing = facing[at]
    parity = np.where(facing < 0, -roots.sign[inside], roots.sign[inside])
    return at, distance, weights, parity, degenerate


def _scaled(vertices, rays, points):
    """Places and velocities (3, 3, n) of A - P, B - A, C - A, in units that make the
    largest place 1 to 2 and the largest velocity 4 to 8, so that most roots are below 1, and the unit of time (n,) that
    goes with them. The units are powers of two: nothing is rounded but the differences."""
    count = len(points)
    v = np.array(vertices.reshape(count, 9).T, order="C").reshape(3, 3, count)
    m = np.array(rays.reshape(count, 9).T, order="C").reshape(3, 3, count)
    v[1:] -= v[0]
    m[1:] -= m[0]
    v[0] -= points.T
    length, speed = _power_of_two(v), _power_of_two(m)
    v *= 1.0 / length
    m *= 4.0 / speed
    return v, m, 4.0 * (length / speed)


def _power_of_two(numbers: np.ndarray) -> np.ndarray:
    """The largest power of two (n,) not above the largest number of each column of (3, 3, n), 1 where that is zero."""
    largest = np.abs(numbers).max(axis=(0, 1))
    power = (largest.view(np.int64) & 0x7FF0000000000000).view(np.float64)
    return np.where(power > 0.0, power, 1.0)


def _coefficients(still, moving):
    """Coefficients (4, n) of f(s) = p(s) . N(s), bounds on their errors, and the lengths (6, n) behind the bounds.

    With p = A - P + s R_A, N = (B - A + s (R_B - R_A)) x (C - A + s (R_C - R_A)), a coefficient is a sum of products of
    three numbers. Each product carries at most 10 roundings: 3 differences, 3 in the cross product and its sum, 1 and 2
    in the dot product, 1 in the last sum. So its error is at most 10 u times the same sum over absolute values, a
    permanent, which is at most 3!/3^(3/2) < 1.155 times the product of the three lengths [1]_: 12 u in all. Where the
    cubic is so small beside the lengths that this could hide it, the sum over absolute values itself is taken.

    References
    ----------
    .. [1] E. Carlen, E. Lieb, M. Loss, "An inequality of Hadamard type for permanents", Methods Appl. Anal. 13, 2006.
    """
    coefficients = np.stack(_expanded(dot, cross, still, moving))
    lengths = np.stack([norm(vector) for vector in (*still, *moving)])
    bounds = np.stack(_expanded(np.multiply, np.multiply, lengths[:3], lengths[3:]))
    bounds *= 12.0 * UNIT
    small = np.flatnonzero((np.abs(coefficients) < 2.0 ** 20 * bounds).all(axis=0))
    if len(small):
        parts = np.abs(still.take(small, axis=2)), np.abs(moving.take(small, axis=2))
        bounds[:, small] = 12.0 * UNIT * np.stack(_expanded(dot, _absolute_cross, *parts))
    return coefficients, bounds, lengths


def _expanded(dot, cross, still, moving):
    """The coefficients of dot(p + s r, cross(a + s u, b + s v)) for any two bilinear products."""
    (p, a, b), (r, u, v) = still, moving
    n0, n1, n2 = cross(a, b), cross(a, v) + cross(u, b), cross(u, v)
    return dot(p, n0), dot(p, n1) + dot(r, n0), dot(p, n2) + dot(r, n1), dot(r, n2)


def _absolute_cross(a, b):
    return np.stack((a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]))


def _reach(still, moving, lengths):
    """The times (n,), (n,) between which an image can lie at all.

    P in the moved triangle is at most as far from the first corner as the further of the others: |p + s r| <= E + s D,
    a quadratic in s. E and D are doubled, for points that rounding moves out of the triangle, and raised by 2^-23 of
    |p| and |r|: squared that is 128 u, more than all the rounding here.
    """
    x, e1, e2, r, d1, d2 = lengths
    e = 2.0 * np.maximum(e1, e2) + 2.0 ** -23 * x
    d = 2.0 * np.maximum(d1, d2) + 2.0 ** -23 * r
    a, b, c = r * r - d * d, dot(still[0], moving[0]) - e * d, x * x - e * e
    discriminant = b * b - a * c
    q = np.sqrt(np.maximum(discriminant, 0.0))
    q = -(b + np.copysign(q, b))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        one, other = q / a, c / q
    # A triangle that grows faster than it leaves (a <= 0) gets no bounds; one that never reaches P an empty interval.
    bounded = a > 0.0
    low = np.where(bounded, np.fmax(np.fmin(one, other), 0.0), 0.0)
    high = np.where(bounded, np.fmax(np.fmax(one, other), 0.0), np.inf)
    never = bounded & (discriminant < 0.0)
    return np.where(never, 1.0, low), np.where(never, 1.0, high)


def _weights(place, lengths, roots):
    """Weights (3, m) of P in the moved triangle, bounds on their errors, and whether the triangle is more than a line.

    p + W_B a + W_C b = 0. Through p, a, b and the products the weight of a corner is off by at most 8 u times the
    lengths that go into them, over the triangle's height at that corner; through the root's error, by the way that P
    moves in that time against the triangle, over the height. Bounds end at 1/2, as far as `_reach` goes.
    """
    p, a, b = place
    x, e1, e2, r, d1, d2 = lengths
    normal = cross(a, b)
    square = dot(normal, normal)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        second, third = dot(cross(b, p), normal) / square, dot(cross(p, a), normal) / square
        area = np.sqrt(square)
        t = roots.value
        long1, long2 = e1 + t * d1, e2 + t * d2
        still, moving = 8.0 * UNIT * (x + t * r + long1 + long2) / area, (r + d1 + d2) / area
        # Off by a whole height: the triangle is a line as far as anyone can know.
        solid = area > 10.0 * UNIT * long1 * long2 + (d1 * long2 + long1 * d2) * roots.error
        solid &= (still + moving * roots.error) * (long1 + long2) < 1.0
        sure = still + moving * roots.spread
        sure = np.minimum(np.stack((long1 + long2, long2, long1)) * sure, 0.5)
    return np.stack((1.0 - second - third, second, third)), sure, solid
