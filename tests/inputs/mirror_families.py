"""Families of camera/point pairs with rays that a mirror really reflects, from an eye."""
from __future__ import annotations

import numpy as np

from tests.inputs.family_tools import family, flat_triangles, mirrored, seen, small, some_seen, turned, turns, unit


@family("nearly flat mirror")
def _(rng, n):
    v, bent = flat_triangles(rng, n), small(rng, n, 2, 16)[:, None, None]
    normals, eye = unit([0.0, 0.0, 1.0] + bent * rng.normal(size=(n, 3, 3))), rng.normal(size=(n, 1, 3)) + [0, 0, 4]
    v, normals, eye = turned(turns(rng, n), v, normals, eye)
    r = mirrored(v, normals, eye)
    return v, r, some_seen(rng, v, r)


@family("flat mirror")
def _(rng, n):
    v, eye, turn = flat_triangles(rng, n), rng.normal(size=(n, 1, 3)) + [0, 0, 4], turns(rng, n)
    v, eye = turned(turn, v, eye)
    r = mirrored(v, np.repeat(turn[:, None, :, 2], 3, axis=1), eye)
    return v, r, some_seen(rng, v, r)


@family("cylinder")
def _(rng, n):
    """Two corners on a generator share their normal; under a constant direction also their ray, so c3 = 0."""
    angle, height = rng.uniform(-0.5, 0.5, (n, 3)), rng.normal(size=(n, 3))
    angle[:, 1] = angle[:, 0]
    normals = np.stack((np.sin(angle), np.zeros((n, 3)), np.cos(angle)), axis=2)
    v = normals + height[..., None] * [0.0, 1.0, 0.0]
    eye = np.where(rng.random((n, 1, 1)) < 0.5, 1.0, 1e6) * (rng.normal(size=(n, 1, 3)) + [0.0, 0.0, 5.0])
    r = mirrored(v, normals, eye)
    constant = rng.random(n) < 0.5
    d = np.broadcast_to(unit(-eye), v.shape)
    r[constant] = (d - 2.0 * (d * normals).sum(axis=-1, keepdims=True) * normals)[constant]
    v, r = turned(np.where((rng.random(n) < 0.5)[:, None, None], np.eye(3), turns(rng, n)), v, r)
    return v, r, some_seen(rng, v, r)


@family("grazing eye")
def _(rng, n):
    v, bent = flat_triangles(rng, n), small(rng, n, 1, 8)[:, None, None]
    normals = unit([0.0, 0.0, 1.0] + bent * rng.normal(size=(n, 3, 3)))
    eye = 10.0 * unit(rng.normal(size=(n, 1, 3)) * [1, 1, 0]) + small(rng, n, 0, 14)[:, None, None] * [0, 0, 1]
    v, normals, eye = turned(turns(rng, n), v, normals, eye)
    r = mirrored(v, normals, eye)
    return v, r, some_seen(rng, v, r, spread=0.1)


@family("eye almost on the mirror")
def _(rng, n):
    v = flat_triangles(rng, n)
    normals = unit([0.0, 0.0, 1.0] + small(rng, n, 1, 4)[:, None, None] * rng.normal(size=(n, 3, 3)))
    eye = seen(v, v, rng.dirichlet([1.0, 1.0, 1.0], n), np.zeros(n))[:, None]
    corner = rng.random(n) < 0.2
    eye[corner] = v[corner, :1]
    eye = eye + small(rng, n, 2, 15)[:, None, None] * rng.normal(size=(n, 1, 3))
    v, normals, eye = turned(turns(rng, n), v, normals, eye)
    r = mirrored(v, normals, eye)
    return v, r, some_seen(rng, v, r, spread=0.1)
