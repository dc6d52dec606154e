"""What cameras may see of a scene: its tree is traced for families of them that lie side by side and look nearly the
same way, together."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..cameras import Cameras
from ..geometry import in_order
from ..trees import Bound, Fronts, SceneTree, Shafts, Touching, bounded_trace, curve_leaves, depth_for

FAMILY = 32  # cameras that are looked at together at the most, or about half as many


def traced(tree: SceneTree, cameras: Cameras, bound: Bound, fronts: Fronts | None,
            asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> Touching:
    """`bounded_trace` of cameras by families, without what turns away."""
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
    """(n,): cameras with the same number lie on one mirror triangle, and where these are many, close together."""
    face = cameras.face
    many = np.flatnonzero(np.bincount(face)[face] > FAMILY)
    depth = depth_for(len(many), FAMILY // 2)
    family = face << depth
    if len(many):
        family[many] += curve_leaves(cameras.places[:, cameras.corners[many]].mean(axis=2).T, depth)
    return family
