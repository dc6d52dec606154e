"""The tree of vertices descended by the images that a patch shows of its nodes.

Newton's method finds the image of a node's middle, and the map's derivative there tells so closely where what the node
holds is seen that two more steps find it, without cones or cubics. A node smaller than what is seen is not opened.
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

NODES_AT_ONCE = 2048  # what they hold fits the cache
RAYS, SHEAVES = 9, 6  # two to the power of so many rays from all over the patch, and parts of it
FAR_AT_ONCE = 512  # points of which all these rays are asked
WIDER = 1.25  # than the rays at the corners of triangles: those between them
LARGER = 1.25  # than where a node's middle is seen: what the rest of it is magnified by at most


class Walk:
    """Newton's method for the images that a patch shows of points (3, n) from the eye."""

    def __init__(self, patch: Patch) -> None:
        self.patch, self.asked = patch, 0
        self.member = _groups(patch, RAYS)[:, 0]
        place, ray = patch.leaving(self.member, np.full((2, len(self.member)), 1.0 / 3.0))
        self.place, self.ray, self.length = place.T, unit(ray).T, norm(ray)

    def images(self, points: np.ndarray, nodes: NodeImages, node: np.ndarray) -> tuple:
        """As `find`, from where the `nodes` tell, of which each point lies in one, `node` (n,): most are found so."""
        self.asked += points.shape[1]
        place = nodes.around(node, points)
        member, uv, s, found = find_near(self.patch, nodes.member[node], place[:2], place[2], points)
        return member, uv, s, found & nodes.found[node]

    def afresh(self, points: np.ndarray) -> tuple:
        """The same from where rays pass near."""
        parts = [self.near(points[:, part]) for part in portions(max(points.shape[1], 1), FAR_AT_ONCE)]
        member, uv, s = (np.concatenate(part, axis=-1) for part in zip(*parts))
        return find(self.patch, member, uv, s, points)

    def near(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Triangle, (u, v) and s of the ray that passes nearest to each point, of some all over the patch."""
        middle = self.place.mean(axis=0)
        place, point = self.place - middle, points.T - middle
        along = np.maximum(point @ self.ray.T - (place * self.ray).sum(axis=1), 0.0)
        nearest = ((place**2).sum(axis=1) - 2.0 * (point @ place.T) - along * along).argmin(axis=1)
        s = along[np.arange(len(point)), nearest] / self.length[nearest]
        return self.member[nearest], np.full((2, len(s)), 1.0 / 3.0), s


@dataclass(frozen=True)
class NodeImages:
    """Images of the middles of nodes (k).

    Attributes
    ----------
    found : (k,) bool, which of them there are
    point : (3, k) float64, from the eye
    member : (k,) int64, triangles of the patch
    place : (3, k) float64, u, v and s
    change : (9, k) float64, derivatives of these three by the point
    scale : (k,) float64, pixels that a scene unit there is long at most
    """

    found: np.ndarray
    point: np.ndarray
    member: np.ndarray
    place: np.ndarray
    change: np.ndarray
    scale: np.ndarray

    @classmethod
    def of(cls, walk: Walk, points: np.ndarray, above: NodeImages | None, parent: np.ndarray) -> NodeImages:
        """Images of points (3, k) from the eye, in nodes `parent` (k,) of those above."""
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
        """Places (3, n) at which `points` (3, n) from the eye, in nodes (n,), should be seen by the derivatives."""
        way, place = points - columns(self.point, node), columns(self.place, node)
        for row, change in zip(place, columns(self.change, node).reshape(3, 3, -1)):
            row += dot(change, way)
        return place


@dataclass(frozen=True)
class NodeVertices:
    """Vertices (n) that are to be looked for.

    Attributes
    ----------
    nodes : NodeImages
    node : (n,) int64, which of the nodes each lies in
    vertex : (n,) int64
    stood : (n,) float64
        Radius of the sphere round the vertices that this one stands for, 0 where it stands for itself alone.
    """

    nodes: NodeImages
    node: np.ndarray
    vertex: np.ndarray
    stood: np.ndarray


class Descent:
    """How the vertices of a tree come to a patch, of nodes smaller than `least` pixels one, or one of each `part` (v,).

    Attributes
    ----------
    standing : (v,) int64, for each vertex of the mesh the one that stands for it
    """

    def __init__(self, walk: Walk, tree: VertexTree, least: float, part: np.ndarray | None = None) -> None:
        self.walk, self.tree, self.least, self.part = walk, tree, least, part
        self.sheaves = _sheaves(walk.patch)
        self.standing = np.arange(len(tree.mesh.positions))
        self._small: list[tuple[int, np.ndarray, np.ndarray]] = []

    def vertices(self) -> Generator[NodeVertices, None, None]:
        """Those that the patch may show; of a small node one."""
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
        """Which nodes (n,), seen about where the images (n,) tell, are to be opened; vertices that stand for others."""
        scale = LARGER * images.scale[row]
        small = images.found[row] & self.tree.small(level, node, scale, self.least)
        some = np.flatnonzero(small)
        stand = self._stand(level, node[some])
        self._small.append((level, node[some], scale[some]))
        return ~small, NodeVertices(images, row[some][stand.node], stand.vertex, stand.radius)

    def _stand(self, level: int, node: np.ndarray) -> StandIns:
        """The vertices that stand for all in nodes (n,) from now on."""
        stand = self.tree.stand_ins(level, node, self.part)
        self.standing[stand.held] = stand.vertex[stand.own]
        return stand

    def fall_apart(self, asked: np.ndarray, least: float) -> None:
        """Let small nodes that hold a vertex which some `asked` (v,) one stands for fall apart into such as are smaller
        than `least` pixels."""
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
        """Which spheres (4, n) some ray of the patch may touch."""
        sheaf, count = len(self.sheaves.radius), sphere.shape[1]
        touched = self.sheaves.touch(np.repeat(np.arange(sheaf), count), np.tile(sphere[:3], sheaf),
                                     np.tile(sphere[3], sheaf))
        return touched.reshape(sheaf, count).any(axis=0)


def _groups(patch: Patch, depth: int) -> np.ndarray:
    """The triangles of a patch in 2**depth groups (g, m), or fewer, of those that lie together; some twice."""
    order = along_curve(patch.cameras.places[:, patch.cameras.corners].mean(axis=2).T)
    count = 2**min(depth, int(np.log2(len(order))))
    start = np.arange(count + 1) * len(order) // count
    return order[np.minimum(start[:-1, None] + np.arange(np.diff(start).max()), start[1:, None] - 1)]


def _sheaves(patch: Patch) -> Cones:
    """Cones round all rays of the patch, each round those of many triangles."""
    cameras, groups = patch.cameras, _groups(patch, SHEAVES)
    places, rays = (np.take(part, cameras.corners[groups], axis=1).reshape(3, len(groups), -1)
                    for part in (cameras.places, cameras.rays))
    return Cones.round(places, rays, WIDER)
