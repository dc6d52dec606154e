"""Primary hits: the points of the mirror that the eye sees, shared by all baselines; their cost is counted apart."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import MirrorMap
from ..geometry import TriangleMesh, dot, unit
from ..support import ReflectionError
from ..trees import SceneTree
from ..views import View, draw
from .rival_picture import Work
from .tracing import cones_around

ABOVE = 1e-9  # share of the mirror's size: a corner that rises less above a plane touches it by rounding
TOUCHING = 1e-7  # share of a mesh's size: a hit nearer than this is the surface that the ray starts on


@dataclass(frozen=True)
class PrimaryHits:
    """Pixels (n) that show the mirror at their centre, along the rows from below, and the rays that leave it there.

    Attributes
    ----------
    pixel : (n,) int64
        Row times width plus column, sorted.
    face : (n,) int64
        Triangle of the mirror.
    place : (3, n) float64
        Q.
    ray : (3, n) float64
        Unit reflected directions, lifted where they would enter the flat triangle, as Cycles does.
    meets_mirror : (n,) bool
        Whether the ray may meet the mirror again; certainly not where False.
    mirror_depth, scene_depth : (height, width) float64
        Distances from the eye's plane of the mirror and of the scene as seen without it, infinite where none is.
    seconds, counts : dict
        As in a `RivalPicture`.
    """

    pixel: np.ndarray
    face: np.ndarray
    place: np.ndarray
    ray: np.ndarray
    meets_mirror: np.ndarray
    mirror_depth: np.ndarray
    scene_depth: np.ndarray
    seconds: dict
    counts: dict

    def shows_mirror(self) -> np.ndarray:
        """(height, width) bool"""
        found = np.zeros(self.mirror_depth.shape, dtype=bool)
        found.ravel()[self.pixel] = True
        return found


def primary_hits(view: View, mirror: TriangleMesh, scene: TriangleMesh) -> PrimaryHits:
    """Find the first hits on the mirror of the rays from the eye through the pixels' centres, by a z-buffer.

    Raises
    ------
    ReflectionError
        If no pixel shows the mirror, or the scene has no faces with an area.
    """
    work = Work()
    width, height = view.resolution
    if not (np.linalg.norm(scene.face_normals(), axis=1) > 0.0).any():
        raise ReflectionError("The reflected objects have no faces with an area; select objects with faces to reflect.")
    on_mirror, on_scene = (draw(view, mesh.positions, mesh.triangles) for mesh in (mirror, scene))
    work.count(projections=len(mirror.positions) + len(scene.positions))
    pixel = np.flatnonzero(on_mirror.depth < on_scene.depth)
    if not len(pixel):
        raise ReflectionError("The view does not see the mirror; turn the camera to the mirror or move it into view.")
    work.done("drawing")
    face = on_mirror.triangle[pixel]
    mirror_map = MirrorMap(view, mirror)
    place, ray = mirror_map.leave(face, on_mirror.weights[1:, pixel])
    ray = unit(ray)
    work.done("reflection")
    meets = _may_meet_mirror(mirror, face, place, ray)
    work.done("mirror in mirror")
    return PrimaryHits(pixel, face, place, ray, meets, on_mirror.depth.reshape(height, width),
                       on_scene.depth.reshape(height, width), work.seconds, work.counts)


def eye_depths(view: View, mirror: TriangleMesh, scene: TriangleMesh) -> tuple[np.ndarray, np.ndarray]:
    """Compute `mirror_depth` and `scene_depth` of `PrimaryHits`, (height, width) each, without the hits."""
    width, height = view.resolution
    mirror_depth, scene_depth = (draw(view, mesh.positions, mesh.triangles).depth.reshape(height, width)
                                 for mesh in (mirror, scene))
    return mirror_depth, scene_depth


def by_face(face: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the order (n,) that sorts rays by `face` (n,), the start (c,) of each run, and the face (c,) of each."""
    order = np.argsort(face, kind="stable")
    start = np.flatnonzero(np.diff(face[order], prepend=-1))
    return order, start, face[order[start]]


def _may_meet_mirror(mirror: TriangleMesh, face: np.ndarray, place: np.ndarray, ray: np.ndarray) -> np.ndarray:
    """Return True for rays (n,) that may meet the mirror again.

    These leave a face with another mirror triangle above its plane, in the cone of the face's rays.
    """
    order, start, owner = by_face(face)
    tree = SceneTree.build(mirror)
    run, triangle, _ = tree.trace(cones_around(place[:, order], ray[:, order], start))
    triangle = tree.given.triangle[triangle]
    normal = mirror.face_normals().T
    # rays of one run leave on one side, up to rounding
    side = np.sign(np.add.reduceat(dot(ray, normal[:, face])[order], start))
    size = np.ptp(mirror.positions[mirror.triangles.ravel()], axis=0).max()
    above = np.zeros(len(run), dtype=bool)
    plane = normal[:, owner] * side
    base = mirror.positions[mirror.triangles[owner, 0]].T
    for corner in range(3):
        offset = mirror.positions[mirror.triangles[triangle, corner]].T - base[:, run]
        above |= dot(offset, plane[:, run]) > ABOVE * size
    meets = np.zeros(len(mirror.triangles), dtype=bool)
    meets[owner[run[above & (owner[run] != triangle)]]] = True
    return meets[face]
