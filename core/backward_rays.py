"""Rays traced backwards: from places on the mirror to the first diffuse triangle, through the k-d tree."""
from __future__ import annotations

import numpy as np

from .cones import Cones
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .vectors import unit


def first_hits(tree: SceneTree, frames: SceneFrames, places: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Which triangle each ray meets first.

    Parameters
    ----------
    places, rays : (3, n) float64
        Q and R; a ray is a cone without a width.

    Returns
    -------
    column : (n,) int64
        In the frames, -1 where the ray meets none of their triangles.
    """
    count = places.shape[1]
    found = np.full(count, -1)
    zero = np.zeros(count)
    ray, triangle, _ = tree.trace(Cones(places, zero, unit(rays), zero, zero + 1.0))
    column, known = frames.columns(triangle)
    ray, column = ray[known], column[known]
    from_, along = places[:, ray], rays[:, ray]
    s = frames.distance(column, from_, along)
    met = np.flatnonzero((s > 0.0) & (frames.weights(column, from_ + s * along) >= 0.0).all(axis=0))
    order = met[np.lexsort((s[met], ray[met]))]
    hit, first = np.unique(ray[order], return_index=True)
    found[hit] = column[order[first]]
    return found
