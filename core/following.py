"""Following: the faces of a reflection stay, and their vertices move to where the eye now sees their points.

While the eye, the mirror or the points move a little, each image moves a little too: Newton's method on the true map
starts where the image was and ends where it is. What comes into sight, or goes, is left to the next reflection.
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

STEPS = 3  # of Newton's method, before an image is looked for on other triangles of the mirror
LOOKS = 4  # times that images are followed between two looks for one that is lost
LIFTED = 3e-3  # of the viewing distance: faces that leave the mirror's triangles would sink behind its edges
AT_ONCE = 1 << 15  # images, before whoever waits has a turn
CLOSE = 1e-3  # of its viewing distance: where the ray of an image that was found may pass its point


@dataclass(frozen=True)
class FollowedImages:
    """Images of points of the scene, n of them, which can be followed.

    Attributes
    ----------
    source : (n,) int64
        Triangle of the scene that each point lies in.
    weights : (3, n) float64
        Its place there.
    face : (n,) int64
        Triangle of the mirror in which it is seen.
    uv : (2, n) float64
        Where there.
    distance : (n,) float64
        s: how many viewing distances, or in orthographic views units, the point is away from there.
    lost : (n,) bool
        Which were no images any more when they were followed last: they are looked for on other triangles of the
        mirror only every `LOOKS` times.
    times : int
        How often they have been followed.

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
        """The images at the vertices of a reflection with faces, of one bounce, as `view` sees them in `mirror`."""
        count = len(mesh.positions)
        source, face, weights = np.zeros(count, np.int64), np.full(count, -1), np.zeros((count, 3))
        corner = mesh.triangles.ravel()
        source[corner], weights[corner] = np.repeat(mesh.source_face, 3), mesh.source_weights.reshape(-1, 3)
        face[corner] = np.repeat(mesh.mirror_face, 3)
        places = rows(mesh.mirror_position)
        unknown = np.flatnonzero(face < 0)
        if len(unknown):
            # of faces that span several triangles of the mirror
            ahead = rows(view.directions(mesh.mirror_position[unknown]))
            tree = SceneTree.build(mirror)
            found, away = first_crossed(tree, places[:, unknown] - ahead, unit(ahead))
            there = np.abs(away - norm(ahead)) < CLOSE * norm(ahead)
            face[unknown] = np.where(there, tree.given.triangle[np.maximum(found, 0)], -1)
            # a ray may slip through between two triangles: then what its neighbours lie on
            near = np.zeros(count, dtype=np.int64)
            np.maximum.at(near, corner, np.repeat(face[mesh.triangles].max(axis=1), 3))
            face = np.where(face >= 0, face, near)
        mirror_map = MirrorMap(view, mirror)
        uv = drawn_in(mirror_map.coordinates(face, places))
        distance = norm(rows(mesh.reflected_position) - places) / norm(mirror_map.arriving(places))
        return cls(source, rows(weights), face, uv, distance, np.zeros(count, dtype=bool))

    def seen(self, view: View, mirror: TriangleMesh, scene: TriangleMesh, placement: str) -> Followed:
        """Where the view sees the images now, in a mirror and a scene of as many triangles as before."""
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
            # towards the eye, who sees no difference
            ahead = view.directions(positions.T).T
            positions = positions - LIFTED * (np.ptp(seen, axis=1).max() if view.orthographic else 1.0) * ahead
        images = replace(self, face=face, uv=uv, distance=s, lost=lost, times=self.times + 1)
        return Followed(images, positions.T, points.T, seen.T, path, lost)

    def _points(self, scene: TriangleMesh, some: slice) -> np.ndarray:
        """Where some of the points are now, (3, n)."""
        corners = scene.positions[scene.triangles[self.source[some]]]
        return rows(np.einsum("kn,nkc->nc", self.weights[:, some], corners))

    def _found(self, mirror_map: MirrorMap, points: np.ndarray, some: slice) -> tuple[np.ndarray, ...]:
        """The triangle of the mirror, the place in it and the distance of some of the images, and which are lost."""
        uv, s = mirror_map.locate(self.face[some], self.uv[:, some], self.distance[some], points, STEPS)
        face, found = self.face[some].copy(), np.minimum(uv.min(axis=0), 1.0 - uv.sum(axis=0)) >= -INSIDE
        # most of what is lost stays so, and costs the longest walks
        turn = (some.start + np.arange(len(found))) % LOOKS == self.times % LOOKS
        near = np.flatnonzero(~found & (turn | ~self.lost[some]))
        face[near], uv[:, near], s[near], found[near] = settle(
            mirror_map, face[near], uv[:, near], s[near], points[:, near])
        origin, ray = mirror_map.leave(face, uv)
        lost = ~(found & (s > 0.0) & (norm(origin + s * ray - points) < CLOSE * norm(ray)))
        return face, np.where(lost, drawn_in(np.nan_to_num(uv)), uv), s, lost


@dataclass(frozen=True)
class Followed:
    """Where images went.

    Attributes
    ----------
    images : FollowedImages
        To be followed further.
    positions, reflected_position, mirror_position : (n, 3) float64
    path_length : (n,) float64
        As of a `ReflectionMesh`.
    lost : (n,) bool
        Images that are no more; they stay at the rim of the mirror's triangle that they left.
    """

    images: FollowedImages
    positions: np.ndarray
    reflected_position: np.ndarray
    mirror_position: np.ndarray
    path_length: np.ndarray
    lost: np.ndarray
