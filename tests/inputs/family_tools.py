"""What the families of camera/point pairs are made with, and where they are kept by their names."""
from __future__ import annotations

import numpy as np

FAMILIES = {}
"""name: function of a random generator and n, which gives vertices (n, 3, 3), rays (n, 3, 3) and points (n, 3)."""


def family(name):
    def keep(function):
        FAMILIES[name] = function
        return function
    return keep


def seen(vertices, rays, weights, distance):
    """P = Q(W) + s R(W)."""
    return np.einsum("nk,nkc->nc", weights, vertices + distance[:, None, None] * rays)


def mirrored(vertices, normals, eye):
    """The cameras' rays R = d - 2 (d . n) n of an eye."""
    d = vertices - eye
    return d - 2.0 * (d * normals).sum(axis=-1, keepdims=True) * normals


def random_pairs(rng, n):
    """Cameras, and weights and distances of a point in each."""
    vertices, rays = rng.normal(size=(2, n, 3, 3))
    return vertices, rays, rng.dirichlet([1.0, 1.0, 1.0], n), rng.uniform(0.01, 3.0, n)


def small(rng, n, least, most):
    """10^-least to 10^-most."""
    return 10.0 ** -rng.uniform(least, most, n)


def turns(rng, n):
    return np.linalg.qr(rng.normal(size=(n, 3, 3)))[0]


def turned(turn, *vectors):
    """Vectors (n, ..., 3) by the rotations (n, 3, 3)."""
    return tuple(np.einsum("nij,n...j->n...i", turn, vector) for vector in vectors)


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def some_seen(rng, vertices, rays, spread=1.0):
    """Points, three of four of which the camera sees; the others lie anywhere near."""
    n = len(vertices)
    weights, distance = rng.dirichlet([1.0, 1.0, 1.0], n), rng.uniform(0.01, 3.0, n)
    points = seen(vertices, rays, weights, distance)
    return points + np.where(rng.random(n) < 0.25, spread, 0.0)[:, None] * rng.normal(size=(n, 3))


def flat_triangles(rng, n):
    """In the plane z = 0."""
    return rng.normal(size=(n, 3, 3)) * [1.0, 1.0, 0.0]
