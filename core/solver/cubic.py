"""The cubic of a three-ray camera and a point: when the moving triangle and the point lie in one plane.

With p, a, b the places of A - P, B - A, C - A at s = 0 and r, u, v their velocities,
f(s) = (p + s r) . ((a + s u) x (b + s v)).
"""
from __future__ import annotations

import numpy as np

from ..geometry import cross, dot
from . import double_double as long
from .rounding import LEAST, UNIT


def differences(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places and velocities (3, 3, n), the vector before the component: p, a, b and r, u, v.

    Taken before anything is multiplied, so that the place of the origin does not matter.
    """
    count = len(points)
    still = np.array(vertices.reshape(count, 9).T, order="C").reshape(3, 3, count)
    moving = np.array(rays.reshape(count, 9).T, order="C").reshape(3, 3, count)
    still[1:] -= still[0]
    moving[1:] -= moving[0]
    still[0] -= points.T
    return still, moving


def scale(still: np.ndarray, moving: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Powers of two (n,), (n,) that bring the largest place to 1 to 2 and the largest velocity to 4 to 8, so that most
    roots are below 1. Times them, nothing is rounded, and numbers of which not even the largest is a normal one leave
    room for products."""
    return 1.0 / _power_of_two(still), 4.0 / _power_of_two(moving)


def _power_of_two(numbers: np.ndarray) -> np.ndarray:
    """The largest power of two (n,) not above the largest number of each column of (3, 3, n), 1 where that is zero,
    but at least `LEAST`, whose inverse is finite."""
    largest = np.abs(numbers).max(axis=(0, 1))
    power = (largest.view(np.int64) & 0x7FF0000000000000).view(np.float64)
    return np.where(largest > 0.0, np.maximum(power, LEAST), 1.0)


def lengths(still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """|p|, |a|, |b|, |r|, |u|, |v|: (6, n)."""
    result = np.empty((6, still.shape[2]))
    for part, vectors in ((result[:3], still), (result[3:], moving)):
        squares = vectors * vectors
        np.add(squares[:, 0], squares[:, 1], out=part)
        part += squares[:, 2]
    return np.sqrt(result, out=result)


def coefficients(still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """Return the coefficients of the cubics f(s) = c0 + c1 s + c2 s^2 + c3 s^3, as rows c0 to c3 (4, n).

    f(s) = (p + s r) . ((a + s u) x (b + s v)). It is zero if the point P lies in the plane of the triangle whose
    corners A, B, C have moved along their rays for the time s.

    Parameters
    ----------
    still : (3, 3, n) float64
        The vectors p = A - P, a = B - A, b = C - A at s = 0, as [vector, component, cubic], from `differences`.
    moving : (3, 3, n) float64
        Their velocities r, u, v: the ray of A, and the differences of the rays of B and C to it.
    """
    return np.stack(_expanded(dot, cross, still, moving))


def length_bounds(size: np.ndarray) -> np.ndarray:
    """Bounds (4, n) on the rounding errors of `coefficients`, from the `lengths`.

    A coefficient is a sum of products of three numbers. Each product carries at most 10 roundings: 3 differences, 3 in
    the cross product and its sum, 1 and 2 in the dot product, 1 in the last sum. So its error is at most 10 u times the
    same sum over absolute values, a permanent, which is at most 3!/3^(3/2) < 1.155 times the product of the three
    lengths [1]_: 12 u in all.

    References
    ----------
    .. [1] E. Carlen, E. Lieb, M. Loss, "An inequality of Hadamard type for permanents", Methods Appl. Anal. 13, 2006.
    """
    bounds = np.stack(_expanded(np.multiply, np.multiply, size[:3], size[3:]))
    bounds *= 12.0 * UNIT
    return bounds


def term_bounds(still: np.ndarray, moving: np.ndarray) -> np.ndarray:
    """The same bounds from the sums over absolute values themselves: dearer, and closer where planes are flat."""
    return 12.0 * UNIT * np.stack(_expanded(dot, _absolute_cross, np.abs(still), np.abs(moving)))


def long_coefficients(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray, length: np.ndarray,
                      speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """c0 to c3 once more with twice the digits, for cubics that drown in rounding, and bounds on their errors.

    The differences, times their `scale`, are exact, and a coefficient is off by at most 10 roundings of a double-double
    number, of its terms.
    """
    vertices, rays, points = (np.moveaxis(given, 0, -1) for given in (vertices, rays, points))
    zero = np.zeros_like(points)
    places = [long.difference(vertices[0], points)] + [long.difference(vertices[k], vertices[0]) for k in (1, 2)]
    velocities = [(rays[0], zero)] + [long.difference(rays[k], rays[0]) for k in (1, 2)]
    scaled = [[[(high[k] * unit, low[k] * unit) for k in range(3)] for high, low in part]
              for part, unit in ((places, length), (velocities, speed))]
    (p, a, b), (r, u, v) = scaled
    n0, n2 = long.cross(a, b), long.cross(u, v)
    n1 = [long.add(one, other) for one, other in zip(long.cross(a, v), long.cross(u, b))]
    found = (long.dot(p, n0), long.add(long.dot(p, n1), long.dot(r, n0)),
             long.add(long.dot(p, n2), long.dot(r, n1)), long.dot(r, n2))
    still, moving = (np.array([[high for high, _ in vector] for vector in part]) for part in scaled)
    terms = term_bounds(still, moving) / (12.0 * UNIT)
    result = np.stack([high for high, _ in found])
    return result, 2.0 * UNIT * np.abs(result) + 10.0 * long.PRECISION * terms


def _expanded(dot, cross, still, moving):
    """The coefficients of dot(p + s r, cross(a + s u, b + s v)) for any two bilinear products."""
    (p, a, b), (r, u, v) = still, moving
    n0, n1, n2 = cross(a, b), cross(a, v), cross(u, v)
    n1 += cross(u, b)
    c1, c2 = dot(p, n1), dot(p, n2)
    c1 += dot(r, n0)
    c2 += dot(r, n1)
    return dot(p, n0), c1, c2, dot(r, n2)


def _absolute_cross(a, b):
    return np.stack((a[1] * b[2] + a[2] * b[1], a[2] * b[0] + a[0] * b[2], a[0] * b[1] + a[1] * b[0]))


def reach(still: np.ndarray, moving: np.ndarray, size: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The times (n,), (n,) between which an image can lie at all.

    P in the moved triangle is at most as far from the first corner as the further of the others: |p + s r| <= E + s D,
    a quadratic in s. E and D are doubled, for points that rounding moves out of the triangle, and raised by 2^-23 of
    |p| and |r|: squared that is 128 u, more than all the rounding here.
    """
    x, e1, e2, r, d1, d2 = size
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
