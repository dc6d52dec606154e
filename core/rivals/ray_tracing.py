"""Backward ray tracing: a ray from every pixel's place on the mirror to the first triangle that it meets."""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh
from ..trees import BoxTree, first_hits
from ..views import View
from .pixel_blocks import cast_by_blocks
from .primary_hits import TOUCHING, PrimaryHits
from .rival_picture import ITSELF, RivalPicture, Work


def traced(view: View, mirror: TriangleMesh, scene: TriangleMesh, block: int, hits: PrimaryHits) -> RivalPicture:
    """Trace a ray for each `block` x `block` pixels, and for each pixel where those of a block disagree."""
    work = Work()
    tree = BoxTree.build(scene)
    mirror_tree = BoxTree.build(mirror) if hits.meets_mirror.any() else None
    work.done("tree")

    def cast(ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        place, way = hits.place[:, ray], hits.ray[:, ray]
        found = first_hits(tree, place, way, least=TOUCHING * tree.size)
        work.count(rays=len(ray), traversals=len(ray), intersections=found.intersections, nodes=found.nodes)
        position = place + np.where(np.isfinite(found.distance), found.distance, 0.0) * way
        hidden = behind_mirror(mirror_tree, hits, ray, found.distance, work)
        return np.where(hidden, ITSELF, found.triangle), position

    triangle, position = cast_by_blocks(hits, block, cast)
    work.done("rays")
    return work.picture(view.resolution, hits.pixel, triangle, position)


def behind_mirror(tree: BoxTree | None, hits: PrimaryHits, ray: np.ndarray, distance: np.ndarray,
                  work: Work) -> np.ndarray:
    """Return True for rays (m,) of the primary hits that meet the mirror before `distance` (m,).

    Only rays that may meet the mirror are traced.
    """
    hidden = np.zeros(len(ray), dtype=bool)
    asked = np.flatnonzero(hits.meets_mirror[ray])
    if tree is not None and len(asked):
        part = ray[asked]
        found = first_hits(tree, hits.place[:, part], hits.ray[:, part], least=TOUCHING * tree.size,
                           limit=distance[asked], asked=lambda of, triangle: triangle != hits.face[part[of]])
        work.count(rays=len(part), traversals=len(part), intersections=found.intersections, nodes=found.nodes)
        hidden[asked] = found.triangle >= 0
    return hidden
