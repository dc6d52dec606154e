"""k-d tree over vertices alone, of which one may stand for all that a node holds.

Nodes hold vertices, not triangles: where the image of a node is smaller than what anybody sees, the vertex nearest its
middle stands for all, so that the work is bounded by what the picture can show.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import Order, TriangleMesh, norm, ranges, rows
from .node_tree import NodeTree, depth_for, node_spheres

BUCKET = 4


@dataclass(frozen=True)
class VertexTree(NodeTree):
    """The vertices of a scene."""

    @classmethod
    def along_curve(cls, mesh: TriangleMesh, given: Order, order: np.ndarray) -> VertexTree:
        """The tree of vertices `order` (n,) of a mesh in its canonical order, which lie along a space-filling curve."""
        depth = depth_for(len(order), BUCKET)
        # leaf i begins with the first vertex that comes at i parts of the curve or behind
        start = -(-np.arange(2**depth + 1) * len(order) // 2**depth)
        points = rows(mesh.positions[order])
        return cls(mesh, given, depth, node_spheres(points, points, start, depth), start, order)

    def held(self, level: int, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The vertices (m,) in nodes (n,), and in which of the n each is."""
        begin, end = self.runs(level, node)
        entry, run = ranges(begin, end - begin)
        return self.order[entry], run

    def small(self, level: int, node: np.ndarray, scale: np.ndarray, least: float) -> np.ndarray:
        """Which nodes (n,) are smaller than `least` pixels where a scene unit is `scale` (n,) pixels long."""
        # an empty one, of radius -inf, has none
        return 2.0 * np.abs(self.spheres[level][3, node]) * scale < least

    def representatives(self, level: int, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The vertex nearest the middle of each node, and how far from it the node's other vertices are at most."""
        if not len(node):
            return np.zeros(0, dtype=np.int64), np.zeros(0)
        held, run = self.held(level, node)
        middle = self.spheres[level][:3, node]
        points = rows(self.mesh.positions[held])
        away = norm(points - middle[:, run])
        first = np.flatnonzero(np.diff(run, prepend=-1))
        nearest = np.flatnonzero(away == np.minimum.reduceat(away, first)[run])
        _, once = np.unique(run[nearest], return_index=True)
        vertex = held[nearest[once]]
        spread = norm(points - rows(self.mesh.positions[vertex])[:, run])
        return vertex, np.maximum.reduceat(spread, first)
