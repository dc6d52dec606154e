"""Positive roots of cubics, against roots known beforehand."""
from fractions import Fraction

import numpy as np
import pytest

from core.solver.monotone_roots import monotone_roots
from core.solver.rounding import UNIT, horner, value_bound
from core.solver.simple_roots import simple_roots
from tests.oracles import exact


def _solve(coefficients, low=0.0, high=np.inf):
    """(roots, signs) of each of the cubics (n, 4), whose coefficients are taken as exact."""
    c = np.array(coefficients, dtype=np.float64).T
    roots, degenerate = monotone_roots(c, np.zeros_like(c), np.full(c.shape[1], low), np.full(c.shape[1], high))
    with np.errstate(divide="ignore"):
        values = np.where(roots.reversed, 1.0 / roots.value, roots.value)
    assert (roots.value >= 0.0).all() and (roots.value[roots.reversed] <= 1.0).all()
    return [(values[roots.cubic == k], roots.sign[roots.cubic == k].tolist()) for k in range(c.shape[1])], degenerate


def _certified(c, bounds):
    return simple_roots(c, bounds, lambda cubic, value: value_bound(c[:, cubic], bounds[:, cubic], value))


def _expanded(lead, *roots):
    return (lead * np.poly(roots))[::-1].tolist() + [0.0] * (3 - len(roots))


@pytest.mark.parametrize("coefficients, expected, signs", [
    (_expanded(1, 1, 2, 4), [1, 2, 4], [1, -1, 1]),
    (_expanded(-8, 0.125, 0.25, 0.5), [0.125, 0.25, 0.5], [-1, 1, -1]),
    (_expanded(1, -1, -1, 3), [3], [1]),                 # a flat mirror: (1 + s)^2 times a linear factor
    (_expanded(1, -1, -1, -1), [], []),
    (_expanded(1, 2, 2, 5), [2, 5], [0, 1]),             # double, then simple
    (_expanded(1, 0.5, 3, 3), [0.5, 3], [1, 0]),
    (_expanded(1, 2, 2, 2), [2], [0]),                   # triple
    (_expanded(1, 0.25, 0.25, 0.25), [0.25], [0]),
    (_expanded(1, 0, 2, 3), [2, 3], [-1, 1]),            # a root at 0 is not positive
    (_expanded(1, 0, 0, 3), [3], [1]),
    (_expanded(1, 0, 0, 0), [], []),
    (_expanded(3, 1, 7), [1, 7], [-1, 1]),               # lower degrees
    (_expanded(3, 7, 7), [7], [0]),
    (_expanded(-2, 5), [5], [-1]),
    ([4, 0, 0, 0], [], []),
    ([0, 0, 0, 0], [], []),
    ([1, 0, 1, 0], [], []),                              # no real roots
    ([-1, 0, 0, 1], [1], [1]),                           # one real root, exactly at the border of the reversed cubic
    ([-8, 0, 0, 1], [2], [1]),
    (_expanded(1, 1, 1, -2), [1], [0]),
    (_expanded(1, 2.0 ** -40, 2.0 ** -20, 2.0 ** 40), [2.0 ** -40, 2.0 ** -20, 2.0 ** 40], [1, -1, 1]),
])
def test_known_roots(coefficients, expected, signs):
    ((roots, found),), degenerate = _solve([coefficients])
    assert found == signs
    # A double root moves by the square root of a rounding, a triple one by its cube root.
    tolerance = [8 * UNIT if sign else 1e-7 if len(expected) > 1 else 1e-4 for sign in signs]
    np.testing.assert_array_less(np.abs(roots - expected), np.multiply(tolerance, np.array(expected)) * 20 + 1e-300)
    assert degenerate[0] == (not any(coefficients))


def test_many_at_once_as_each_alone():
    rng = np.random.default_rng(1)
    c = rng.normal(size=(300, 4)) * 10.0 ** rng.integers(-6, 7, (300, 4))
    together, _ = _solve(c)
    for k in range(300):
        (alone,), _ = _solve(c[k:k + 1])
        np.testing.assert_array_equal(alone[0], together[k][0])
        assert alone[1] == together[k][1]


@pytest.mark.thorough
def test_random_cubics_against_companion_matrices():
    rng = np.random.default_rng(2)
    c = rng.normal(size=(3000, 4)) * 10.0 ** rng.uniform(-2, 2, (3000, 4))
    compared = 0
    for (roots, _), row in zip(_solve(c)[0], c):
        expected = np.roots(row[::-1])
        if np.abs(expected.imag[:, None] * (expected.imag != 0)[:, None]).max(initial=0) and \
                np.abs(expected.imag[expected.imag != 0]).min() < 1e-5 * np.abs(expected).max():
            continue                                     # nearly double: the companion matrix cannot tell
        expected = np.sort(expected.real[(expected.imag == 0) & (expected.real > 0)])
        assert len(roots) == len(expected)
        np.testing.assert_allclose(roots, expected, rtol=1e-9)
        compared += 1
    assert compared > 2900


