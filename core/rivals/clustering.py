"""Ray tracing with clustering: one traversal of the tree for all rays of a mirror triangle.

The bounding cone of the rays goes through the tree; the rays are then tested only against the triangles that it found.
On large mirror triangles a cluster may also be cut into square tiles of the picture.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, groups, ranges
from ..trees import BoxTree, SceneTree, meet
from ..views import View
from .primary_hits import TOUCHING, PrimaryHits
from .rival_picture import ITSELF, RivalPicture, Work
from .tracing import cones_around

PAIRS_AT_ONCE = 500_000


def clustered(view: View, mirror: TriangleMesh, scene: TriangleMesh, tile: int, hits: PrimaryHits) -> RivalPicture:
    """Trace clusters: all pixels of a mirror triangle, within a tile of `tile` x `tile` pixels; 0 leaves triangles
    whole, as the talk has it."""
    work = Work()
    met = _Met.of(scene)
    itself = _Met.of(mirror) if hits.meets_mirror.any() else None
    work.done("tree")
    order, start = _clusters(hits, tile, view.resolution[0])
    nearest, triangle = met.first(hits, order, start, work)
    if itself is not None:
        size = np.diff(np.append(start, len(order)))
        chosen = hits.meets_mirror[order[start]]
        part = np.flatnonzero(np.repeat(chosen, size))
        # the triangle that a ray leaves is touched, not met
        distance, _ = itself.first(hits, order[part], np.cumsum(size[chosen]) - size[chosen], work)
        triangle[part[distance < nearest[part]]] = ITSELF
    position = hits.place[:, order] + np.where(np.isfinite(nearest), nearest, 0.0) * hits.ray[:, order]
    work.done("rays")
    return work.picture(view.resolution, hits.pixel[order], triangle, position)


def _clusters(hits: PrimaryHits, tile: int, width: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the order (n,) that sorts rays by cluster, and the start (c,) of each cluster in it."""
    keys = [hits.face]
    if tile:
        keys += [hits.pixel % width // tile, hits.pixel // width // tile]
    _, cluster = groups(*keys)
    order = np.argsort(cluster, kind="stable")
    return order, np.flatnonzero(np.diff(cluster[order], prepend=-1))


@dataclass(frozen=True)
class _Met:
    """A mesh that clusters may meet: its tree, and the frames of its triangles in their own order."""

    tree: SceneTree
    leaf: BoxTree

    @classmethod
    def of(cls, mesh: TriangleMesh) -> _Met:
        return cls(SceneTree.build(mesh), BoxTree.of_one_leaf(mesh))

    def first(self, hits: PrimaryHits, order: np.ndarray, start: np.ndarray,
              work: Work) -> tuple[np.ndarray, np.ndarray]:
        """Find distance (n,) and triangle (n,) of the first hit of the rays `order` (n,); clusters begin at `start`."""
        place, ray = hits.place[:, order], hits.ray[:, order]
        cluster, triangle, visited = self.tree.trace(cones_around(place, ray, start))
        work.count(traversals=len(start), nodes=visited, rays=len(order))
        work.done("cones")
        turn = np.argsort(cluster, kind="stable")
        triangle = self.tree.given.triangle[triangle[turn]]
        offered = np.bincount(cluster, minlength=len(start))
        first = np.cumsum(offered) - offered
        size = np.diff(np.append(start, len(order)))
        work.count(intersections=int((offered * size).sum()))
        place = place - self.leaf.middle[:, None]
        nearest, found = np.full(len(order), np.inf), np.full(len(order), -1)
        of_ray = np.repeat(np.arange(len(start)), size)
        part_of = np.cumsum(offered[of_ray]) // PAIRS_AT_ONCE
        for part in np.split(np.arange(len(order)), np.flatnonzero(np.diff(part_of)) + 1):
            entry, which = ranges(first[of_ray[part]], offered[of_ray[part]])
            at, member = triangle[entry], part[which]
            distance, inside = meet(self.leaf, at, place, ray, member)
            good = np.flatnonzero(inside & (distance > TOUCHING * self.leaf.size))
            # farthest first: of the hits of one ray the nearest is written last
            good = good[np.argsort(-distance[good], kind="stable")]
            nearest[member[good]], found[member[good]] = distance[good], at[good]
        work.done("rays")
        return nearest, found
