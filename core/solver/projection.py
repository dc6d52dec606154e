"""Projection: where, and how often, a three-ray camera sees a point."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..support import numbers, portions
from .certain_pairs import certain_images, common_lengths, own_lengths
from .doubtful_pairs import doubtful_images
from .scaling import of_ordinary_size

CHUNK = 12288
"""Pairs that are worked on at once: their arrays stay in the caches."""


@dataclass(frozen=True)
class Images:
    """Images of points in three-ray cameras.

    Attributes
    ----------
    pair : (m,) int64
        Which camera/point pair; sorted, and by rising distance within a pair.
    distance : (m,) float64
        s > 0 in P = Q(W) + s R(W).
    weights : (m, 3) float64
        W >= 0, sum 1.
    parity : (m,) int8
        +1 as a flat mirror shows things, -1 turned over, 0 on a caustic.
    degenerate : (n,) bool
        For each pair, whether its cubic vanishes identically, so that nothing can be said of its images.

    Examples
    --------
    >>> import numpy as np
    >>> from core import project
    >>> vertices, rays = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 0, 1]] * 3)
    >>> points = np.array([[0.25, 0.25, 2.0], [9.0, 0.0, 2.0]])  # one is seen, one is not
    >>> images = project(np.array([vertices] * 2), np.array([rays] * 2), points)
    >>> images.pair.tolist(), images.parity.tolist()
    ([0], [1])
    """

    pair: np.ndarray
    distance: np.ndarray
    weights: np.ndarray
    parity: np.ndarray
    degenerate: np.ndarray


def project(vertices: np.ndarray, rays: np.ndarray, points: np.ndarray | None = None) -> Images:
    """Every image of each point in its three-ray camera.

    The camera sees P at the weights W where P = Q(W) + s R(W), s > 0, W >= 0, sum W = 1, with Q(W) = sum W_i V_i and
    R(W) = sum W_i R_i: the triangle whose corners move from V_i along R_i then contains P at the time s, a root of a
    cubic [1]_. There are up to three images. A double root, a point on the caustic, is one image of parity 0. A root at
    which the moved triangle is a line is no image, nor is P on the mirror itself (s = 0). Triangles are closed:
    a point seen along an edge is an image in both triangles that share it. What rounding cannot decide counts as
    equal: double roots, points on the mirror and on edges, and vanishing cubics are told by bounds on the rounding
    errors of the float64 arithmetic on the given numbers, however far from the origin they lie.

    The parity is the sign of the cubic's derivative, R(W) . N(s) with N the moved triangle's normal by its winding,
    times the sign of that normal on the side to which the mirror reflects: that of (R_A + R_B + R_C) . N(0). Both
    change with the winding, so the product does not; the second is one for all images of a camera, so within a camera
    the parity changes only across a caustic. It is the wrong one where shading normals bend the middle ray under the
    flat triangle.

    Parameters
    ----------
    vertices, rays : (n, 3, 3) float64
        Corners V_A, V_B, V_C of each camera's mirror triangle, and their rays R_A, R_B, R_C, not normalised.
    points : (n, 3) float64
        In the same space and units as the vertices. Not to be left out: a ValueError says so, as of all that is wrong.

    Returns
    -------
    Images

    Raises
    ------
    ValueError
        Where shapes do not fit, or a number is not finite.

    References
    ----------
    .. [1] C. Mei, V. Popescu, E. Sacks, "A Hybrid Backward-Forward Method for Interactive Reflections", GRAPP 2007.

    Examples
    --------
    >>> import numpy as np
    >>> from core import project
    >>> vertices, rays = np.array([[[0, 0, 0], [1, 0, 0], [0, 1, 0]]]), np.array([[[0, 0, 1]] * 3])
    >>> images = project(vertices, rays, np.array([[0.25, 0.25, 2.0]]))
    >>> images.distance.round(9).tolist(), images.weights.round(9).tolist()
    ([2.0], [[0.5, 0.25, 0.25]])
    """
    vertices, rays, points = _checked(vertices, rays, points)
    count = len(points)
    degenerate, power = np.zeros(count, dtype=bool), np.zeros(count, dtype=np.int64)
    # The C library maps large arrays anew each time, and clears their pages, until it has freed a larger one once.
    np.empty(64 * CHUNK)
    found, doubts = [], []
    for part in portions(max(count, 1), CHUNK):
        pair, *images, doubtful = certain_images(vertices[part], rays[part], points[part], common_lengths)
        found.append(_turned(pair + part.start, *images))
        doubts.append(np.flatnonzero(doubtful) + part.start)
    left, doubtful_left = np.concatenate(doubts), []
    # a number that is not finite leaves every doubt
    if not all(np.isfinite(given[left]).all() for given in (vertices, rays, points)):
        raise ValueError("Vertices, rays and points must be finite numbers; repair or leave out the others.")
    vertices, rays, points, power[left] = of_ordinary_size(vertices[left], rays[left], points[left])
    for part in _chunks(np.arange(len(left))):
        pair, *images, doubtful = certain_images(vertices[part], rays[part], points[part], own_lengths)
        found.append(_turned(left[part[pair]], *images))
        doubtful_left.append(part[doubtful])
    for part in _chunks(np.concatenate(doubtful_left)):
        (pair, *images), degenerate[left[part]] = doubtful_images(vertices[part], rays[part], points[part])
        found.append(_turned(left[part[pair]], *images))
    pair, distance, weights, parity = (np.concatenate(column) for column in zip(*found))
    with np.errstate(over="ignore", under="ignore"):
        distance = np.ldexp(distance, power[pair])
    # stable, since the images of one pair already come by rising distance
    order = np.argsort(pair, kind="stable")
    # no float64 can tell other distances from 0 and from infinity
    order = order[(distance[order] > 0.0) & (distance[order] < np.inf)]
    return Images(pair[order], distance[order], weights[order], parity[order], degenerate)


def _checked(vertices, rays, points):
    wrong = ("The vertices (n, 3, 3), rays (n, 3, 3) and points (n, 3) of pairs must be arrays of numbers of the "
             "same n; give each pair a camera and a point.")
    points = numbers(points, (None, 3), wrong)
    vertices, rays = (numbers(given, (len(points), 3, 3), wrong) for given in (vertices, rays))
    return vertices, rays, points


def _chunks(pairs: np.ndarray):
    """Return portions of `pairs` (n,): at least one, which may be empty."""
    return (pairs[part] for part in portions(max(len(pairs), 1), CHUNK))


def _turned(pair, distance, weights, sign, side):
    """Replace the sign of each image by its parity, which depends on the triangle's `side` that its rays leave."""
    return pair, distance, weights, np.where(side < 0.0, -sign, sign)
