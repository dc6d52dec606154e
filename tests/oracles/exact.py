"""Positive roots of cubics with integer coefficients, exactly: an oracle for the solver, with which it shares nothing.

All numbers are Python integers, in NumPy arrays of objects, so that one line works on all cubics at once. Descartes'
rule of signs and the discriminant tell how many positive roots there are; between two simple ones lies an extremum,
whose place an integer square root gives to as many bits as it takes for the cubic to have the sign there that it must
have between its roots; Newton's method in a bracket then finds each root to 2^-120, with a change of sign as its
certificate.
"""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

BITS = 120
"""Roots are known to a relative error of 2^-120."""

bit_length = np.frompyfunc(int.bit_length, 1, 1)
square_root = np.frompyfunc(math.isqrt, 1, 1)


@dataclass(frozen=True)
class ExactRoots:
    """Roots `numerator` / 2^`shift` > 0 (to 2^-120), in rising order for each cubic.

    `cubic` (m,) is the cubic of each, `multiplicity` (m,) 1 to 3, and `sign` (m,) the sign of the derivative, 0 where
    the root is multiple.
    """

    cubic: np.ndarray
    numerator: np.ndarray
    shift: np.ndarray
    multiplicity: np.ndarray
    sign: np.ndarray


def integers(values) -> np.ndarray:
    """Python integers, in an array of the same shape."""
    values = np.asarray(values, dtype=object)
    out = np.empty(values.shape, dtype=object)
    out.ravel()[:] = [int(value) for value in values.ravel()]
    return out


def sign(numbers: np.ndarray) -> np.ndarray:
    return (numbers > 0).astype(np.int64) - (numbers < 0).astype(np.int64)


def to_float(numbers: np.ndarray, exponents) -> np.ndarray:
    """numbers * 2^exponents as float64, to a relative error of 2^-52, for numbers of any length."""
    if not numbers.size:
        return np.zeros(numbers.shape)
    excess = np.maximum(bit_length(numbers).astype(np.int64) - 62, 0)
    power = np.clip(np.asarray(exponents, dtype=np.int64) + excess, -4000, 4000)
    with np.errstate(over="ignore", under="ignore"):
        return np.ldexp((numbers >> excess.astype(object)).astype(np.int64).astype(np.float64), power.astype(np.int32))


def positive_roots(c: np.ndarray) -> ExactRoots:
    """Every positive root of c0 + c1 s + c2 s^2 + c3 s^3, of integers (4, n); of those that are all zero, none."""
    cubic = np.flatnonzero((c != 0).any(axis=0))
    c = c[:, cubic]
    for _ in range(3):                                   # roots at 0 are not positive
        at = np.flatnonzero(c[0] == 0)
        c[:, at] = np.roll(c[:, at], -1, axis=0)
    degree = 3 - np.argmax(c[::-1] != 0, axis=0)
    signs = sign(c)
    for k in (1, 2, 3):                                  # a zero takes the sign before it, which changes no count
        signs[k] = np.where(signs[k] == 0, signs[k - 1], signs[k])
    changes = (signs[1:] != signs[:-1]).sum(axis=0)
    parts = []
    for some, roots in ((changes == 1, _only_one), ((changes > 1) & (degree == 2), _of_quadratics),
                        ((changes > 1) & (degree == 3), _of_cubics)):
        some = np.flatnonzero(some)
        if len(some):
            parts += [(some[which], *rest) for which, *rest in roots(c[:, some], changes[some])]
    if not parts:
        none = np.zeros(0, dtype=np.int64)
        return ExactRoots(none, none.astype(object), none.astype(object), none, none)
    which, rank, *rest = (np.concatenate(column) for column in zip(*parts))
    order = np.lexsort((rank, which))
    numerator, shift, multiplicity, slope = (column[order] for column in rest)
    return ExactRoots(cubic[which[order]], numerator, shift, multiplicity.astype(np.int64), slope.astype(np.int64))


def _only_one(c, changes):
    yield _simple(c, np.arange(c.shape[1]), 0, _ends(c, 0), -sign(c[0]))


