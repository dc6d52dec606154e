"""The vertices of a dense diffuse scene, for rendering as points: one of the vertices within a pixel is shown."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, columns, cross, following, mask, ordered, rows, unit
from .cones import Cones
from .magnification import Magnification
from .node_tree import along_curve
from .vertex_tree import VertexTree

SMALL = 1.0  # pixels: one vertex represents the vertices of a node if the node's image is smaller


@dataclass(frozen=True)
class PointPairs:
    """Pairs (p) of a camera and a vertex that it may see.

    Attributes
    ----------
    camera, vertex : (p,) int64
    stood : (p,) float64
        Radius of the sphere around the vertices that this one represents, 0 if it represents only itself.
    visited : int, number of tests of a cone against a node
    covered : (v,) bool, True for vertices of the mesh in nodes that one vertex represents
    """

    camera: np.ndarray
    vertex: np.ndarray
    stood: np.ndarray
    visited: int
    covered: np.ndarray


@dataclass(frozen=True)
class PointTree(VertexTree):
    """The vertices of a diffuse scene, those of triangles with an area, or all where there are no triangles; build it
    once with `PointTree.build` while the scene stands still.

    Attributes
    ----------
    normal : (3, v) float64
        Unit normal of the surface at each vertex of the mesh, up to its sign; zero where it has none.
    reach : (v,) float64
        Radius of a disc in that surface; those of all vertices cover it.

    Examples
    --------
    >>> import numpy as np
    >>> from core import PointTree, TriangleMesh
    >>> mesh = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> tree = PointTree.build(mesh)  # for `reflect` in place of the mesh, with the method POINTS
    >>> len(tree)
    3
    """

    normal: np.ndarray
    reach: np.ndarray

    @classmethod
    def build(cls, mesh: TriangleMesh) -> PointTree:
        """The tree of a mesh whose vertices and triangles may come in any order."""
        # compare names: a mesh may come from another copy of this package, such as an extension's beside a checkout's
        if type(mesh).__name__ != TriangleMesh.__name__:
            raise ValueError("The mesh of a PointTree must be a TriangleMesh; make one of its positions and triangles.")
        mesh, given = ordered(mesh, shading=False)
        used, normal, reach = _surface(mesh)
        order = used[along_curve(mesh.positions[used])] if len(used) else used
        tree = cls.along_curve(mesh, given, order, normal, reach)
        if not len(mesh.triangles):
            # vertices without faces: assume that those of a leaf are spread evenly over a disc of the leaf's size
            count = np.diff(tree.leaf_start)
            leaf_reach = 2.0 * np.maximum(tree.spheres[-1][3], 0.0) / np.sqrt(np.maximum(count, 1))
            reach[order] = np.repeat(leaf_reach, count)
        return tree

    def trace(self, cones: Cones, magnification: Magnification) -> PointPairs:
        """Find pairs of cameras and vertices that together show all visible vertices; one may represent several."""
        none = np.zeros(0, dtype=np.int64)
        cameras, vertices, radii, visited = [none], [none], [np.zeros(0)], 0
        covered = np.zeros(len(self.mesh.positions), dtype=bool)

        def stood_for(level: int, cone: np.ndarray, node: np.ndarray) -> np.ndarray:
            small = magnification.pixels(cones, cone, columns(self.spheres[level], node)) < SMALL
            nodes, inverse = np.unique(node[small], return_inverse=True)
            stand = self.stand_ins(level, nodes)
            covered[stand.held] = True
            cameras.append(cone[small])
            vertices.append(stand.vertex[inverse])
            radii.append(stand.radius[inverse])
            return small

        for cone, leaf, tested in self.descended(cones, np.ones(len(cones.radius), dtype=bool), stood_for):
            visited += tested
            vertex, pair = self.held(self.depth, leaf)
            cone = cone[pair]
            touching = cones.touch(cone, rows(self.mesh.positions[vertex]), np.zeros(len(cone)))
            cameras.append(cone[touching])
            vertices.append(vertex[touching])
            radii.append(np.zeros(int(touching.sum())))
        camera, vertex, radius = (np.concatenate(parts) for parts in (cameras, vertices, radii))
        return PointPairs(camera, vertex, radius, visited, covered)


def _surface(mesh: TriangleMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Vertices of triangles with an area, and of every vertex the normal (3, v) and the reach of its disc (v,).

    Discs of radius L / sqrt(3) at the corners of a triangle cover it where L is its longest side.
    """
    count = len(mesh.positions)
    normal, reach = np.zeros((3, count)), np.zeros(count)
    if not len(mesh.triangles):
        return np.flatnonzero(np.isfinite(mesh.positions).all(axis=1)), normal, reach
    corners = rows(mesh.positions[mesh.triangles])
    side = np.sqrt(((corners - following(corners, axis=2)) ** 2).sum(axis=0)).max(axis=1)
    area = cross(corners[:, :, 1] - corners[:, :, 0], corners[:, :, 2] - corners[:, :, 0])
    areal = np.flatnonzero(mesh.areal)
    vertex = mesh.triangles[areal]
    for row, part in zip(normal, area[:, areal]):
        row += np.bincount(vertex.ravel(), weights=np.repeat(part, 3), minlength=count)
    # sort by size: the last of several assignments to one vertex, the largest, stays
    order = np.argsort(side[areal])
    reach[vertex[order].ravel()] = np.repeat(side[areal][order], 3) / np.sqrt(3.0)
    return np.flatnonzero(mask(count, vertex)), unit(normal), reach
