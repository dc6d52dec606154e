"""Numbers of twice the length, and what is built from them, against fractions."""
from fractions import Fraction

import numpy as np
import pytest

from core.solver import cubic
from core.solver import double_double as long
from tests.inputs.families import pairs_of
from tests.oracles.exact_pairs import ExactPairs


def _numbers(rng, n):
    """High and low parts, of many magnitudes and few."""
    return _lengthened(rng, rng.normal(size=n) * 2.0 ** rng.integers(-30, 31, n))


def _lengthened(rng, high):
    n = len(high)
    return high, high * 2.0 ** -53 * rng.uniform(-1.0, 1.0, n) * rng.choice([0.0, 2.0 ** -20, 1.0], n)


def _exact(number):
    return [Fraction(float(high)) + Fraction(float(low)) for high, low in zip(*number)]


@pytest.mark.thorough
def test_sums_and_products():
    rng = np.random.default_rng(1)
    a, b = _numbers(rng, 3000), _numbers(rng, 3000)
    near = -a[0] * (1.0 + rng.integers(-4, 5, 3000) * 2.0 ** -rng.integers(20, 53, 3000).astype(float))
    b = _lengthened(rng, np.where(rng.random(3000) < 0.5, near, b[0]))  # sums that cancel
    for result, exact, size in ((long.add(a, b), lambda x, y: x + y, lambda x, y: abs(x) + abs(y)),
                                (long.subtract(a, b), lambda x, y: x - y, lambda x, y: abs(x) + abs(y)),
                                (long.multiply(a, b), lambda x, y: x * y, lambda x, y: abs(x * y))):
        assert all(abs(found - exact(x, y)) <= Fraction(long.PRECISION) * size(x, y)
                   for found, x, y in zip(_exact(result), _exact(a), _exact(b)))
    difference = long.difference(a[0], b[0])
    assert _exact(difference) == [Fraction(float(x)) - Fraction(float(y)) for x, y in zip(a[0], b[0])]


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["random", "coplanar motion", "nearly planar, tilted", "collision", "cylinder",
                                  "far from the origin", "opposite rays but for rounding", "close to the mirror"])
def test_coefficients_are_within_their_bounds(name):
    vertices, rays, points = pairs_of(name, 150)
    still, moving = cubic.differences(vertices, rays, points)
    length, speed = cubic.scale(still, moving)
    still, moving = still * length, moving * speed
    cubics = cubic.coefficients(still, moving)
    sharp, sharp_bounds = cubic.long_coefficients(vertices, rays, points, length, speed)
    exact = ExactPairs(vertices, rays, points)
    unit = [Fraction(2) ** int(k) * Fraction(float(x)) for k, x in zip(exact._place_power, length)]
    pace = [Fraction(2) ** int(k) * Fraction(float(x)) for k, x in zip(exact._speed_power, speed)]
    true = [[int(c) * x ** (3 - k) * y ** k for c, x, y in zip(row, unit, pace)] for k, row in enumerate(exact.cubic)]
    for found, bounds in ((cubics, cubic.length_bounds(cubic.lengths(still, moving))),
                          (cubics, cubic.term_bounds(still, moving)), (sharp, sharp_bounds)):
        assert all(abs(Fraction(float(x)) - y) <= Fraction(float(bound))
                   for rows in zip(found, bounds, true) for x, bound, y in zip(*rows))