def test_backward_error_at_close_roots():
    """A root's residual stays at the rounding of the terms, however close the roots lie."""
    rng = np.random.default_rng(3)
    middle, gap = rng.uniform(0.1, 8.0, 2000), 10.0 ** rng.uniform(-14, -1, 2000)
    close = middle * (1.0 + 10.0 ** rng.uniform(-12, 0, 2000))
    other = np.where(rng.random(2000) < 0.5, close, rng.uniform(-5, 5, 2000))
    c = np.array([_expanded(1, a, a * (1 + g), b) for a, g, b in zip(middle, gap, other)])
    found = 0
    for (roots, _), row in zip(_solve(c)[0], c):
        powers = roots[:, None] ** np.arange(4)
        assert (np.abs(powers @ row) <= 32 * UNIT * (powers @ np.abs(row))).all()
        found += len(roots)
    assert found > 2000


def test_noise_at_the_ends_makes_no_roots():
    """Outer coefficients within their bounds: roots near 0 and near infinity are not there."""
    c = np.array([[1e-18, 1.0, -1.0, 1e-18], [-1e-18, 1.0, -1.0, -1e-18], [1e-18, -1e-18, 1e-18, 1e-18]]).T
    roots, degenerate = monotone_roots(c, np.full_like(c, 1e-16), np.zeros(3), np.full(3, np.inf))
    assert sorted(roots.cubic.tolist()) == [0, 1]
    np.testing.assert_allclose(roots.value, 1.0)
    assert degenerate.tolist() == [False, False, True]


def test_only_between_the_given_ends():
    c = [_expanded(1, 1, 2, 4)] * 5
    coefficients = np.array(c).T
    roots, _ = monotone_roots(coefficients, np.zeros((4, 5)), np.array([0, 1.5, 3, 2.5, 5.0]),
                              np.array([1.5, np.inf, 5, 3, 1.0]))
    values = np.where(roots.reversed, 1.0 / roots.value, roots.value)
    order = np.argsort(roots.cubic, kind="stable")
    np.testing.assert_allclose(values[order], [1, 2, 4, 4], rtol=1e-14)
    assert roots.cubic[order].tolist() == [0, 1, 1, 2]


def _ordinary(rng, n):
    """Random cubics, and cubics of random roots, whose sizes differ by some orders of magnitude."""
    c = rng.normal(size=(n, 4)) * 10.0 ** rng.uniform(-3, 3, (n, 4))
    roots = rng.normal(size=(n // 2, 3)) * 10.0 ** rng.uniform(-2, 2, (n // 2, 3))
    c[: n // 2] = [_expanded(*lead, *three) for lead, three in zip(rng.normal(size=(n // 2, 1)), roots)]
    return c


@pytest.mark.thorough
def test_certified_roots_against_exact_arithmetic():
    """The roots of ordinary cubics are all there, none else, and each within its error of the exact one."""
    c = _ordinary(np.random.default_rng(4), 2000)
    uncertain, roots = _certified(c.T, 8.0 * UNIT * np.abs(c.T))
    assert uncertain.mean() < 0.1
    scaled = exact.integers([[Fraction(float(x)) * 2 ** 200 for x in row] for row in c.T])
    count = np.bincount(exact.positive_roots(scaled).cubic, minlength=len(c))
    for k in np.flatnonzero(~uncertain):
        f = [Fraction(float(x)) for x in c[k]]
        mine = np.flatnonzero(roots.cubic == k)
        assert count[k] == len(mine)
        values, errors = roots.value[mine], roots.error[mine]
        assert (errors < 1e-6 * values).all() and (np.diff(values) > 0.0).all()
        for value, error, sign in zip(values, errors, roots.sign[mine]):
            below, above = (horner(f, Fraction(value) + way * Fraction(error)) for way in (-1, 1))
            assert below * above < 0 and (above > 0) == (sign > 0)


@pytest.mark.thorough
def test_certified_roots_are_those_of_monotone_intervals():
    c = _ordinary(np.random.default_rng(5), 20000).T
    bounds = 8.0 * UNIT * np.abs(c)
    uncertain, certified = _certified(c, bounds)
    others, _ = monotone_roots(c, bounds, np.zeros(c.shape[1]), np.full(c.shape[1], np.inf))
    chosen = np.flatnonzero(~uncertain[others.cubic])
    order = np.argsort(certified.cubic, kind="stable")
    np.testing.assert_array_equal(certified.cubic[order], others.cubic[chosen])
    values = np.where(others.reversed, 1.0 / others.value, others.value)[chosen]
    known = certified.error[order] + others.error[chosen] / others.value[chosen] * values
    assert (np.abs(certified.value[order] - values) <= known).all() and np.median(known / values) < 1e-13
    np.testing.assert_array_equal(certified.sign[order], others.sign[chosen])
    assert uncertain.mean() < 0.1


@pytest.mark.parametrize("coefficients", [
    [0, 1, -1, 1], [-2, 1, -1, 0], [1, -2, 1, 1e-17], _expanded(1, 1, 1, 2), _expanded(1, 2, 2, 2), [0, 0, 0, 0],
    [1e-320, -1e-320, 1e-320, -1e-320]])
def test_nothing_else_is_certified(coefficients):
    c = np.array([coefficients], dtype=np.float64).T
    uncertain, roots = _certified(c, np.full_like(c, 64.0 * UNIT))
    assert uncertain.all() and not len(roots.cubic)


def test_none():
    empty = np.zeros((4, 0))
    roots, degenerate = monotone_roots(empty, empty, np.zeros(0), np.zeros(0))
    assert len(roots.cubic) == len(degenerate) == 0
    uncertain, roots = _certified(empty, empty)
    assert len(roots.cubic) == len(uncertain) == 0
