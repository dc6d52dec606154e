"""k-d tree over the vertices of the diffuse scene, and the cones of all cameras traced through it at once.

J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 1975. The tree is complete
and lies in flat arrays: nodes of one level are one array, and what they hold is a run of the vertices along a
space-filling curve. Each triangle hangs at the leaf of its first vertex, and a node's sphere holds its triangles whole,
so that a cone that touches a triangle meets its leaf even where no vertex of the triangle lies in the cone.
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..geometry import Order, TriangleMesh, columns, dot, in_order, largest, mask, ordered, ranges, rows, shares
from ..support import breathe, portions
from .box_tree import BoxTree
from .closed_bodies import ClosedBodies
from .cones import Balls, Cones
from .node_tree import NODES_AT_ONCE, NodeTree, along_curve, depth_for, node_spheres
from .shafts import Shafts
from .vertex_tree import VertexTree

BUCKET = 4
AT_ONCE = 16384  # triangles whose arrays fit the cache
LEAST_FAMILY = 1.5  # cones: to look for fewer together costs more than it spares


@dataclass(frozen=True)
class SceneTree(NodeTree):
    """A diffuse scene with its k-d tree; build it once with `SceneTree.build` while the scene stands still.

    Attributes
    ----------
    triangle_spheres : (4, m) float64
        Centre and radius around each triangle of the mesh.
    curve : (v,) int64
        Vertices of triangles with an area, along a space-filling curve.

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
    curve: np.ndarray

    @classmethod
    def build(cls, mesh: TriangleMesh) -> SceneTree:
        """The tree of a mesh whose vertices and triangles may come in any order."""
        # compare names: a mesh may come from another copy of this package, such as an extension's beside a checkout's
        if type(mesh).__name__ != TriangleMesh.__name__:
            raise ValueError("The mesh of a SceneTree must be a TriangleMesh; make one of its positions and triangles.")
        return cls.of_ordered(*ordered(mesh, shading=False))

    @classmethod
    def of_ordered(cls, mesh: TriangleMesh, given: Order | None = None) -> SceneTree:
        """The tree of a mesh that is in its canonical order."""
        low, high, spheres_of_each = _boxes_and_spheres(mesh)
        areal = np.flatnonzero(mesh.areal)
        breathe()
        used = np.flatnonzero(mask(len(mesh.positions), mesh.triangles[areal]))
        leaf_of_vertex = np.zeros(len(mesh.positions), dtype=np.int64)
        depth, curve = depth_for(len(used), BUCKET), used
        if len(used):
            curve = used[along_curve(mesh.positions[used])]
            leaf_of_vertex[curve] = np.arange(len(curve)) * 2**depth // len(curve)
        leaf = leaf_of_vertex[mesh.triangles[areal, 0]]
        breathe()
        order = in_order(leaf)
        leaf_start = np.searchsorted(leaf[order], np.arange(2**depth + 1))
        order = areal[order]
        breathe()
        spheres = node_spheres(low[:, order], high[:, order], leaf_start, depth)
        return cls(mesh, Order.unchanged(mesh) if given is None else given, depth, spheres, leaf_start, order,
                   spheres_of_each, curve)

    @cached_property
    def vertices(self) -> VertexTree:
        """Tree of the vertices, for searches of vertices alone."""
        return VertexTree.along_curve(self.mesh, self.given, self.curve)

    @cached_property
    def bodies(self) -> ClosedBodies:
        """Closed bodies of the mesh, whose back faces cannot be seen from outside."""
        return ClosedBodies.of(self.mesh)

    @cached_property
    def boxes(self) -> BoxTree:
        """Tree of boxes, for rays."""
        return BoxTree.build(self.mesh)

    def trace(self, cones: Cones) -> tuple[np.ndarray, np.ndarray, int]:
        """Pairs of cones and triangles that may touch.

        Returns
        -------
        cone, triangle : (p,) int64
        visited : int
            Tests of a cone against a node.
        """
        none = np.zeros(0, dtype=np.int64)
        found = [(none, none, 0), *self.traced(cones, np.ones(len(cones), dtype=bool))]
        cone, triangle, visited = zip(*found)
        return np.concatenate(cone), np.concatenate(triangle), sum(visited)

    def traced(self, cones: Cones | Balls | Shafts, wanted: np.ndarray, family: np.ndarray | None = None,
               enough: np.ndarray | None = None) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """Yield what `trace` returns, in shares that fit the memory.

        Parameters
        ----------
        wanted : (n,) bool, a cone is followed only while its entry is True; changed in place, see `enough`
        family : (n,) int64, optional, increasing; neighbouring cones of the same family descend as one
        enough : (n,) float64, optional, a cone with more triangles to test at a time is set to not wanted
        """
        start = np.flatnonzero(np.diff(family, prepend=-1)) if family is not None else np.zeros(0, dtype=np.int64)
        if LEAST_FAMILY * len(start) < len(wanted) and len(start):
            yield from self._traced_together(cones, wanted, start, enough)
            return
        for cone, leaf, visited in self.descended(cones, wanted):
            begin, end = self.runs(self.depth, leaf)
            if enough is not None:
                left = _not_too_many(cone, end - begin, wanted, enough)
                cone, begin, end = cone[left], begin[left], end[left]
            for part in list(shares(end - begin, 4 * NODES_AT_ONCE)) or [slice(0, 0)]:
                entry, pair = ranges(begin[part], (end - begin)[part])
                own, triangle = cone[part][pair], self.order[entry]
                touching = self._touch(cones, own, triangle)
                yield own[touching], triangle[touching], visited
                visited = 0

    def _traced_together(self, cones: Cones | Balls | Shafts, wanted: np.ndarray, start: np.ndarray,
                         enough: np.ndarray | None) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """Yield what `traced` yields, for families of cones that begin at `start` (f,)."""
        size = np.diff(np.append(start, len(wanted)))
        some = np.ones(len(start), dtype=bool)
        most = None if enough is None else np.maximum.reduceat(enough, start)
        for family, triangle, visited in self.traced(cones.together(start), some, enough=most):
            for part in list(shares(size[family], 4 * NODES_AT_ONCE)) or [slice(0, 0)]:
                own, pair = ranges(start[family[part]], size[family[part]])
                chosen = triangle[part][pair]
                if enough is not None:
                    left = _not_too_many(own, np.ones(len(own)), wanted, enough)
                    own, chosen = own[left], chosen[left]
                touching = wanted[own] & self._touch(cones, own, chosen)
                yield own[touching], chosen[touching], visited
                visited = 0
        wanted[np.repeat(~some, size)] = False

    def _touch(self, cones: Cones | Balls | Shafts, cone: np.ndarray, triangle: np.ndarray) -> np.ndarray:
        """Return True (p,) if each `cone` (p,) may touch its `triangle` (p,)."""
        sphere = columns(self.triangle_spheres, triangle)
        touching = cones.touch(cone, sphere[:3], sphere[3])
        if isinstance(cones, Shafts):
            some = np.flatnonzero(touching)
            touching[some] = cones.hold(cone[some], self.mesh.positions, self.mesh.triangles[triangle[some]])
        return touching


