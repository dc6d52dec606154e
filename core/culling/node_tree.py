"""A complete tree of medians with spheres round what its nodes hold, and how cones descend it, a level at a time.

J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 1975.
"""
from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np

from ..geometry import Order, TriangleMesh
from ..support import breathe
from .cones import Cones

FIRST_LEVEL = 4
STRIDE = 2
CONES_AT_ONCE, NODES_AT_ONCE = 8192, 1 << 18


@dataclass(frozen=True)
class NodeTree:
    """What triangles and vertices have in common as trees.

    Attributes
    ----------
    mesh : TriangleMesh
        The scene in its canonical order, which all that follows names.
    given : Order
        Where its parts are in the mesh that was given.
    depth : int
        The leaves are the 2**depth nodes of the last level.
    spheres : list of (4, 2**level) float64
        Centre and radius around what each node of each level holds; a radius of -inf where that is nothing.
    leaf_start : (2**depth + 1,) int64
        Leaf i holds order[leaf_start[i]:leaf_start[i + 1]].
    order : (n,) int64
        Triangles or vertices, leaf after leaf; triangles without an area are left out.
    """

    mesh: TriangleMesh
    given: Order
    depth: int
    spheres: list
    leaf_start: np.ndarray
    order: np.ndarray

    def __len__(self) -> int:
        return len(self.order)

    def descended(self, cones: Cones, wanted: np.ndarray, resting: Callable | None = None
                  ) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """Cones and leaves that touch, and how many nodes were tested for it, in shares that fit the memory. A cone
        that is no longer `wanted` (n,) when its turn comes goes no further; nor do cones at nodes where `resting`,
        asked with (level, cone, node), says so."""
        level = min(FIRST_LEVEL, self.depth)
        for start in range(0, len(cones.radius), CONES_AT_ONCE):
            breathe()
            cone = np.arange(start, min(start + CONES_AT_ONCE, len(cones.radius)))
            waiting = [(level, np.repeat(cone, 2**level), np.tile(np.arange(2**level), len(cone)))]
            while waiting:
                yield self._step(cones, wanted, resting, waiting)

    def _step(self, cones: Cones, wanted: np.ndarray, resting: Callable | None,
              waiting: list) -> tuple[np.ndarray, np.ndarray, int]:
        """One level of the tree for the cones and nodes that have waited least; what comes of them waits in its turn,
        unless they are leaves."""
        level, cone, node = waiting.pop()
        sphere, visited = self.spheres[level], len(cone)
        touching = wanted[cone] & cones.touch(cone, np.take(sphere[:3], node, axis=1), sphere[3][node])
        cone, node = cone[touching], node[touching]
        if resting is not None:
            going = ~resting(level, cone, node)
            cone, node = cone[going], node[going]
        if level == self.depth:
            return cone, node, visited
        fan = 2 ** min(STRIDE, self.depth - level)
        below = level + min(STRIDE, self.depth - level)
        for start in reversed(range(0, max(len(cone), 1), NODES_AT_ONCE)):
            part = slice(start, start + NODES_AT_ONCE)
            waiting.append((below, np.repeat(cone[part], fan), (node[part, None] * fan + np.arange(fan)).ravel()))
        return cone[:0], node[:0], visited

    def runs(self, level: int, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where in `order` what nodes hold begins and ends."""
        fan = 2 ** (self.depth - level)
        return self.leaf_start[node * fan], self.leaf_start[(node + 1) * fan]


def leaves_of(points: np.ndarray, bucket: int) -> tuple[np.ndarray, int]:
    """The leaf of each point (n, 3) in a tree of medians with about `bucket` points a leaf, and its depth."""
    depth = max(0, int(np.ceil(np.log2(max(len(points), 1) / bucket))))
    return median_leaves(points, depth), depth


def median_leaves(points: np.ndarray, depth: int) -> np.ndarray:
    """Leaf of each point (n, 3) in a complete tree of medians of the widest axis; leaf sizes differ by the padding."""
    count = len(points)
    if depth == 0:
        return np.zeros(count, dtype=np.int64)
    width = -(-count // 2**depth)
    order = np.arange(2**depth * width) % count
    for level in range(depth):
        breathe()
        order = order.reshape(2**level, -1)
        node = points[order]
        axis = np.argmax(node.max(axis=1) - node.min(axis=1), axis=1)
        along = np.take_along_axis(node, axis[:, None, None], axis=2)[:, :, 0]
        middle = order.shape[1] // 2
        order = np.take_along_axis(order, np.argpartition(along, middle, axis=1), axis=1)
    leaf = np.empty(count, dtype=np.int64)
    leaf[order.ravel()] = np.repeat(np.arange(2**depth), width)
    return leaf


def node_spheres(low: np.ndarray, high: np.ndarray, leaf_start: np.ndarray, depth: int) -> list:
    """Spheres around the boxes (3, t) of each node's triangles, which lie in the order of the leaves."""
    leaves = 2**depth
    box_low, box_high = np.full((3, leaves), np.inf), np.full((3, leaves), -np.inf)
    filled = np.flatnonzero(leaf_start[1:] > leaf_start[:-1])
    if len(filled):
        box_low[:, filled] = np.minimum.reduceat(low, leaf_start[filled], axis=1)
        box_high[:, filled] = np.maximum.reduceat(high, leaf_start[filled], axis=1)
    spheres = []
    for level in range(depth, -1, -1):
        empty = box_low[0] > box_high[0]
        with np.errstate(invalid="ignore"):
            centre = np.where(empty, 0.0, 0.5 * (box_low + box_high))
            radius = np.where(empty, -np.inf, np.sqrt(((0.5 * (box_high - box_low)) ** 2).sum(axis=0)))
        spheres.append(np.concatenate((centre, radius[None])))
        if level:
            box_low = box_low.reshape(3, -1, 2).min(axis=2)
            box_high = box_high.reshape(3, -1, 2).max(axis=2)
    return spheres[::-1]
