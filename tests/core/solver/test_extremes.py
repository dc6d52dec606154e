"""Projection of numbers at the ends of float64, of all magnitudes at once, and of pairs that rounding once hid."""
import warnings

import numpy as np
import pytest

from core import project
from tests.inputs.families import pairs_of
from tests.inputs.family_tools import random_pairs, seen
from tests.oracles.explained import judge

pytestmark = pytest.mark.slow


def _strictly(*pairs):
    """What `project` finds, which takes all numbers without a word and gives finite ones."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        images = project(*pairs)
    assert np.isfinite(images.distance).all() and (images.distance > 0.0).all()
    assert np.isfinite(images.weights).all() and (images.weights >= 0.0).all()
    return images


@pytest.mark.parametrize("family", ["random", "edges and vertices", "flat mirror", "collision", "nearly opposite rays"])
@pytest.mark.parametrize("length, speed", [(-900, -900), (-600, -600), (-201, 150), (-120, 0), (90, 99), (260, 0),
                                           (0, 400), (990, 990), (-700, 100), (900, 300)])
def test_scale_changes_no_bit(family, length, speed):
    v, r, p = pairs_of(family, 400)
    size = np.frexp(max(np.abs(v).max(), np.abs(p).max()))[1]
    v, r, p = (np.ldexp(part, -size) for part in (v, r, p))
    whole, other = project(v, r, p), _strictly(np.ldexp(v, length), np.ldexp(r, speed), np.ldexp(p, length))
    np.testing.assert_array_equal(whole.pair, other.pair)
    np.testing.assert_array_equal(np.ldexp(whole.distance, length - speed), other.distance)
    for name in ("weights", "parity", "degenerate"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(other, name))


def test_numbers_too_small_to_be_normal():
    """Places and rays of few bits each, down to the smallest numbers that there are."""
    v, r, p = (np.round(part * 16.0) for part in pairs_of("small integers", 500))
    whole, tiny = project(v, r, p), _strictly(*(np.ldexp(part, -1074) for part in (v, r, p)))
    assert len(whole.pair) > 50
    for name in ("pair", "distance", "weights", "parity", "degenerate"):
        np.testing.assert_array_equal(getattr(whole, name), getattr(tiny, name))


def test_distances_that_no_number_can_tell():
    v, r, w, s = random_pairs(np.random.default_rng(1), 200)
    p = seen(v, r, w, s)
    assert len(project(v, r, p).pair) >= 200
    assert len(_strictly(v, np.ldexp(r, -1060), p).pair) == 0
    assert len(_strictly(np.ldexp(v, -1000), np.ldexp(r, 300), np.ldexp(p, -1000)).pair) == 0


def test_largest_and_smallest_numbers_together():
    numbers = np.finfo(np.float64).max * np.array([1.0, -1.0]), [0.0, -0.0, 5e-324, -5e-324, 1.0, 2.0 ** -1022, 1e-300]
    rng = np.random.default_rng(2)
    _strictly(*(rng.choice(np.concatenate(numbers), (3000, *shape)) for shape in ((3, 3), (3, 3), (3,))))
    for most in (100, 300):
        _strictly(*(rng.normal(size=shape) * 10.0 ** rng.uniform(-most, most, shape)
                    for shape in ((3000, 3, 3), (3000, 3, 3), (3000, 3))))


@pytest.mark.parametrize("most", [8, 12, 16, 20])
def test_every_number_of_another_magnitude(most):
    """A root beside a vanishing leading coefficient and no better known than itself may be none."""
    for seed in (9, 24, 37):
        rng = np.random.default_rng(seed)
        assert not judge(*(rng.normal(size=shape) * 10.0 ** rng.uniform(-most, most, shape)
                           for shape in ((1500, 3, 3), (1500, 3, 3), (1500, 3)))).unexplained


@pytest.mark.parametrize("vertices, rays, point, distance, weights", [
    # a double root next to a coefficient that vanishes: a vertex meets another at s = 1
    ([[-1, 0, 0], [-2, 2, 1], [0, 0, -1]], [[-1, -1, 1], [0, -1, 0], [-4, -1, -1]], [-2, 1, 1], 1.0, [0, 1, 0]),
    # a leading coefficient too small to be a normal number
    ([[4, 3, 2], [-3, 3, 2], [1, 4, 4]], [[-5e-324, -4, -1], [0, -4, -1], [0, 0, -1]], [0, 0, 0], 3.46107219,
     [0.01112223, 0.25834167, 0.7305361]),
    # far out, in a triangle that its rays have made long and thin: a small cubic beside its lengths
    ([[0.015625, -48, 16], [-1, 0.5, -8], [0, -0.046875, -0.1875]], [[0.375, 0, 128], [0, 0, -0.25], [0, 0, 0]],
     [0, -0.015625, 0], 1323.36483336, [0.00013985, 0.06940599, 0.93045416]),
    ([[-1, -0.09375, 0.125], [-192, 0, 0], [0.0625, 0, 0]], [[0, 0, -1], [0, 0, 0.125], [0, 0, 0]], [0, 0, 64],
     1573376.0, [0.0, 0.00032541, 0.99967459]),
])
def test_images_once_lost(vertices, rays, point, distance, weights):
    pair = np.array([vertices], float), np.array([rays], float), np.array([point], float)
    images = _strictly(*pair)
    near = np.abs(images.distance / distance - 1.0) < 1e-8
    assert near.sum() == 1
    np.testing.assert_allclose(images.weights[near][0], weights, atol=1e-8)


def test_small_cubic_with_one_coefficient_that_looks_large():
    """Motion that is flat but for one unit of rounding: three roots, two images, on an edge."""
    third = 1.1102230246251565e-16
    pair = (np.array([[[-1.4, -1.4, -0.7], [0.0, -0.7, -1.4], [-1.4, 0.7, 0.7]]]),
            np.array([[[1.05, 0.0, third], [-1.0499999999999998, 0.0, third], [1.05, -2.0999999999999996, third]]]),
            np.array([[-0.7, -1.0499999999999998, -1.0499999999999998]]))
    images = project(*pair)
    assert not judge(*pair).unexplained
    np.testing.assert_allclose(images.distance[:2], [0.1180829, 1.0], rtol=1e-6)