def _boxes_and_spheres(mesh: TriangleMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return low and high corners (3, m) of the triangles' boxes, and bounding spheres (4, m): centres and radii."""
    positions, count = rows(mesh.positions), len(mesh.triangles)
    low, high, spheres = np.empty((3, count)), np.empty((3, count)), np.empty((4, count))
    for part in portions(count, AT_ONCE):
        corners = [columns(positions, corner) for corner in mesh.triangles[part].T]
        a, b, c = corners
        # take minima of three arrays: minima along an axis of three are several times slower
        low[:, part], high[:, part] = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
        centre = 0.5 * (low[:, part] + high[:, part])
        spheres[:3, part] = centre
        spheres[3, part] = np.sqrt(largest(np.stack([dot(corner - centre, corner - centre) for corner in corners])))
    return low, high, spheres


def _not_too_many(cone: np.ndarray, tests: np.ndarray, wanted: np.ndarray, enough: np.ndarray) -> np.ndarray:
    """Return True (p,) for entries whose `cone` (p,) is still `wanted` (n,).

    A cone whose `tests` (p,) against triangles exceed its `enough` (n,) in sum is set to not wanted, in place.
    """
    if len(cone):
        part = slice(low := cone.min(), cone.max() + 1)  # a slice gives a view, so that `wanted` changes in place
        wanted[part] &= np.bincount(cone - low, tests, part.stop - low) <= enough[part]
    return wanted[cone]
