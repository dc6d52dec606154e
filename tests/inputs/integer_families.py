"""Families of camera/point pairs that are built from integers or a few digits: the hard case is there exactly."""
from __future__ import annotations

import numpy as np

from tests.inputs.family_tools import FAMILIES, family, random_pairs, seen, small


def sheared(rng, vertices, rays, points):
    """The same pairs of integers under integer maps of determinant 1 and shifts, still exact."""
    n = len(points)
    lower, upper = np.tile(np.eye(3, dtype=int), (2, n, 1, 1))
    for i, k in ((1, 0), (2, 0), (2, 1)):
        lower[:, i, k], upper[:, k, i] = rng.integers(-2, 3, (2, n))
    turn, shift = np.swapaxes(lower @ upper, 1, 2), rng.integers(-50, 51, (n, 1, 3))
    return tuple(map(np.float64, (vertices @ turn + shift, rays @ turn, (points[:, None] @ turn + shift)[:, 0])))


@family("small integers")
def _(rng, n):
    return tuple(np.round(2.0 * rng.normal(size=(n, *shape))) for shape in ((3, 3), (3, 3), (3,)))


@family("flat mirror, exact")
def _(rng, n):
    """A double root at -1, to the last bit."""
    v, eye = rng.integers(-64, 65, (n, 3, 3)), rng.integers(-64, 65, (n, 1, 3))
    v[..., 2], eye[..., 2] = 0, rng.integers(1, 65, (n, 1))
    r = (v - eye) * [1, 1, -1]
    p = v[:, 0] + 2 * (r[:, 0] + r[:, 1] + 2 * r[:, 2]) + rng.integers(-9, 10, (n, 3))
    return sheared(rng, v, r, p)


def folds(rng, n):
    """Points exactly on the caustic, with the weights and distance of their image: at s0 the moved triangle holds the
    origin, and the ray there lies in its plane."""
    w = rng.integers(1, 6, (n, 3))
    w[:, 2] = 1
    a, b = rng.integers(-9, 10, (2, n, 3))
    ra, rb = rng.integers(-5, 6, (2, n, 3))
    ka, kb = rng.integers(-3, 4, (2, n, 1))
    c, rc = -w[:, :1] * a - w[:, 1:2] * b, ka * a + kb * b - w[:, :1] * ra - w[:, 1:2] * rb
    s = rng.choice([1, 2, 4], n)
    moved, rays = np.stack((a, b, c), axis=1), np.stack((ra, rb, rc), axis=1)
    pairs = sheared(rng, moved - s[:, None, None] * rays, rays, np.zeros((n, 3), dtype=int))
    return *pairs, w / w.sum(axis=1, keepdims=True), s


def cusps(rng, n):
    """Points exactly at a cusp of the caustic, likewise: with edges a, b of the moved triangle at s0 and velocities u,
    v of these, the ray is k a + b, and v + k u lies in the plane of a and b, so that f = det(k a + b, u, v) (s - s0)^3.
    """
    a, b, u = 4 * rng.integers(-9, 10, (3, n, 3))
    k, i, j = rng.integers(-3, 4, (3, n, 1))
    v = -k * u + i * a + j * b
    w = rng.integers(0, 5, (n, 3))[:, 1:] / 4
    w = np.where((w.sum(axis=1) > 1)[:, None], 1.0 - w, w)
    p, ray = -w[:, :1] * a - w[:, 1:] * b, k * a + b - w[:, :1] * u - w[:, 1:] * v
    s = rng.choice([1, 2, 4], n)
    moved, rays = np.stack((p, p + a, p + b), axis=1), np.stack((ray, ray + u, ray + v), axis=1)
    pairs = sheared(rng, moved - s[:, None, None] * rays, rays, np.zeros((n, 3), dtype=int))
    return *pairs, np.concatenate((1.0 - w.sum(axis=1, keepdims=True), w), axis=1), s


@family("double roots")
def _(rng, n):
    v, r, p, *_ = folds(rng, n)
    scale = rng.choice([2.0 ** -30, 1.0, 2.0 ** 20], n)
    return v * scale[:, None, None], r, p * scale[:, None]


@family("triple roots")
def _(rng, n):
    v, r, p, *_ = cusps(rng, n)
    scale = rng.choice([2.0 ** -30, 1.0, 2.0 ** 20], n)
    return v * scale[:, None, None], r, p * scale[:, None]


