"""A rival of Blender's own: backward ray tracing through `mathutils.bvhtree.BVHTree`, a ray for each pixel.

The tree is C and counts in float32, but takes one ray a call: the loop over the rays is Python's, and most of the time
is spent in it. The place on the triangle that it names is then found in float64.
"""
from __future__ import annotations

import numpy as np
from mathutils.bvhtree import BVHTree

from ...core import TriangleMesh, View
from ...core.rivals import ITSELF, PrimaryHits, Rival, RivalPicture, Work, cast_by_blocks
from ...core.rivals.tracing import plane_distance

TOUCHING = 1e-5  # relative to a mesh's size; single precision cannot separate closer hits from the ray's start
PASSES = 4  # number of hits on the ray's own triangle that are skipped


def traced_by_blender(view: View, mirror: TriangleMesh, scene: TriangleMesh, block: int,
                      hits: PrimaryHits) -> RivalPicture:
    """Do `core.rivals.ray_tracing.traced` with Blender's tree."""
    work = Work()
    tree = _Tree(scene)
    mirror_tree = _Tree(mirror) if hits.meets_mirror.any() else None
    work.done("tree")

    def cast(ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place, way = hits.place[:, ray], hits.ray[:, ray]
        triangle, distance = tree.first_hits(place, way)
        work.count(rays=len(ray), traversals=len(ray))
        asked = np.flatnonzero(hits.meets_mirror[ray])
        if mirror_tree is not None and len(asked):
            _, again = mirror_tree.first_hits(place[:, asked], way[:, asked], hits.face[ray[asked]])
            work.count(rays=len(asked), traversals=len(asked))
            triangle[asked[again < distance[asked]]] = ITSELF
        return triangle, place + np.where(triangle >= 0, distance, 0.0) * way

    triangle, position = cast_by_blocks(hits, block, cast)
    work.done("rays")
    return work.picture(view.resolution, hits.pixel, triangle, position)


class _Tree:
    """Blender's tree of a mesh, about the mesh's middle so that single precision goes as far as it can."""

    def __init__(self, mesh: TriangleMesh) -> None:
        used = mesh.positions[mesh.triangles.ravel()]
        self.mesh, self.middle = mesh, 0.5 * (used.min(axis=0) + used.max(axis=0))
        self.touching = TOUCHING * float(np.linalg.norm(np.ptp(used, axis=0)))
        self.tree = BVHTree.FromPolygons((mesh.positions - self.middle).tolist(), mesh.triangles.tolist(),
                                         all_triangles=True)

    def first_hits(self, places: np.ndarray, rays: np.ndarray,
                   own: np.ndarray | None = None) -> tuple[np.ndarray, np.ndarray]:
        """Return the first triangle (n,), -1 for none, and its distance (n,), infinite for none, of rays (3, n)."""
        count = places.shape[1]
        triangle, skip = np.full(count, -1), np.full(count, self.touching)
        left, cast = np.arange(count), self.tree.ray_cast
        for _ in range(PASSES):
            starts = (places[:, left] + skip[left] * rays[:, left] - self.middle[:, None]).T.tolist()
            found = [cast(start, way)[2:] for start, way in zip(starts, rays[:, left].T.tolist())]
            met = np.array([-1 if index is None else index for index, _ in found], dtype=np.int64)
            triangle[left] = met
            again = (met == own[left]) & (met >= 0) if own is not None else np.zeros(len(left), dtype=bool)
            triangle[left[again]] = -1
            skip[left[again]] += np.array([far for _, far in found], dtype=object)[again].astype(float) + self.touching
            left = left[again]
            if not len(left):
                break
        hit = np.flatnonzero(triangle >= 0)
        distance = np.full(count, np.inf)
        corners = np.moveaxis(self.mesh.positions[self.mesh.triangles[triangle[hit]]], 2, 0)
        distance[hit] = plane_distance(corners, places[:, hit], rays[:, hit])
        return triangle, distance


RIVAL = Rival("Ray tracing through mathutils' BVHTree", "pixels across a ray's block", (8, 4, 2, 1), traced_by_blender)
