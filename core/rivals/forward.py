"""The method itself in the same ring: reflection meshes and points drawn by the z-buffer that the rivals share."""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh
from ..reflection import reflect
from ..result import ReflectionMesh
from ..support import Settings
from ..views import View
from .drawn_mesh import DrawnMesh
from .primary_hits import PrimaryHits
from .rival_picture import RivalPicture, Work
from .scenes import quartered, tessellated

UNREFINED = 1e9  # pixels: no displacement is larger, and nothing is split
DEFAULT = 0.5  # pixels
SIDES = 6  # sides of the polygon that approximates a disc


def refined(view: View, mirror: TriangleMesh, scene: TriangleMesh, tolerance: float, hits: PrimaryHits) -> RivalPicture:
    """Draw the general three-ray camera with refinement to a `tolerance` in pixels."""
    work = Work()
    return _drawn(view, reflect(view, mirror, scene, Settings(tolerance)), None, hits, work)


def unrefined(view: View, mirror: TriangleMesh, scene: TriangleMesh, times: int, hits: PrimaryHits) -> RivalPicture:
    """Draw the general three-ray camera without refinement, on a mirror with triangles quartered `times` times."""
    work = Work()
    finer = quartered(mirror, times)
    return _drawn(view, reflect(view, finer, scene, Settings(UNREFINED)), None, hits, work)


def parallel(view: View, mirror: TriangleMesh, scene: TriangleMesh, times: int, hits: PrimaryHits) -> RivalPicture:
    """Draw the parallel three-ray camera, on a mirror whose triangles were quartered `times` times."""
    work = Work()
    finer = quartered(mirror, times)
    return _drawn(view, reflect(view, finer, scene, Settings(DEFAULT, method="PARALLEL")), None, hits, work)


def points(view: View, mirror: TriangleMesh, scene: TriangleMesh, vertices: int, hits: PrimaryHits) -> RivalPicture:
    """Draw all images of about `vertices` points of the diffuse surface as flat discs.

    The points are the scene's own vertices if these are as many.
    """
    work = Work()
    own = scene, np.arange(len(scene.triangles))
    finer, source = own if vertices <= len(scene.positions) else tessellated(scene, vertices)
    triangle_of = np.zeros(len(finer.positions), dtype=np.int64)
    triangle_of[finer.triangles.ravel()] = np.repeat(source, 3)
    work.done("tessellation")
    return _drawn(view, reflect(view, mirror, finer, Settings(DEFAULT, method="POINTS")), triangle_of, hits, work)


def drawn_mesh(view: View, mesh: ReflectionMesh, hits: PrimaryHits) -> RivalPicture:
    """Draw a reflection mesh as a picture."""
    return _drawn(view, mesh, None, hits, Work())


def _drawn(view: View, mesh: ReflectionMesh, triangle_of: np.ndarray | None, hits: PrimaryHits,
           work: Work) -> RivalPicture:
    """Draw a mesh, or its discs if `triangle_of` (v,) gives the scene triangle of each scene vertex."""
    work.done("reflection")
    work.seconds.pop("reflection")
    work.seconds.update(mesh.seconds)
    # a mirror of small triangles has no cameras, only rays
    counts = {name: mesh.counts.get(name, 0) for name in ("projections", "nodes_visited", "rays")}
    descents = mesh.counts.get("cameras" if mesh.discs is None else "descents", 0)
    work.count(projections=counts["projections"], traversals=descents, nodes=counts["nodes_visited"],
               rays=counts["rays"])
    if triangle_of is None or mesh.discs is None:
        positions, triangles, source, point = mesh.positions, mesh.triangles, mesh.source_face, mesh.reflected_position
    else:
        positions, triangles = _polygons(mesh.positions, mesh.discs.axes)
        source = np.repeat(triangle_of[mesh.discs.source_vertex], SIDES - 2)
        point = np.repeat(mesh.reflected_position, SIDES, axis=0)
    shown = DrawnMesh(positions, triangles, source, point)
    seen = shown.seen(view, hits.mirror_depth, hits.scene_depth)
    work.count(triangles=len(triangles))
    work.done("drawing")
    return work.picture(view.resolution, *seen, shown)


def _polygons(middles: np.ndarray, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every disc as a fan of the regular polygon around it."""
    angle = 2.0 * np.pi * np.arange(SIDES) / SIDES
    ring = np.stack((np.cos(angle), np.sin(angle)), axis=1) / np.cos(np.pi / SIDES)
    corners = middles[:, None] + np.einsum("ck,nkx->ncx", ring, axes)
    fan = np.array([[0, k, k + 1] for k in range(1, SIDES - 1)])
    return corners.reshape(-1, 3), (SIDES * np.arange(len(corners))[:, None, None] + fan).reshape(-1, 3)
