"""The exact oracle, against roots known beforehand and against Sturm's theorem in fractions."""
from fractions import Fraction

import numpy as np
import pytest

from tests.inputs.families import pairs_of
from tests.oracles.exact import BITS, integers, positive_roots, to_float
from tests.oracles.exact_pairs import ExactPairs

pytestmark = pytest.mark.thorough


def product(f, g):
    out = [0] * (len(f) + len(g) - 1)
    for i, a in enumerate(f):
        for k, b in enumerate(g):
            out[i + k] += a * b
    return out


def known_cubics(rng, count):
    """Integer cubics with their positive roots and multiplicities, known because they are made of linear factors, or of
    a linear and an irreducible quadratic one."""
    for _ in range(count):
        bits = int(rng.integers(1, 60))
        roots = [Fraction(int(rng.integers(-2**bits, 2**bits)), int(rng.integers(1, 2**bits))) for _ in range(3)]
        kind = rng.integers(0, 7)
        if kind == 1:
            roots[1] = roots[0]
        if kind == 2:
            roots = roots[:1] * 3
        if kind == 3:                                    # two roots closer than any float tells
            roots[1] = roots[0] + Fraction(1, 2 ** int(rng.integers(40, 400)))
        if kind == 4:
            roots = roots[:rng.integers(0, 3)]
        if kind == 5:
            roots[0] = Fraction(0)
        polynomial = [int(rng.integers(1, 9)) * (-1) ** int(rng.integers(0, 2))]
        for root in roots[:1] if kind == 6 else roots:
            polynomial = product(polynomial, [-root.numerator, root.denominator])
        if kind == 6:                                    # (x - a)^2 + b: a complex pair, often close to the axis
            a, b = roots[1], Fraction(1, 2 ** int(rng.integers(0, 200)))
            quadratic = [a * a + b, -2 * a, Fraction(1)]
            scale = int(np.lcm.reduce([q.denominator for q in quadratic], dtype=object))
            polynomial, roots = product(polynomial, [int(q * scale) for q in quadratic]), roots[:1]
        yield polynomial + [0] * (4 - len(polynomial)), [(r, roots.count(r)) for r in sorted(set(roots)) if r > 0]


def test_roots_that_are_known():
    cubics, expected = zip(*known_cubics(np.random.default_rng(1), 4000))
    found = positive_roots(integers(np.array(cubics, dtype=object).T))
    where = np.searchsorted(found.cubic, np.arange(len(cubics) + 1))
    seen = np.zeros(4, dtype=int)
    for k, roots in enumerate(expected):
        mine = slice(where[k], where[k + 1])
        assert found.multiplicity[mine].tolist() == [many for _, many in roots]
        for (root, many), n, shift, slope in zip(roots, found.numerator[mine], found.shift[mine], found.sign[mine]):
            assert abs(n - root * Fraction(2) ** shift) <= 4
            assert n.bit_length() >= BITS
            derivative = sum(i * c * root ** (i - 1) for i, c in enumerate(cubics[k]) if i)
            assert slope == (derivative > 0) - (derivative < 0)
            seen[many] += 1
    assert (seen[1:] > 100).all()


def sturm_count(f):
    """Distinct positive roots, by the sign changes of Sturm's chain at 0 and at infinity."""
    f = [Fraction(c) for c in f]
    while f and f[0] == 0:
        f = f[1:]
    while f and f[-1] == 0:
        f.pop()
    chain = [f, [i * c for i, c in enumerate(f)][1:]]
    while chain[-1]:
        rest, by = list(chain[-2]), chain[-1]
        while len(rest) >= len(by):
            factor, shift = rest[-1] / by[-1], len(rest) - len(by)
            rest = [c - factor * by[i - shift] if i >= shift else c for i, c in enumerate(rest)][:-1]
        while rest and rest[-1] == 0:
            rest.pop()
        chain.append([-c for c in rest])
    count = 0
    for end, factor in ((0, 1), (-1, -1)):
        signs = [p[end] > 0 for p in chain if p and p[end] != 0]
        count += factor * sum(a != b for a, b in zip(signs, signs[1:]))
    return count


