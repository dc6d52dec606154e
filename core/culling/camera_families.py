"""Culling of a scene for families of cameras: neighbours with similar rays traverse the scene's tree together."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..cameras import Cameras
from ..geometry import in_order
from ..trees import Bound, Fronts, SceneTree, Shafts, Touching, bounded_trace, curve_leaves, depth_for

FAMILY = 32  # largest number of cameras in a family; large groups are divided into families of at least about half


def traced(tree: SceneTree, cameras: Cameras, bound: Bound, fronts: Fronts | None,
            asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> Touching:
    """Find pairs of a camera and a triangle that may touch, with `bounded_trace` over families of cameras.

    Parameters
    ----------
    tree : SceneTree
    bound : Bound, limits on the number of pairs
    fronts : Fronts, optional, drops triangles that turn their back to the rays
    asked : callable, optional
        Takes cameras (p,) and triangles (p,) and returns True (p,) for pairs to keep.
    """
    family = _families(cameras)
    order = in_order(family)
    shafts = Shafts.around(cameras.select(order), float(tree.spheres[0][3, 0]))

    def counting(cone: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        kept = np.ones(len(cone), dtype=bool) if fronts is None else fronts.may_show(shafts.cones, cone, triangle)
        if asked is not None:
            kept[kept] = asked(order[cone[kept]], triangle[kept])
        return kept

    found = bounded_trace(tree, shafts, bound.select(order), counting, family[order])
    return found.among(order, len(order))


def _families(cameras: Cameras) -> np.ndarray:
    """Return the family number (n,) of each camera.

    Cameras of a family lie on one mirror triangle. If a triangle has many cameras, nearby ones form a family.
    """
    face = cameras.face
    many = np.flatnonzero(np.bincount(face)[face] > FAMILY)
    depth = depth_for(len(many), FAMILY // 2)
    family = face << depth
    if len(many):
        family[many] += curve_leaves(cameras.places[:, cameras.corners[many]].mean(axis=2).T, depth)
    return family
