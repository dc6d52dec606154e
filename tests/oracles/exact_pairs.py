"""Pairs of a three-ray camera and a point in exact integer arithmetic: their cubics, and what happens at any time s.

Every float64 is an integer times a power of two. Nothing is rounded until a number is handed out as a float, and then
only that number. Times, lengths and cubics are handed out in units of the pair: powers of two that bring its largest
place and its largest velocity to between 1/2 and 1.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tests.oracles.exact import bit_length, positive_roots, square_root, to_float


@dataclass(frozen=True)
class Moment:
    """What the exact pairs are at given times t, one each. For t > 1 the cubic f(t) and all lengths are those of the
    homogeneous form, f / t^3 and p / t with t rounded to a power of two, so that they stay near 1.

    Attributes
    ----------
    still, moved : (m,)
        a and b with t = b / a: 1 and t for times below 1.
    value, slope, bend, lead : (m,)
        f and its derivatives by b, the second halved, the third over 6.
    product, product_slope : (m,)
        P(t) = (|p| + t|r|) (|e1| + t|d1|) (|e2| + t|d2|), which no coefficient of f exceeds, and its derivative by b.
    area : (m,)
        Twice the moved triangle's.
    weights : (m, 3)
        Of the point in the moved triangle, to 2^-60; nan where it is a line, to 2^-100 of the product of its sides.
    """

    still: np.ndarray
    moved: np.ndarray
    value: np.ndarray
    slope: np.ndarray
    bend: np.ndarray
    lead: np.ndarray
    product: np.ndarray
    product_slope: np.ndarray
    area: np.ndarray
    weights: np.ndarray


class ExactPairs:
    """n cameras (n, 3, 3), (n, 3, 3) and points (n, 3).

    `cubic` (4, n) holds their integer coefficients, `coefficients` (4, n) the same as floats, `products` (4, n) those
    of P, and `lengths` (6, n) those of A - P, B - A, C - A and of their velocities. `facing` (n,) is
    (R_A + R_B + R_C) . N(0), and `facing_size` the product of its lengths. Lengths are in units of 2^`length_power`,
    times of 2^`time_power` (n,). `unit` (n,) is the roundoff of the arithmetic that is to be judged.
    """

    def __init__(self, vertices: np.ndarray, rays: np.ndarray, points: np.ndarray) -> None:
        count = len(points)
        places, self._place_power = _integers(np.concatenate((vertices.reshape(count, 9), points), axis=1))
        speeds, self._speed_power = _integers(rays.reshape(count, 9))
        v, p, m = places[:9].reshape(3, 3, count), places[9:], speeds.reshape(3, 3, count)
        self.still = v[0] - p, v[1] - v[0], v[2] - v[0]
        self.moving = m[0], m[1] - m[0], m[2] - m[0]
        (x, e1, e2), (r, d1, d2) = self.still, self.moving
        n0, n1, n2 = cross(e1, e2), cross(e1, d2) + cross(d1, e2), cross(d1, d2)
        self.cubic = np.stack((dot(x, n0), dot(x, n1) + dot(r, n0), dot(x, n2) + dot(r, n1), dot(r, n2)))
        self._size, self._speed = (bit_length(abs(np.stack(vectors))).max(axis=(0, 1)).astype(np.int64)
                                   for vectors in (self.still, self.moving))
        self.lengths = np.concatenate([np.sqrt((to_float(np.stack(vectors), -unit) ** 2).sum(axis=1)) for vectors, unit
                                       in ((self.still, self._size), (self.moving, self._speed))])
        powers = np.outer([3, 2, 1, 0], self._size) + np.outer([0, 1, 2, 3], self._speed)
        self.coefficients = to_float(self.cubic, -powers)
        x, e1, e2, r, d1, d2 = self.lengths
        self.products = np.stack((x * e1 * e2, r * e1 * e2 + x * d1 * e2 + x * e1 * d2,
                                  x * d1 * d2 + r * e1 * d2 + r * d1 * e2, r * d1 * d2))
        self.length_power = self._place_power + self._size
        self.time_power = self.length_power - self._speed_power - self._speed
        self.unit = np.full(count, 2.0 ** -53)
        middle = 3 * self.moving[0] + self.moving[1] + self.moving[2]
        self.facing = to_float(dot(middle, n0), -2 * self._size - self._speed)
        self.facing_size = np.sqrt((to_float(middle, -self._speed) ** 2).sum(axis=0)) * e1 * e2

    def roots(self):
        """The cubics' exact positive roots, in integers; `at` and `distances` take their numerators and shifts."""
        return positive_roots(self.cubic.copy())

    def distances(self, pair, numerator, shift) -> np.ndarray:
        """Times as the distances s of the given data, rounded."""
        return to_float(numerator, self._place_power[pair] - self._speed_power[pair] - shift.astype(np.int64))

    def times(self, pair, distances):
        """Numerators and shifts of distances s (float64), exactly."""
        mantissa, exponent = np.frexp(distances)
        numerator = (mantissa * 2.0 ** 53).astype(np.int64).astype(object)
        return numerator, 53 - exponent.astype(np.int64) + self._place_power[pair] - self._speed_power[pair]

    def at(self, pair, numerator, shift) -> Moment:
        numerator = numerator << np.maximum(-shift, 0).astype(object)
        shift = np.maximum(shift, 0).astype(np.int64)
        k = shift.astype(object)
        size, speed = self._size[pair], self._speed[pair]
        # t in the pair's unit of time, and the power of two below it where it is above 1
        h = np.maximum(bit_length(numerator).astype(np.int64) - shift + speed - size, 0)
        still, moved = np.ldexp(1.0, -h), to_float(numerator, speed - size - shift - h)
        c0, c1, c2, c3 = self.cubic[:, pair]
        f2 = c2 << k
        value = ((c3 * numerator + f2) * numerator + (c1 << 2 * k)) * numerator + (c0 << 3 * k)
        slope = (3 * c3 * numerator + 2 * f2) * numerator + (c1 << 2 * k)
        base = -(shift + size + h)
        value, slope = to_float(value, 3 * base), to_float(slope, 2 * base - speed)
        bend, lead = to_float(3 * c3 * numerator + f2, base - 2 * speed), to_float(c3, -3 * speed)
        x, u, v = ((s[:, pair] << k) + m[:, pair] * numerator for s, m in zip(self.still, self.moving))
        normal = cross(u, v)
        square = dot(normal, normal)
        area = to_float(square_root(square << 80), 2 * base - 40)
        lengths = self.lengths[:, pair]
        reach = still * lengths[:3] + moved * lengths[3:]
        product = reach.prod(axis=0)
        product_slope = (lengths[3] * reach[1] * reach[2] + reach[0] * lengths[4] * reach[2]
                         + reach[0] * reach[1] * lengths[5])
        line = area <= reach[1] * reach[2] * 2.0 ** -100
        square = np.where(line, 1, square)
        second, third = ((dot(corner, normal) << 64) // square for corner in (cross(v, x), cross(x, u)))
        weights = np.stack([to_float(w, -64) for w in ((1 << 64) - second - third, second, third)], axis=1)
        weights[line] = np.nan
        return Moment(still, moved, value, slope, bend, lead, product, product_slope, area, weights)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return np.stack((a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]))


def _integers(numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Integers (k, n) and powers (n,) with numbers (n, k) = integers * 2^powers, column for row."""
    mantissas, exponents = np.frexp(numbers.T)
    mantissas = (mantissas * 2.0 ** 53).astype(np.int64)
    exponents = np.where(mantissas == 0, 4000, exponents.astype(np.int64) - 53)
    lowest = exponents.min(axis=0)
    return mantissas.astype(object) << np.where(mantissas == 0, 0, exponents - lowest).astype(object), lowest
