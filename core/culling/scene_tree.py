"""k-d tree over the vertices of the diffuse scene, and the cones of all cameras traced through it at once.

J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 1975. The tree is complete
and lies in flat arrays: nodes of one level are rows of one array, cut at the median of their widest axis, all nodes of
a level at a time. Each triangle hangs at the leaf of its first vertex, and a node's sphere holds its triangles whole,
so that a cone that touches a triangle meets its leaf even where no vertex of the triangle lies in the cone.
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..geometry import Order, TriangleMesh, has_area, ordered, ranges, rows, shares
from ..support import breathe
from .cones import Cones

BUCKET = 16
FIRST_LEVEL = 4
STRIDE = 2
CONES_AT_ONCE, NODES_AT_ONCE = 8192, 1 << 18


@dataclass(frozen=True)
class SceneTree:
    """A diffuse scene with its k-d tree; build it once with `SceneTree.build` while the scene stands still.

    Attributes
    ----------
    mesh : TriangleMesh
        The scene in its canonical order, which all that follows names.
    given : Order
        Where its parts are in the mesh that was given.
    depth : int
        The leaves are the 2**depth nodes of the last level.
    spheres : list of (4, 2**level) float64
        Centre and radius around the triangles of each node of each level; a radius of -inf where a node has none.
    leaf_start : (2**depth + 1,) int64
    leaf_triangles : (t,) int64
        Triangles of leaf i are leaf_triangles[leaf_start[i]:leaf_start[i + 1]]; those without an area are left out.
    triangle_spheres : (4, m) float64
        Centre and radius around each triangle of the mesh.

    Examples
    --------
    >>> import numpy as np
    >>> from core import SceneTree, TriangleMesh
    >>> mesh = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> tree = SceneTree.build(mesh)  # for `reflect` in place of the mesh
    >>> len(tree)
    1
    """

    mesh: TriangleMesh
    given: Order
    depth: int
    spheres: list
    leaf_start: np.ndarray
    leaf_triangles: np.ndarray
    triangle_spheres: np.ndarray

    @classmethod
    def build(cls, mesh: TriangleMesh) -> SceneTree:
        """The tree of a mesh whose vertices and triangles may come in any order."""
        # of another copy of this package, as an extension's beside a checkout's, a mesh is a mesh too
        if type(mesh).__name__ != TriangleMesh.__name__:
            raise ValueError("The mesh of a SceneTree must be a TriangleMesh; make one of its positions and triangles.")
        return cls.of_ordered(*ordered(mesh, shading=False))

    @classmethod
    def of_ordered(cls, mesh: TriangleMesh, given: Order | None = None) -> SceneTree:
        """The tree of a mesh that is in its canonical order."""
        corners = rows(mesh.positions[mesh.triangles])
        low, high = corners.min(axis=2), corners.max(axis=2)
        centre = 0.5 * (low + high)
        radius = np.sqrt(((corners - centre[:, :, None]) ** 2).sum(axis=0).max(axis=1))
        u, v = corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0]
        area = np.linalg.norm(np.cross(u, v, axis=0), axis=0)
        areal = np.flatnonzero(has_area(area, radius))
        used = np.unique(mesh.triangles[areal])
        leaf_of_vertex = np.zeros(len(mesh.positions), dtype=np.int64)
        depth = max(0, int(np.ceil(np.log2(max(len(used), 1) / BUCKET))))
        leaf_of_vertex[used] = median_leaves(mesh.positions[used], depth)
        leaf = leaf_of_vertex[mesh.triangles[areal, 0]]
        order = np.argsort(leaf, kind="stable")
        leaf_start = np.searchsorted(leaf[order], np.arange(2**depth + 1))
        leaf_triangles = areal[order]
        spheres = node_spheres(low[:, leaf_triangles], high[:, leaf_triangles], leaf_start, depth)
        return cls(mesh, Order.unchanged(mesh) if given is None else given, depth, spheres, leaf_start, leaf_triangles,
                   np.concatenate((centre, radius[None])))

    def __len__(self) -> int:
        return len(self.leaf_triangles)

    def trace(self, cones: Cones) -> tuple[np.ndarray, np.ndarray, int]:
        """Pairs of cones and triangles that may touch.

        Returns
        -------
        cone, triangle : (p,) int64
        visited : int
            Tests of a cone against a node.
        """
        none = np.zeros(0, dtype=np.int64)
        found = [(none, none, 0), *self.traced(cones, np.ones(len(cones.radius), dtype=bool))]
        cone, triangle, visited = zip(*found)
        return np.concatenate(cone), np.concatenate(triangle), sum(visited)

    def traced(self, cones: Cones, wanted: np.ndarray) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """What `trace` returns, in shares that fit the memory; a cone that is no longer `wanted` (n,) when its turn
        comes is not followed."""
        level = min(FIRST_LEVEL, self.depth)
        for start in range(0, len(cones.radius), CONES_AT_ONCE):
            cone = np.arange(start, min(start + CONES_AT_ONCE, len(cones.radius)))
            waiting = [(level, np.repeat(cone, 2**level), np.tile(np.arange(2**level), len(cone)))]
            while waiting:
                yield from self._followed(cones, wanted, waiting)

    def _followed(self, cones: Cones, wanted: np.ndarray,
                  waiting: list) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """One level of the tree for the cones and nodes that have waited least; what comes of them waits in its turn,
        unless they are leaves."""
        level, cone, node = waiting.pop()
        sphere, visited = self.spheres[level], len(cone)
        touching = wanted[cone] & cones.touch(cone, np.take(sphere[:3], node, axis=1), sphere[3][node])
        cone, node = cone[touching], node[touching]
        if level < self.depth:
            fan = 2 ** min(STRIDE, self.depth - level)
            below = level + min(STRIDE, self.depth - level)
            for start in reversed(range(0, max(len(cone), 1), NODES_AT_ONCE)):
                part = slice(start, start + NODES_AT_ONCE)
                waiting.append((below, np.repeat(cone[part], fan),
                                (node[part, None] * fan + np.arange(fan)).ravel()))
            yield np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64), visited
            return
        count = self.leaf_start[node + 1] - self.leaf_start[node]
        for part in shares(count, 4 * NODES_AT_ONCE):
            entry, pair = ranges(self.leaf_start[node[part]], count[part])
            own, triangle = cone[part][pair], self.leaf_triangles[entry]
            sphere = np.take(self.triangle_spheres, triangle, axis=1)
            touching = cones.touch(own, sphere[:3], sphere[3])
            yield own[touching], triangle[touching], visited
            visited = 0


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
