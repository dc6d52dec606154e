"""Cones through a tree, as many as the picture and the memory allow to meet triangles."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..support import breathe, crowded
from .cones import Cones
from .node_tree import CONES_AT_ONCE
from .scene_tree import SceneTree

VISITS_OF_A_PAIR = 3  # tests of a cone against a node, to a pair that may be found


def bounded_trace(tree: SceneTree, cones: Cones, most: int, worth: np.ndarray,
                  asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
                  family: np.ndarray | None = None
                  ) -> tuple[np.ndarray, np.ndarray, int, np.ndarray]:
    """Pairs of cones and triangles that may touch, no more than `most`.

    Parameters
    ----------
    worth : (n,) float64
        Of cones that meet too much, those are given up first that meet the most for their worth.
    asked : callable, optional
        Which pairs (p,) of a cone and a triangle count.
    family : (n,) int64, optional
        Rising: cones of one family lie close together.

    Returns
    -------
    cone, triangle : (p,) int64
    visited : int
        Tests of a cone against a node.
    given_up : (n,) bool
        Cones of which no pair is returned.
    """
    wanted, visits = np.ones(len(worth), dtype=bool), VISITS_OF_A_PAIR * most
    found, visited, total = [(np.zeros(0, dtype=np.int64),) * 2], 0, 0
    for cone, triangle, more in tree.traced(cones, wanted, family):
        breathe()
        visited += more
        if visited > visits and len(cone):
            # what lies in the shares still to come is given up whole, with the rest of this one
            wanted[cone.min() // CONES_AT_ONCE * CONES_AT_ONCE:] = False
        if asked is not None and len(cone):
            kept = asked(cone, triangle)
            cone, triangle = cone[kept], triangle[kept]
        found.append((cone, triangle))
        total += len(cone)
        if total > most or not wanted[cone].all():
            cone, triangle = (np.concatenate(side) for side in zip(*found))
            if total > most:
                wanted &= ~crowded(np.bincount(cone, minlength=len(worth)), worth, most // 2)
            kept = wanted[cone]
            found = [(cone[kept], triangle[kept])]
            total = int(kept.sum())
    return *(np.concatenate(side) for side in zip(*found)), visited, ~wanted