@pytest.mark.parametrize("largest", [2, 5, 10 ** 6, 10 ** 40])
def test_as_many_roots_as_sturms_theorem_counts(largest):
    rng = np.random.default_rng(2)
    c = integers([[int(rng.integers(-1000, 1001)) * largest // 1000 for _ in range(3000)] for _ in range(4)])
    found = np.bincount(positive_roots(c.copy()).cubic, minlength=3000)
    assert found.tolist() == [sturm_count(column) if any(column) else 0 for column in c.T]


def determinant(rows):
    (a, b, c), (d, e, f), (g, h, i) = rows
    return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


@pytest.mark.parametrize("name", ["random", "tiny and huge", "far from the origin", "slivers", "small integers"])
def test_pairs_against_fractions(name):
    """Cubic, slope and weights at any time, from their definitions; all floats are taken as they are."""
    vertices, rays, points = pairs_of(name, 60)
    exact, which = ExactPairs(vertices, rays, points), np.arange(60)
    distances = np.random.default_rng(3).uniform(0.01, 8.0, 60) * 2.0 ** exact.time_power
    times = exact.times(which, distances)
    np.testing.assert_array_equal(exact.distances(which, *times), distances)
    given, roots = exact.at(which, *times), exact.roots()
    at = exact.at(roots.cubic, roots.numerator, roots.shift)
    assert len(roots.cubic) > 20 and np.abs(at.value).max() < 2.0 ** -110
    for k in range(60):
        length, time = (Fraction(2) ** int(power[k]) for power in (exact.length_power, exact.time_power))
        v, r, p = ([[Fraction(float(x)) / length for x in row] for row in part]
                   for part in (vertices[k], rays[k], points[k:k + 1]))

        def moved(s, v=v, r=r, p=p):
            return [[v[i][j] + s * r[i][j] - p[0][j] for j in range(3)] for i in range(3)]

        s, h = Fraction(float(distances[k])), time
        before2, before, here, after, after2 = (determinant(moved(s + i * h)) for i in (-2, -1, 0, 1, 2))
        slope = (8 * (after - before) - (after2 - before2)) / (12 * h) * time          # exact for cubics
        assert abs(float(here) * given.still[k] ** 3 - given.value[k]) <= 1e-14 * abs(given.value[k])
        assert abs(float(slope) * given.still[k] ** 2 - given.slope[k]) <= 1e-14 * abs(given.slope[k])
        for n in np.flatnonzero(roots.cubic == k):
            unit = Fraction(2) ** int(exact.time_power[k] - exact._size[k] + exact._speed[k])
            root = Fraction(int(roots.numerator[n])) / Fraction(2) ** int(roots.shift[n]) * unit
            a, b, c = moved(root)
            u, w = ([x - y for x, y in zip(q, a)] for q in (b, c))
            # W_B u + W_C w = -a, by least squares
            uu, uw, ww = (sum(x * y for x, y in zip(q, t)) for q, t in ((u, u), (u, w), (w, w)))
            au, aw = (-sum(x * y for x, y in zip(a, q)) for q in (u, w))
            if (uu * ww - uw * uw) <= Fraction(1, 2 ** 180) * uu * ww:
                assert np.isnan(at.weights[n]).all()
                continue
            second, third = ((au * ww - aw * uw) / (uu * ww - uw * uw), (aw * uu - au * uw) / (uu * ww - uw * uw))
            np.testing.assert_allclose(at.weights[n], [float(1 - second - third), float(second), float(third)],
                                       rtol=1e-13, atol=1e-15)


def test_long_integers_as_floats():
    floats = to_float(integers([3 ** 400, -3 ** 400, 5, 0]), np.full(4, -634))
    np.testing.assert_allclose(floats * 2.0 ** 634, [3.0 ** 400, -3.0 ** 400, 5.0, 0.0], rtol=2.0 ** -50)
