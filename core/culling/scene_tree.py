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
from .cones import Cones
from .node_tree import NODES_AT_ONCE, NodeTree, leaves_of, node_spheres

BUCKET = 16


@dataclass(frozen=True)
class SceneTree(NodeTree):
    """A diffuse scene with its k-d tree; build it once with `SceneTree.build` while the scene stands still.

    Attributes
    ----------
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
        leaf_of_vertex[used], depth = leaves_of(mesh.positions[used], BUCKET)
        leaf = leaf_of_vertex[mesh.triangles[areal, 0]]
        order = np.argsort(leaf, kind="stable")
        leaf_start = np.searchsorted(leaf[order], np.arange(2**depth + 1))
        order = areal[order]
        spheres = node_spheres(low[:, order], high[:, order], leaf_start, depth)
        return cls(mesh, Order.unchanged(mesh) if given is None else given, depth, spheres, leaf_start, order,
                   np.concatenate((centre, radius[None])))

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
        for cone, leaf, visited in self.descended(cones, wanted):
            begin, end = self.runs(self.depth, leaf)
            for part in shares(end - begin, 4 * NODES_AT_ONCE) or [slice(0, 0)]:
                entry, pair = ranges(begin[part], (end - begin)[part])
                own, triangle = cone[part][pair], self.order[entry]
                sphere = np.take(self.triangle_spheres, triangle, axis=1)
                touching = cones.touch(own, sphere[:3], sphere[3])
                yield own[touching], triangle[touching], visited
                visited = 0