def _of_quadratics(c, changes):
    """Two changes of sign: both roots are positive, or none is real."""
    discriminant = c[1] * c[1] - 4 * c[0] * c[2]
    yield _rational(np.flatnonzero(discriminant == 0), 0, 2, 0, -c[1], 2 * c[2])
    yield from _separated(c, np.flatnonzero(discriminant > 0),
                          lambda c, bits: [(-c[1] << bits) // (2 * c[2])])


def _of_cubics(c, changes):
    """Two or three changes of sign: as many positive roots, counted with multiplicity, or two less."""
    c0, c1, c2, c3 = c
    a, b, d = c2 * c2 - 3 * c1 * c3, 9 * c0 * c3 - c1 * c2, c1 * c1 - 3 * c0 * c2
    discriminant = 4 * a * d - b * b                     # three times the usual one
    yield _rational(np.flatnonzero((discriminant == 0) & (a == 0)), 0, 3, 0, -c2, 3 * c3)
    # A double root at b / 2a, a > 0, and a simple one; f'' at the double one tells which is the smaller.
    double = (discriminant == 0) & (a != 0)
    later = np.where((3 * b * c3 + 2 * a * c2) * sign(c3) > 0, 1, 0)
    yield _rational(np.flatnonzero(double), later, 2, 0, b, 2 * a)
    yield _rational(np.flatnonzero(double & (changes == 3)), 1 - later, 1, sign(c3),
                    4 * c1 * c2 * c3 - 9 * c0 * c3 * c3 - c2 * c2 * c2, a * c3)
    one = np.flatnonzero((discriminant < 0) & (changes == 3))
    if len(one):
        yield _simple(c[:, one], one, 0, _ends(c[:, one], 0), -sign(c0[one]))

    def extrema(c, bits):
        q = square_root((c[2] * c[2] - 3 * c[1] * c[3]) << 2 * bits) * sign(c[3])
        return [((-c[2] << bits) - q) // (3 * c[3]), ((-c[2] << bits) + q) // (3 * c[3])]

    yield from _separated(c, np.flatnonzero(discriminant > 0), extrema)


def _separated(c, which, extrema):
    """Positive ones of as many simple real roots as the degree, between the extrema, found to as many bits as it takes
    for the cubic to have the signs there that it has between its roots."""
    more = BITS
    while len(which):
        part = c[:, which]
        low, high, bits = _ends(part, more)
        inner = extrema(part, bits)
        outer = sign(part[len(inner) + 1])
        signs = [sign(_values(part, x, bits)) for x in inner]
        expected = [outer * (-1) ** (len(inner) - k) for k in range(len(inner))]
        sure = np.all([one == other for one, other in zip(signs, expected)], axis=0)
        ends, signs = [low], [sign(part[0])]
        for x, level in zip(inner, expected):
            ends.append(np.where(x > low, x, low))
            signs.append(np.where(x > low, level, signs[0]))
        ends.append(high)
        signs.append(outer)
        for rank in range(len(inner) + 1):
            at = np.flatnonzero(sure & (signs[rank] != signs[rank + 1]))
            if len(at):
                bracket = ends[rank][at], ends[rank + 1][at], bits[at]
                yield _simple(part[:, at], which[at], rank, bracket, signs[rank + 1][at])
        which, more = which[~sure], 2 * more


def _ends(c, more):
    """Powers of two below and above all positive roots, over 2^bits; the larger the `more`, the finer."""
    length = bit_length(abs(c)).astype(np.int64)
    longest = length.max(axis=0)
    last = length[3 - np.argmax(c[::-1] != 0, axis=0), np.arange(c.shape[1])]
    low, high = length[0] - longest - 2, longest - last + 2
    bits = (more - low).astype(object)
    return 1 << (bits + low), 1 << (bits + high), bits


def _values(c, x, bits):
    """The cubic at x / 2^bits, times a positive number."""
    return ((c[3] * x + (c[2] << bits)) * x + (c[1] << 2 * bits)) * x + (c[0] << 3 * bits)


def _rational(which, rank, multiplicity, slope, numerator, denominator):
    n, d = abs(numerator[which]), abs(denominator[which])
    shift = BITS + bit_length(d) - bit_length(n)
    rank, slope = (np.broadcast_to(x, numerator.shape)[which] for x in (rank, slope))
    return (which, rank, (n << np.maximum(shift, 0)) // (d << np.maximum(-shift, 0)), shift,
            np.full(len(which), multiplicity), slope)


def _simple(c, which, rank, bracket, rising):
    """The one root in a bracket (low, high, bits), whose ends are over 2^bits, where the cubic changes to the sign
    `rising`."""
    low, high, bits = bracket
    while True:
        wide = np.flatnonzero(high > 2 * low)
        if not len(wide):
            break
        middle = 1 << (bit_length(low[wide]) + bit_length(high[wide]) - 1) // 2
        above = sign(_values(c[:, wide], middle, bits[wide])) == rising[wide]
        high[wide[above]], low[wide[~above]] = middle[above], middle[~above]
    extra = np.maximum(BITS + 1 - bit_length(low), 0)
    low, high, bits = low << extra, high << extra, bits + extra
    root = (low + high) >> 1
    f0, f1, f2, f3 = c[0] << 3 * bits, c[1] << 2 * bits, c[2] << bits, c[3]
    parts = [np.arange(len(root)), root, low, high, rising, f0, f1, f2, f3]
    while len(parts[0]):
        at, x, low, high, side, f0, f1, f2, f3 = parts
        value = ((f3 * x + f2) * x + f1) * x + f0
        slope = (3 * f3 * x + 2 * f2) * x + f1
        _narrow(low, high, x, sign(value) * side)
        new = x - value // np.where(slope == 0, 1, slope)
        close = np.flatnonzero((abs(new - x) <= 1) & (slope != 0))
        for x in (new[close] - 2, new[close] + 2):
            value = ((f3[close] * x + f2[close]) * x + f1[close]) * x + f0[close]
            part_low, part_high = low[close], high[close]
            _narrow(part_low, part_high, x, sign(value) * side[close])
            low[close], high[close] = part_low, part_high
        x = np.where((low < new) & (new < high), new, (low + high) >> 1)
        root[at] = x
        parts = [part[high - low > 4] for part in (at, x, low, high, side, f0, f1, f2, f3)]
    # A root of up to 117 bits is itself among the few numbers left.
    short = root + 4 >> 3 << 3
    root = np.where(_values(c, short, bits) == 0, short, root)
    return which, np.full(len(which), rank), root, bits, np.ones(len(which)), rising


def _narrow(low, high, x, side):
    """Move an end of the bracket to x, by the side of the root on which it lies; both to a root itself."""
    inside = (low <= x) & (x <= high)
    np.copyto(low, x, where=inside & (side <= 0))
    np.copyto(high, x, where=inside & (side >= 0))