@family("near the caustic")
def _(rng, n):
    v, r, p, *_ = (part[:n] for part in map(np.concatenate, zip(folds(rng, n - n // 2), cusps(rng, n // 2))))
    return v, r, p + small(rng, n, 1, 16)[:, None] * rng.normal(size=(n, 3))


KINDS = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.25, 0.75], [0.75, 0, 0.25]])
"""Weights on a triangle's corners and edges."""


@family("edges and vertices")
def _(rng, n):
    """Exactly there, also far from the origin."""
    v, r = rng.integers(-64, 65, (2, n, 3, 3)).astype(float)
    p = seen(v, r, KINDS[rng.integers(0, 6, n)], rng.choice([0.5, 1.0, 2.0, 4.0], n))
    offset = rng.choice([0.0, 1e6, 2.0 ** 40], n)
    return v + offset[:, None, None], r, p + offset[:, None]


@family("next to edges")
def _(rng, n):
    v, r, _, s = random_pairs(rng, n)
    return v, r, seen(v, r, KINDS[rng.integers(0, 6, n)] + small(rng, n, 8, 17)[:, None] * rng.normal(size=(n, 3)), s)


@family("on the mirror")
def _(rng, n):
    v, r = rng.integers(-64, 65, (2, n, 3, 3)).astype(float)
    weights = np.concatenate((KINDS, [[0.25, 0.25, 0.5]]))[rng.integers(0, 7, n)]
    return v, r, seen(v, r, weights, np.zeros(n))


@family("opposite rays but for rounding")
def _(rng, n):
    """Leading coefficients just above their rounding: roots far out, and others near 1 that those must not hide."""
    v, r, p = (rng.integers(-3, 4, (n, *shape)).astype(float) for shape in ((3, 3), (3, 3), (3,)))
    r[:, 1] = -r[:, 0]
    r[:, 1, 2] += rng.choice([1.0, -1.0], n) * 2.0 ** -rng.integers(38, 52, n)
    return v, r, p


@family("point on a mirror edge but for rounding")
def _(rng, n):
    """The same with places and rays exchanged, which turns s to 1 / s."""
    v, r, _ = FAMILIES["opposite rays but for rounding"](rng, n)
    return r, v, np.zeros((n, 3))


@family("rays through a line")
def _(rng, n):
    """Or all through one point of it, where the moved triangle is a line or a point and f vanishes for all: at s = 1,
    1/3 or 1/7."""
    v, focus = rng.integers(-20, 21, (n, 3, 3)).astype(float), rng.integers(-20, 21, (n, 1, 3)).astype(float)
    rays = (focus - v) * np.where(rng.random((n, 1, 1)) < 0.5, [1.0, 1.0, 0.0], 1.0) * rng.choice([1, 3, 7], (n, 1, 1))
    along = rng.integers(-20, 21, (n, 1)) * np.array([0.0, 0.0, 1.0])
    off = np.where(rng.random((n, 1)) < 0.5, rng.integers(-3, 4, (n, 3)), 0)
    return v, rays, focus[:, 0] + along + off


@family("coplanar motion")
def _(rng, n):
    """Identically zero, in planes of integers; one unit off the plane in one of five."""
    v, r, p = (rng.integers(-64, 65, (n, *shape)) for shape in ((3, 3), (3, 3), (3,)))
    v[..., 2] = r[..., 2] = p[..., 2] = 0
    p[::5, 2] = 1
    return sheared(rng, v, r, p)


@family("collision")
def _(rng, n):
    """Like the vertex-face queries of continuous collision detection: boxes of few distinct coordinates, some a few
    units of rounding off, that mostly move without turning; seen from the vertex. After the looks of the collection
    that goes with B. Wang et al., "A Large Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision
    Detection", ACM Trans. Graph. 40 (5), 2021."""
    levels = np.array([1 / 6, 1 / 3, 5 / 12, 0.41666, 0.75, 0.5, 0.0, -1 / 12, 0.55277, 0.2, 1.0, -1 / 3])

    def coordinates(*shape):
        chosen = levels[rng.integers(0, len(levels), shape)]
        return np.where(rng.random(shape) < 0.1, chosen * (1.0 + rng.integers(-3, 4, shape) * 2.0 ** -52), chosen)

    box = coordinates(n, 2, 3)
    face = np.take_along_axis(box, rng.integers(0, 2, (n, 3, 3)), axis=1)
    p = np.where(rng.random((n, 3)) < 0.3, box[:, 0], coordinates(n, 3))
    push = coordinates(n, 3) - coordinates(n, 3)
    push[rng.random((n, 3)) < 0.3] = 0.0
    rigid = np.repeat(push[:, None], 3, axis=1)
    turning = (coordinates(n, 3, 3) - face) - push[:, None]
    kind = rng.random(n)[:, None, None]
    return face, np.where(kind < 0.7, rigid, np.where(kind < 0.85, turning, rigid + 0.1 * turning)), p
