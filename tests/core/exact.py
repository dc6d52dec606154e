"""An oracle for projection: the roots of a camera/point cubic in exact integer arithmetic, isolated by Sturm's theorem.

It shares nothing with the code it judges: the cubic is expanded from the determinant, its roots are counted by sign
variations of the Sturm chain and halved down to 2^-180, and weights are evaluated there with integers.
"""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

import numpy as np

_BITS = 180


@dataclass(frozen=True)
class ExactRoot:
    """A root s > 0: its multiplicity, the sign of f', the weights there, whether the triangle is a line (weights None),
    and how far s (relative) and the weights move, per unit of relative error in the three factors of the cubic."""

    distance: float
    multiplicity: int
    sign: int
    weights: tuple[float, float, float] | None
    distance_condition: float
    weight_condition: float


def exact_roots(vertices, rays, point) -> list[ExactRoot] | None:
    """All roots s > 0 of one pair, rising; None where the cubic vanishes identically."""
    (v, p), places = _integers([*np.ravel(vertices)], [*np.ravel(point)])
    (m,), speeds = _integers([*np.ravel(rays)])
    x = [[[v[3 * i + k] - p[k], m[3 * i + k]] for k in range(3)] for i in range(3)]
    f = _dot(x[0], _cross(x[1], x[2]))
    while f and f[-1] == 0:
        f.pop()
    if not f:
        return None
    lowest = next(k for k, c in enumerate(f) if c)
    unit = Fraction(2) ** (speeds - places)
    return [_describe(f, x, t, multiplicity, unit) for t, multiplicity in _roots(f[lowest:])]


def _describe(f, x, t, multiplicity, unit) -> ExactRoot:
    a = [_sum(x[1][k], x[0][k], -1) for k in range(3)]
    b = [_sum(x[2][k], x[0][k], -1) for k in range(3)]
    at = [[_value(poly, t) for poly in vector] for vector in (x[0], a, b)]
    (p, u, v), normal = at, _cross_numbers(at[1], at[2])
    square = _dot_numbers(normal, normal)
    slope = _value([k * c for k, c in enumerate(f)][1:] or [0], t)
    size = [_length([poly[0] for poly in vector]) for vector in (x[0], a, b)]
    speed = [_length([poly[1] for poly in vector]) for vector in (x[0], a, b)]
    reach = [size[k] + t * speed[k] for k in range(3)]
    line = square <= (reach[1] * reach[2]) ** 2 / 2 ** 200
    weights, bend = None, float("inf")
    if not line:
        second = _dot_numbers(_cross_numbers(v, p), normal) / square
        third = _dot_numbers(_cross_numbers(p, u), normal) / square
        weights = (float(1 - second - third), float(second), float(third))
    drift = float("inf")
    if slope and multiplicity == 1:
        drift = abs(float(reach[0] * reach[1] * reach[2] / slope / t))
        if not line:
            step = sum(reach) + sum(speed) * reach[0] * reach[1] * reach[2] / abs(slope)
            bend = float(step * (reach[1] + reach[2])) / float(square) ** 0.5 if square < 1e300 else \
                float(step * (reach[1] + reach[2]) / _root(square))
    sign = 0 if multiplicity > 1 else (slope > 0) - (slope < 0)
    return ExactRoot(float(t * unit), multiplicity, sign, weights, drift, bend)


def _roots(f) -> list[tuple[Fraction, int]]:
    """Positive roots, rising, with multiplicity; f[0] != 0."""
    chain = [f, [k * c for k, c in enumerate(f)][1:]]
    while len(chain[-1]) > 1:
        rest = _remainder(chain[-2], chain[-1])
        if not rest:
            break
        chain.append([-c for c in rest])
    if not chain[-1]:
        return []
    if len(chain[-1]) > 1:
        return _rational_roots(f, chain[-1])
    high = max(abs(c) for c in f).bit_length() - abs(f[-1]).bit_length() + 2
    low = -(max(abs(c) for c in f).bit_length() - abs(f[0]).bit_length() + 2)
    found = []
    pending = [(Fraction(2) ** low, Fraction(2) ** high)]
    while pending:
        a, b = pending.pop()
        inside = _variations(chain, a) - _variations(chain, b)
        if inside == 1 and b <= 2 * a:
            found.append((_halved(f, a, b), 1))
        elif inside:
            if b > 2 * a:
                exponent = (a.numerator.bit_length() - a.denominator.bit_length()
                            + b.numerator.bit_length() - b.denominator.bit_length()) // 2
                middle = Fraction(2) ** exponent
                middle = middle if a < middle < b else (a + b) / 2
            else:
                middle = (a + b) / 2
            pending += [(middle, b), (a, middle)]
    return sorted(found)


