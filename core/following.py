"""Incremental update of a reflection: faces stay, and vertices move to the new images of their points.

If the eye, the mirror or the points move a little, each image moves a little too. Newton's method on the true map
starts at the old image and ends at the new one. Points that become visible or hidden need a new reflection.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .cameras import INSIDE, MirrorMap, drawn_in, settle
from .geometry import TriangleMesh, norm, rows, unit
from .result import ReflectionMesh, place
from .support import portions
from .trees import SceneTree, first_crossed
from .views import View

STEPS = 3  # Newton steps before an image is searched on other triangles of the mirror
LOOKS = 4  # number of updates between two searches for a lost image
LIFTED = 3e-3  # share of the viewing distance: offset towards the eye, so that the mirror's edges do not hide faces
AT_ONCE = 1 << 15  # images per chunk, between two cooperative yields
CLOSE = 1e-3  # share of the viewing distance: largest distance at which a ray counts as passing through a point


@dataclass(frozen=True)
class FollowedImages:
    """Images of points of the scene, n of them, which can be followed.

    Attributes
    ----------
    source : (n,) int64
        Triangle of the scene that each point lies in.
    weights : (3, n) float64
        Barycentric coordinates of the point in that triangle.
    face : (n,) int64
        Triangle of the mirror in which it is seen.
    uv : (2, n) float64
        Barycentric coordinates (u, v) of the image in that triangle.
    distance : (n,) float64
        Distance s from the image's place to the point, in viewing distances (orthographic views: scene units).
    lost : (n,) bool
        True for points without an image at the last update. They are searched on other mirror triangles only at every
        `LOOKS`-th update.
    times : int
        Number of updates so far.

    Examples
    --------
    >>> import numpy as np
    >>> from core import FollowedImages, TriangleMesh, View, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> images = FollowedImages.of(view, mirror, reflect(view, mirror, scene))
    >>> raised = TriangleMesh(scene.positions + (0, 0, 0.5), scene.triangles)
    >>> now = images.seen(view, mirror, raised, "VIRTUAL")
    >>> now.positions[:, 2].round(6).min().item()  # as deep behind the mirror as the scene is high by now
    -1.9
    """

    source: np.ndarray
    weights: np.ndarray
    face: np.ndarray
    uv: np.ndarray
    distance: np.ndarray
    lost: np.ndarray
    times: int = 0

    @classmethod
    def of(cls, view: View, mirror: TriangleMesh, mesh: ReflectionMesh) -> FollowedImages:
        """Return the images at the vertices of `mesh`, a reflection with faces and one bounce, seen in `mirror`."""
        count = len(mesh.positions)
        source, face, weights = np.zeros(count, np.int64), np.full(count, -1), np.zeros((count, 3))
        corner = mesh.triangles.ravel()
        source[corner], weights[corner] = np.repeat(mesh.source_face, 3), mesh.source_weights.reshape(-1, 3)
        face[corner] = np.repeat(mesh.mirror_face, 3)
        places = rows(mesh.mirror_position)
        unknown = np.flatnonzero(face < 0)
        if len(unknown):
            # trace rays to find the mirror triangle of faces that span several
            ahead = rows(view.directions(mesh.mirror_position[unknown]))
            tree = SceneTree.build(mirror)
            found, away = first_crossed(tree, places[:, unknown] - ahead, unit(ahead))
            there = np.abs(away - norm(ahead)) < CLOSE * norm(ahead)
            face[unknown] = np.where(there, tree.given.triangle[np.maximum(found, 0)], -1)
            # a ray may pass between two triangles: then take the triangle of its face's other corners
            near = np.zeros(count, dtype=np.int64)
            np.maximum.at(near, corner, np.repeat(face[mesh.triangles].max(axis=1), 3))
            face = np.where(face >= 0, face, near)
        mirror_map = MirrorMap(view, mirror)
        uv = drawn_in(mirror_map.coordinates(face, places))
        distance = norm(rows(mesh.reflected_position) - places) / norm(mirror_map.arriving(places))
        return cls(source, rows(weights), face, uv, distance, np.zeros(count, dtype=bool))

    def seen(self, view: View, mirror: TriangleMesh, scene: TriangleMesh, placement: str) -> Followed:
        """Return the images' new positions for the current `view`, `mirror` and `scene`.

        The mirror and the scene must have the same triangles as before; `placement` is one of `PLACEMENTS`.
        """
        mirror_map = MirrorMap(view, mirror)
        face, uv, s, points, seen = (np.empty_like(self.face), np.empty_like(self.uv), np.empty_like(self.distance),
                                     np.empty_like(self.weights), np.empty_like(self.weights))
        lost, path = np.empty_like(self.lost), np.empty_like(self.distance)
        for some in portions(len(face), AT_ONCE):
            points[:, some] = self._points(scene, some)
            face[some], uv[:, some], s[some], lost[some] = self._found(mirror_map, points[:, some], some)
            seen[:, some] = mirror_map.places(face[some], uv[:, some])
            path[some] = norm(points[:, some] - seen[:, some])
            s[some] = np.where(lost[some], path[some] / norm(mirror_map.arriving(seen[:, some])), s[some])
        positions = place(view, seen, path, placement)
        if placement == "LAYERED" and len(path):
            # move the vertices towards the eye, which does not change the picture
            ahead = view.directions(positions.T).T
            positions = positions - LIFTED * (np.ptp(seen, axis=1).max() if view.orthographic else 1.0) * ahead
        images = replace(self, face=face, uv=uv, distance=s, lost=lost, times=self.times + 1)
        return Followed(images, positions.T, points.T, seen.T, path, lost)

    def _points(self, scene: TriangleMesh, some: slice) -> np.ndarray:
        """Return the world-space positions (3, k) of the points `some` on the current scene."""
        corners = scene.positions[scene.triangles[self.source[some]]]
        return rows(np.einsum("kn,nkc->nc", self.weights[:, some], corners))

    def _found(self, mirror_map: MirrorMap, points: np.ndarray, some: slice) -> tuple[np.ndarray, ...]:
        """Find `some` of the images again on the current mirror.

        Returns
        -------
        face : (k,) int64, triangle of the mirror
        uv : (2, k) float64, place in that triangle
        s : (k,) float64, distance to the point
        lost : (k,) bool, True where no image was found
        """
        uv, s = mirror_map.locate(self.face[some], self.uv[:, some], self.distance[some], points, STEPS)
        face, found = self.face[some].copy(), np.minimum(uv.min(axis=0), 1.0 - uv.sum(axis=0)) >= -INSIDE
        # most lost images stay lost, and they cost the longest walks: search each at every LOOKS-th update only
        turn = (some.start + np.arange(len(found))) % LOOKS == self.times % LOOKS
        near = np.flatnonzero(~found & (turn | ~self.lost[some]))
        face[near], uv[:, near], s[near], found[near] = settle(
            mirror_map, face[near], uv[:, near], s[near], points[:, near])
        origin, ray = mirror_map.leave(face, uv)
        lost = ~(found & (s > 0.0) & (norm(origin + s * ray - points) < CLOSE * norm(ray)))
        return face, np.where(lost, drawn_in(np.nan_to_num(uv)), uv), s, lost


@dataclass(frozen=True)
class Followed:
    """New positions of followed images.

    Attributes
    ----------
    images : FollowedImages
        The same images at their new places, for the next update.
    positions, reflected_position, mirror_position : (n, 3) float64
        In world space, with the meaning that they have in a `ReflectionMesh`.
    path_length : (n,) float64
        In scene units, with the meaning that it has in a `ReflectionMesh`.
    lost : (n,) bool
        True for points without an image; they stay at the border of the mirror triangle that they left.
    """

    images: FollowedImages
    positions: np.ndarray
    reflected_position: np.ndarray
    mirror_position: np.ndarray
    path_length: np.ndarray
    lost: np.ndarray
