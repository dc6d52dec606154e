"""Traversal of the vertex tree by the images of its nodes on a patch.

Newton's method finds the image of a node's centre. The map's derivative there predicts the images of the node's content
so well that two more steps find them, without cones or cubics. A node smaller than a pixel threshold is not opened.
"""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..geometry import columns, dot, mask, norm, unit
from ..support import portions
from ..trees import Cones, StandIns, VertexTree, along_curve
from .patch import Patch
from .walk import changes, find, find_near

NODES_AT_ONCE = 2048  # nodes per chunk, whose content fits the CPU cache
RAYS, SHEAVES = 9, 6  # base-2 logarithms of the number of sample rays, and of the number of cones over the patch
FAR_AT_ONCE = 512  # points per chunk that are compared with all sample rays
WIDER = 1.25  # factor on the width of cones, for rays between the corners of triangles
LARGER = 1.25  # factor on the magnification at a node's centre, for the rest of the node


class Walk:
    """Newton's method for the images of points on a patch; points are (3, n), relative to the eye."""

    def __init__(self, patch: Patch) -> None:
        self.patch, self.asked = patch, 0
        self.member = _groups(patch, RAYS)[:, 0]
        place, ray = patch.leaving(self.member, np.full((2, len(self.member)), 1.0 / 3.0))
        self.place, self.ray, self.length = place.T, unit(ray).T, norm(ray)

    def images(self, points: np.ndarray, nodes: NodeImages, node: np.ndarray) -> tuple:
        """Find images like `find`, from starts predicted by `nodes`; most images are found from these.

        `node` (n,) is the node of `nodes` that each point lies in.
        """
        self.asked += points.shape[1]
        place = nodes.around(node, points)
        member, uv, s, found = find_near(self.patch, nodes.member[node], place[:2], place[2], points)
        return member, uv, s, found & nodes.found[node]

    def afresh(self, points: np.ndarray) -> tuple:
        """Find the images of `points` (3, n), relative to the eye, without starts from nodes around them.

        Newton's method starts for each point at the sample ray that passes nearest to it. Sample rays are the reflected
        rays at the centres of up to 512 triangles all over the patch.

        Returns
        -------
        member : (n,) int64, triangle of the patch in which each image lies
        uv : (2, n) float64, place of the image in that triangle
        s : (n,) float64, distance from the image to the point, as a multiple of the reflected ray
        found : (n,) bool, True for points with an image; otherwise the other results belong to no image
        """
        parts = [self.near(points[:, part]) for part in portions(max(points.shape[1], 1), FAR_AT_ONCE)]
        member, uv, s = (np.concatenate(part, axis=-1) for part in zip(*parts))
        return find(self.patch, member, uv, s, points)

    def near(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return triangle (n,), (u, v) (2, n) and s (n,) of the sample ray that passes nearest to each point."""
        middle = self.place.mean(axis=0)
        place, point = self.place - middle, points.T - middle
        along = np.maximum(point @ self.ray.T - (place * self.ray).sum(axis=1), 0.0)
        nearest = ((place**2).sum(axis=1) - 2.0 * (point @ place.T) - along * along).argmin(axis=1)
        s = along[np.arange(len(point)), nearest] / self.length[nearest]
        return self.member[nearest], np.full((2, len(s)), 1.0 / 3.0), s


@dataclass(frozen=True)
class NodeImages:
    """Images of the centres of nodes (k).

    Attributes
    ----------
    found : (k,) bool, True for centres with an image
    point : (3, k) float64, centres relative to the eye
    member : (k,) int64, triangles of the patch that show them
    place : (3, k) float64, u, v and s of the images
    change : (9, k) float64, derivatives of u, v and s with respect to the point
    scale : (k,) float64, largest image length of one scene unit there, in pixels
    """

    found: np.ndarray
    point: np.ndarray
    member: np.ndarray
    place: np.ndarray
    change: np.ndarray
    scale: np.ndarray

    @classmethod
    def of(cls, walk: Walk, points: np.ndarray, above: NodeImages | None, parent: np.ndarray) -> NodeImages:
        """Find the images of `points` (3, k), relative to the eye; `parent` (k,) are their nodes in `above`, if any."""
        if above is None:
            member, uv, s, found = walk.afresh(points)
        else:
            member, uv, s, found = walk.images(points, above, parent)
            far = np.flatnonzero(~found)
            member[far], uv[:, far], s[far], found[far] = walk.afresh(points[:, far])
        change, (right, up) = changes(walk.patch, member, uv, s)
        scale = np.sqrt(0.5 * (dot(right, right) + dot(up, up))
                        + np.hypot(0.5 * (dot(right, right) - dot(up, up)), dot(right, up)))
        return cls(found, points, member, np.concatenate((uv, s[None])), change.reshape(9, -1), scale)

    def around(self, node: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Predict u, v and s (3, n) of the images of `points` (3, n), in nodes `node` (n,), from the derivatives."""
        way, place = points - columns(self.point, node), columns(self.place, node)
        for row, change in zip(place, columns(self.change, node).reshape(3, 3, -1)):
            row += dot(change, way)
        return place


@dataclass(frozen=True)
class NodeVertices:
    """Vertices (n) whose images are to be found.

    Attributes
    ----------
    nodes : NodeImages
    node : (n,) int64, index of the node in `nodes` that each lies in
    vertex : (n,) int64, indices of vertices
    stood : (n,) float64
        Radius of the sphere around the vertices that this one represents, 0 if it represents only itself.
    """

    nodes: NodeImages
    node: np.ndarray
    vertex: np.ndarray
    stood: np.ndarray


class Descent:
    """Traversal that yields the vertices of a tree that a patch may show.

    A node smaller than `least` pixels yields one representative vertex, or one for each `part` (v,) that it holds.

    Attributes
    ----------
    standing : (v,) int64, for each vertex of the mesh its representative
    """

    def __init__(self, walk: Walk, tree: VertexTree, least: float, part: np.ndarray | None = None) -> None:
        self.walk, self.tree, self.least, self.part = walk, tree, least, part
        self.sheaves = _sheaves(walk.patch)
        self.standing = np.arange(len(tree.mesh.positions))
        self._small: list[tuple[int, np.ndarray, np.ndarray]] = []

    def vertices(self) -> Generator[NodeVertices, None, None]:
        """Yield the vertices that the patch may show; representatives for small nodes."""
        tree = self.tree
        level, node = tree.top()
        waiting: list[tuple[int, np.ndarray, NodeImages | None, np.ndarray]] = [(level, node, None, node)]
        while waiting:
            level, node, above, parent = waiting.pop()
            sphere = columns(tree.spheres[level], node)
            images = NodeImages.of(self.walk, sphere[:3] - self.walk.patch.eye, above, parent)
            open_, some = self._opened(level, node, images, np.arange(len(node)))
            yield some
            lost = np.flatnonzero(~images.found)
            open_[lost] = self._may_be_seen(sphere[:, lost])
            open_ = np.flatnonzero(open_)
            level, inner, parent = tree.below(level, node[open_])
            parent = open_[parent]
            if level < tree.depth:
                for part in portions(len(inner), NODES_AT_ONCE):
                    waiting.append((level, inner[part], images, parent[part]))
                continue
            open_, some = self._opened(level, inner, images, parent)
            yield some
            vertex, leaf = tree.held(level, inner[open_])
            yield NodeVertices(images, parent[open_][leaf], vertex, np.zeros(len(vertex)))

    def _opened(self, level: int, node: np.ndarray, images: NodeImages,
                row: np.ndarray) -> tuple[np.ndarray, NodeVertices]:
        """Return True (n,) for nodes to open, and the representative vertices of the other ones.

        `row` (n,) is the entry of `images` with the magnification at each node.
        """
        scale = LARGER * images.scale[row]
        small = images.found[row] & self.tree.small(level, node, scale, self.least)
        some = np.flatnonzero(small)
        stand = self._stand(level, node[some])
        self._small.append((level, node[some], scale[some]))
        return ~small, NodeVertices(images, row[some][stand.node], stand.vertex, stand.radius)

    def _stand(self, level: int, node: np.ndarray) -> StandIns:
        """Choose the vertices that represent all vertices in nodes `node` (n,), and record them in `standing`."""
        stand = self.tree.stand_ins(level, node, self.part)
        self.standing[stand.held] = stand.vertex[stand.own]
        return stand

    def fall_apart(self, asked: np.ndarray, least: float) -> None:
        """Divide small nodes further, until each is smaller than `least` pixels, and update `standing`.

        Only nodes with a vertex whose representative is in `asked` (v,) bool are divided.
        """
        tree = self.tree
        for level, node, scale in self._small:
            held, run = tree.held(level, node)
            some = mask(len(node), run[asked[self.standing[held]]])
            held, node, scale = held[some[run]], node[some], scale[some]
            self.standing[held] = held
            while len(node):
                small = tree.small(level, node, scale, least)
                self._stand(level, node[small])
                node, scale = node[~small], scale[~small]
                if level == tree.depth:
                    break
                level, node, parent = tree.below(level, node)
                scale = scale[parent]

    def _may_be_seen(self, sphere: np.ndarray) -> np.ndarray:
        """Return True (n,) for spheres (4, n) that some ray of the patch may touch."""
        sheaf, count = len(self.sheaves.radius), sphere.shape[1]
        touched = self.sheaves.touch(np.repeat(np.arange(sheaf), count), np.tile(sphere[:3], sheaf),
                                     np.tile(sphere[3], sheaf))
        return touched.reshape(sheaf, count).any(axis=0)


def _groups(patch: Patch, depth: int) -> np.ndarray:
    """Divide the triangles of a patch into up to 2**depth groups of neighbours (g, m); some triangles occur twice."""
    order = along_curve(patch.cameras.places[:, patch.cameras.corners].mean(axis=2).T)
    count = 2**min(depth, int(np.log2(len(order))))
    start = np.arange(count + 1) * len(order) // count
    return order[np.minimum(start[:-1, None] + np.arange(np.diff(start).max()), start[1:, None] - 1)]


def _sheaves(patch: Patch) -> Cones:
    """Return cones that bound all rays of the patch, each the rays of a group of triangles."""
    cameras, groups = patch.cameras, _groups(patch, SHEAVES)
    places, rays = (np.take(part, cameras.corners[groups], axis=1).reshape(3, len(groups), -1)
                    for part in (cameras.places, cameras.rays))
    return Cones.round(places, rays, WIDER)
