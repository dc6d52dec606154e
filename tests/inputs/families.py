"""Families of camera/point pairs, easy and hard: vertices (n, 3, 3), rays (n, 3, 3) and points (n, 3) of each kind."""
from __future__ import annotations

import zlib

import numpy as np

from tests.inputs import integer_families, mirror_families
from tests.inputs.family_tools import FAMILIES, family, random_pairs, seen, small, some_seen, turned, turns, unit

__all__ = ["FAMILIES", "integer_families", "mirror_families", "pairs_of"]


def pairs_of(name, n=10000):
    """The first n pairs of a family, the same every time."""
    return FAMILIES[name](np.random.default_rng(zlib.crc32(name.encode())), n)


@family("random")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    return v, r, seen(v, r, w, s)


@family("points anywhere")
def _(rng, n):
    return (*rng.normal(size=(2, n, 3, 3)), rng.normal(size=(n, 3)))


@family("nearly planar")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    p, flat = seen(v, r, w, s), small(rng, n, 2, 16)
    for part in (v[..., 2], r[..., 2], p[..., 2]):
        part *= flat.reshape(-1, *[1] * (part.ndim - 1))
    return v, r, p


@family("nearly planar, tilted")
def _(rng, n):
    return turned(turns(rng, n), *FAMILIES["nearly planar"](rng, n))


@family("close to the mirror")
def _(rng, n):
    v, r, w, _ = random_pairs(rng, n)
    return v, r, seen(v, r, w, small(rng, n, 2, 17))


@family("far away")
def _(rng, n):
    v, r, w, _ = random_pairs(rng, n)
    return v, r, seen(v, r, w, 1.0 / small(rng, n, 2, 16))


@family("slivers")
def _(rng, n):
    v, r, _, _ = random_pairs(rng, n)
    along = v[:, 0] + (v[:, 1] - v[:, 0]) * rng.uniform(0, 1, (n, 1))
    v[:, 2] = along + rng.normal(size=(n, 3)) * small(rng, n, 2, 8)[:, None]
    ray = r[:, 0] + (r[:, 1] - r[:, 0]) * rng.uniform(0, 1, (n, 1))
    r[:, 2] = np.where(rng.random((n, 1)) < 0.5, r[:, 2], ray + rng.normal(size=(n, 3)) * small(rng, n, 2, 8)[:, None])
    return v, r, some_seen(rng, v, r)


@family("small triangles")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    size = small(rng, n, 2, 8)[:, None, None]
    v, r = v[:, :1] + v * size, r[:, :1] + r * size
    return v, r, seen(v, r, w, s)


@family("tiny and huge")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    scale, speed = (rng.choice([1e-130, 1e-6, 1e6, 1e130], (n, 1, 1)) for _ in range(2))
    return v * scale, r * speed, seen(v, r, w, s) * scale[:, 0]


@family("far from the origin")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    size = 10.0 ** rng.uniform(-6, 6, n)[:, None, None]
    away = 1e6 * unit(rng.normal(size=(n, 1, 3)))
    return v * size + away, r * size, seen(v, r, w, s) * size[:, 0] + away[:, 0]


@family("nearly parallel rays")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    r = r[:, :1] + small(rng, n, 1, 17)[:, None, None] * r
    return v, r, seen(v, r, w, s)


@family("nearly opposite rays")
def _(rng, n):
    v, r, w, s = random_pairs(rng, n)
    r[:, 1] = -r[:, 0] * 10.0 ** rng.uniform(-1, 1, (n, 1)) + small(rng, n, 1, 17)[:, None] * r[:, 1]
    return v, r, seen(v, r, w, s)


@family("point between two corners")
def _(rng, n):
    """The last family with places and rays exchanged, which turns s to 1 / s: the point almost on a mirror edge."""
    v, r, p = FAMILIES["nearly opposite rays"](rng, n)
    return p[:, None] + r, v - p[:, None], p


@family("nearly coplanar motion")
def _(rng, n):
    """In tilted planes to the rounding of their corners, and up to ten thousand times that off."""
    v, r, w, s = random_pairs(rng, n)
    p = seen(v, r, w, s)
    off = np.where(rng.random(n) < 0.5, 0.0, small(rng, n, 12, 17))
    for part in (v[..., 2], r[..., 2], p[..., 2]):
        part *= off.reshape(-1, *[1] * (part.ndim - 1))
    return turned(turns(rng, n), v, r, p)
