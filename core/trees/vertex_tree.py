"""k-d tree over vertices alone, in which one vertex may represent all vertices of a node.

Nodes hold vertices, not triangles. If the image of a node is too small to be seen, the vertex nearest to its centre
represents them all, so that the work is bounded by what the picture can show.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ..geometry import Order, TriangleMesh, columns, groups, in_order, norm, ranges, rows
from .node_tree import NodeTree, depth_for, node_spheres

BUCKET = 4
Kind = TypeVar("Kind", bound="VertexTree")


@dataclass(frozen=True)
class StandIns:
    """Representative vertices (k), each for a group of vertices.

    Attributes
    ----------
    held : (m,) int64, the vertices that are represented
    own : (m,) int64, index of the representative of each of them
    vertex : (k,) int64, the representatives
    radius : (k,) float64, of the sphere around the representative that holds its group
    node : (k,) int64, index of the node of each group, among the nodes asked for
    """

    held: np.ndarray
    own: np.ndarray
    vertex: np.ndarray
    radius: np.ndarray
    node: np.ndarray


@dataclass(frozen=True)
class VertexTree(NodeTree):
    """The vertices of a scene."""

    @classmethod
    def along_curve(cls: type[Kind], mesh: TriangleMesh, given: Order, order: np.ndarray, *more: np.ndarray) -> Kind:
        """Build the tree of the vertices `order` (n,), sorted along a space-filling curve, of an ordered mesh.

        `more` are further attributes of subclasses.
        """
        depth = depth_for(len(order), BUCKET)
        # leaf i begins with the first vertex that comes at i parts of the curve or behind
        start = -(-np.arange(2**depth + 1) * len(order) // 2**depth)
        points = rows(mesh.positions[order])
        return cls(mesh, given, depth, node_spheres(points, points, start, depth), start, order, *more)

    def held(self, level: int, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the vertices (m,) in nodes `node` (n,) of a level, and the index (m,) of the node of each."""
        begin, end = self.runs(level, node)
        entry, run = ranges(begin, end - begin)
        return self.order[entry], run

    def small(self, level: int, node: np.ndarray, scale: np.ndarray, least: float) -> np.ndarray:
        """Return True for nodes `node` (n,) smaller than `least` pixels; a scene unit is `scale` (n,) pixels long."""
        # an empty node has the radius -inf and is never small
        return 2.0 * np.abs(self.spheres[level][3, node]) * scale < least

    def stand_ins(self, level: int, node: np.ndarray, part: np.ndarray | None = None) -> StandIns:
        """Choose the vertex nearest to the centre of each node `node` (n,) of a level to represent the node's vertices.

        If the `part` (v,) of each vertex is given, choose one for each part within a node.
        """
        held, run = self.held(level, node)
        own = run
        if part is not None and len(held):
            _, own = groups(run, part[held])
            order = in_order(own)
            held, run, own = held[order], run[order], own[order]
        points = rows(self.mesh.positions[held])
        away = norm(points - columns(self.spheres[level][:3, node], run))
        first = np.flatnonzero(np.diff(own, prepend=-1))
        if not len(first):
            return StandIns(held, own, held, np.zeros(0), run)
        nearest = np.flatnonzero(away == np.minimum.reduceat(away, first)[own])
        _, once = np.unique(own[nearest], return_index=True)
        vertex = held[nearest[once]]
        spread = norm(points - columns(rows(self.mesh.positions[vertex]), own))
        return StandIns(held, own, vertex, np.maximum.reduceat(spread, first), run[first])
