"""Cones through a tree, as many as the picture and the memory allow to meet triangles."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..support import breathe, crowded
from .cones import Cones
from .node_tree import CONES_AT_ONCE
from .scene_tree import SceneTree
from .shafts import Shafts

VISITS_OF_A_PAIR = 3  # tests of a cone against a node, to a pair that may be found


@dataclass(frozen=True)
class Bound:
    """Limits of a search for pairs of cones and triangles.

    Attributes
    ----------
    most : int, largest number of pairs of cones (n) and triangles
    worth : (n,) float64, if there are too many pairs, cones with the most triangles for their worth are given up first
    enough : (n,) float64, optional, number of triangles tested at a time from which on a cone is full
    """

    most: int
    worth: np.ndarray
    enough: np.ndarray | None = None

    def select(self, chosen: np.ndarray) -> Bound:
        return Bound(self.most, self.worth[chosen], None if self.enough is None else self.enough[chosen])

    def beside(self, found: int) -> Bound:
        """Return the bound that is left after `found` pairs."""
        return Bound(max(self.most - found, 0), self.worth, self.enough)


@dataclass(frozen=True)
class Touching:
    """Pairs (p) of cones (n) and triangles that may touch.

    Attributes
    ----------
    cone, triangle : (p,) int64
    visited : int, tests of a cone against a node
    given_up : (n,) bool, cones that meet too much of all that may be found; no pair of them is among these
    full : (n,) bool, cones that meet more than is worth looking at; no pair of them is among these either
    """

    cone: np.ndarray
    triangle: np.ndarray
    visited: int
    given_up: np.ndarray
    full: np.ndarray

    @classmethod
    def none(cls, count: int) -> Touching:
        """Return no pairs, for `count` cones."""
        nothing, no_cone = np.zeros(0, dtype=np.int64), np.zeros(count, dtype=bool)
        return cls(nothing, nothing, 0, no_cone, no_cone)

    @classmethod
    def joined(cls, parts: list[Touching]) -> Touching:
        """Join the pairs of several traces of the same cones."""
        cone, triangle, given_up, full = zip(*((part.cone, part.triangle, part.given_up, part.full) for part in parts))
        return cls(np.concatenate(cone), np.concatenate(triangle), sum(part.visited for part in parts),
                   np.logical_or.reduce(given_up), np.logical_or.reduce(full))

    def among(self, chosen: np.ndarray, count: int) -> Touching:
        """Renumber the cones (n) as the cones `chosen` (n,) of `count` cones."""
        given_up, full = np.zeros((2, count), dtype=bool)
        given_up[chosen], full[chosen] = self.given_up, self.full
        return Touching(chosen[self.cone], self.triangle, self.visited, given_up, full)


def bounded_trace(tree: SceneTree, cones: Cones | Shafts, bound: Bound,
                  asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None,
                  family: np.ndarray | None = None) -> Touching:
    """Find pairs of cones and triangles that may touch, up to a bound on their number.

    Parameters
    ----------
    tree : SceneTree
    cones : Cones or Shafts
    bound : Bound
    asked : callable, optional, takes cones (p,) and triangles (p,); returns True (p,) for pairs to keep
    family : (n,) int64, optional, increasing: cones of one family lie close together
    """
    worth, most = bound.worth, bound.most
    wanted, visits = np.ones(len(worth), dtype=bool), VISITS_OF_A_PAIR * most
    given_up = np.zeros(len(worth), dtype=bool)
    found, visited, total = [(np.zeros(0, dtype=np.int64),) * 2], 0, 0

    def leave(cones: np.ndarray) -> None:
        given_up[cones] |= wanted[cones]
        wanted[cones] = False

    for cone, triangle, more in tree.traced(cones, wanted, family, bound.enough):
        breathe()
        visited += more
        if visited > visits and len(cone):
            # give up all cones of the shares still to come, and the rest of this one
            leave(np.arange(cone.min() // CONES_AT_ONCE * CONES_AT_ONCE, len(worth)))
        if asked is not None and len(cone):
            kept = asked(cone, triangle)
            cone, triangle = cone[kept], triangle[kept]
        found.append((cone, triangle))
        total += len(cone)
        if total > most or not wanted[cone].all():
            cone, triangle = (np.concatenate(side) for side in zip(*found))
            if total > most:
                leave(crowded(np.bincount(cone, minlength=len(worth)), worth, most // 2))
            kept = wanted[cone]
            found = [(cone[kept], triangle[kept])]
            total = int(kept.sum())
    cone, triangle = (np.concatenate(side) for side in zip(*found))
    kept = wanted[cone]
    return Touching(cone[kept], triangle[kept], visited, given_up, ~wanted & ~given_up)
