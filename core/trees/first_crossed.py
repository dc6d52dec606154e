"""Rays traced one by one: the triangle of a tree that each meets first."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import SceneFrames, columns
from .cones import Cones
from .first_hits import EDGE, first_hits
from .scene_tree import SceneTree

WORTH_BOXES = 10  # triangles for each ray, up to which boxes round them pay: a ray through these takes a fifth, or less


def first_crossed(tree: SceneTree, origin: np.ndarray, ray: np.ndarray, beyond: float = 0.0,
                  asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
                  limit: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Find the first triangle that each ray meets farther than `beyond` and nearer than `limit` (n,).

    Parameters
    ----------
    origin, ray : (3, n) float64, origins and unit directions
    asked : callable, optional, takes rays (p,) and triangles (p,); returns True (p,) for pairs that count

    Returns
    -------
    triangle : (n,) int64, of the tree, -1 if the ray meets none
    distance : (n,) float64, infinite if it meets none
    """
    count = ray.shape[1]
    if count * WORTH_BOXES > len(tree):  # by counts alone, so that the result does not depend on what is cached
        return first_of_many(tree, origin, ray, beyond, asked, limit)
    first, distance = _by_cones(tree, origin, ray, beyond, asked)
    near = np.isfinite(distance) if limit is None else distance < limit
    return np.where(near, first, -1), np.where(near, distance, np.inf)


def first_of_many(tree: SceneTree, origin: np.ndarray, ray: np.ndarray, beyond: float = 0.0,
                  asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
                  limit: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Find first triangles as `first_crossed` does, by the tree of boxes: for many rays, or portions of many."""
    hits = first_hits(tree.boxes, origin, ray, least=beyond, asked=asked, limit=limit)
    return hits.triangle, hits.distance


def _by_cones(tree: SceneTree, origin: np.ndarray, ray: np.ndarray, beyond: float,
              asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None) -> tuple[np.ndarray, np.ndarray]:
    """Find first triangles of few rays, as cones without width, without the cost of building a tree of boxes."""
    count = ray.shape[1]
    zero, first, best = np.zeros(count), np.full(count, -1), np.full(count, np.inf)
    for own, triangle, _ in tree.traced(Cones(origin, zero, ray, zero, zero + 1.0), np.ones(count, dtype=bool)):
        if asked is not None and len(own):
            kept = asked(own, triangle)
            own, triangle = own[kept], triangle[kept]
        places, ways = columns(origin, own), columns(ray, own)
        frames, pair = SceneFrames.of(tree.mesh, triangle), np.arange(len(own))
        s = frames.distance(pair, places, ways)
        inside = frames.weights(pair, places + s * ways).min(axis=0) >= -EDGE
        met = np.flatnonzero(inside & (s > beyond) & (s < best[own]))
        met = met[np.lexsort((triangle[met], s[met], own[met]))]
        found, nearest = np.unique(own[met], return_index=True)
        first[found], best[found] = triangle[met[nearest]], s[met[nearest]]
    return first, best