def _rational_roots(f, shared) -> list[tuple[Fraction, int]]:
    """Where f and f' share a factor, the cubic's (or quadratic's) roots are all rational."""
    degree = len(f) - 1
    many = len(shared)
    multiple = Fraction(-shared[-2], shared[-1] * (many - 1))
    roots = [(multiple, many)]
    if degree > many:
        roots.append((-Fraction(f[-2], f[-1]) - many * multiple, 1))
    return sorted(root for root in roots if root[0] > 0)


def _halved(f, a: Fraction, b: Fraction) -> Fraction:
    """The root in (a, b], b <= 2 a, to 2^-180."""
    if _value(f, b) == 0:
        return b
    bits = max(a.denominator.bit_length(), b.denominator.bit_length()) - 1 + _BITS
    low, high = a * 2 ** bits, b * 2 ** bits
    low, high = int(low), int(high)
    scaled = [c << (bits * (len(f) - 1 - k)) for k, c in enumerate(f)]
    positive = _integer_value(scaled, high) > 0
    steps = _BITS + 8
    while steps and high - low > 1:
        middle = (low + high) >> 1
        value = _integer_value(scaled, middle)
        if value == 0:
            return Fraction(middle, 1 << bits)
        if (value > 0) == positive:
            high = middle
        else:
            low = middle
        steps -= 1
    return Fraction(low + high, 2 << bits)


def _variations(chain, t: Fraction) -> int:
    signs = [value > 0 for value in (_value(poly, t) for poly in chain) if value]
    return sum(one != other for one, other in zip(signs, signs[1:]))


def _remainder(f, g):
    """Pseudo-remainder of f by g with a positive factor, without its content."""
    f, lead = list(f), g[-1]
    while len(f) >= len(g):
        top, shift = f[-1], len(f) - len(g)
        f = [c * abs(lead) for c in f]
        for k, c in enumerate(g):
            f[k + shift] -= c * top * (1 if lead > 0 else -1)
        while f and f[-1] == 0:
            f.pop()
    return f


def _integers(*groups):
    """The floats of each group times one power of two that makes them all integers, and that power's exponent."""
    ratios = [[float(number).as_integer_ratio() for number in group] for group in groups]
    exponent = max(d.bit_length() - 1 for group in ratios for _, d in group)
    return [[n << (exponent - d.bit_length() + 1) for n, d in group] for group in ratios], exponent


def _integer_value(f, t):
    value = 0
    for c in reversed(f):
        value = value * t + c
    return value


def _value(f, t: Fraction) -> Fraction:
    n, d = t.numerator, t.denominator
    value, power = 0, 1
    for c in reversed(f):
        value, power = value * n + c * power, power * d
    return Fraction(value, power // d)


def _sum(f, g, factor=1):
    length = max(len(f), len(g))
    return [(f[k] if k < len(f) else 0) + factor * (g[k] if k < len(g) else 0) for k in range(length)]


def _product(f, g):
    out = [0] * (len(f) + len(g) - 1)
    for i, c in enumerate(f):
        for k, d in enumerate(g):
            out[i + k] += c * d
    return out


def _cross(a, b):
    return [_sum(_product(a[i], b[k]), _product(a[k], b[i]), -1) for i, k in ((1, 2), (2, 0), (0, 1))]


def _dot(a, b):
    total = [0]
    for f, g in zip(a, b):
        total = _sum(total, _product(f, g))
    return total


def _cross_numbers(a, b):
    return [a[i] * b[k] - a[k] * b[i] for i, k in ((1, 2), (2, 0), (0, 1))]


def _dot_numbers(a, b):
    return sum(x * y for x, y in zip(a, b))


def _root(square: Fraction) -> Fraction:
    """A square root good to a few bits, for condition numbers."""
    exponent = (square.numerator.bit_length() - square.denominator.bit_length()) // 2
    return Fraction(float(square / Fraction(4) ** exponent) ** 0.5) * Fraction(2) ** exponent


def _length(vector) -> Fraction:
    square = Fraction(_dot_numbers(vector, vector))
    return _root(square) if square else Fraction(0)
