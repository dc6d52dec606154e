"""The patch: the part of a mirror in which a diffuse point has one image at the most, and which hides nothing.

Rays that leave a smooth convex or flat part of a mirror spread and never cross: none of its triangles turns over on its
way, however far it is moved along its rays. There a vertex has one image at the most, whatever start leads to it.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, MirrorMap, PictureCells, may_fold, picture_areas
from ..geometry import connected, corners_beyond, dot, in_order, norm, others, rows
from ..views import View

MARGIN = 8.0  # pixels: by how much the picture's grid is larger than the patch
SPECK = 1e-6  # of the distance from the eye
SMOOTH = 0.5  # cosine: normals at the corners of a triangle that differ by more turn too much between them


@dataclass(frozen=True)
class Patch:
    """Triangles (k) of one mirror, whole and visible, side by side.

    Attributes
    ----------
    cameras : Cameras, those of the triangles
    mirror_map : MirrorMap, the cameras'
    face : (k,) int64, the mirror's triangles, rising
    across : (k, 3) int64, the triangle of the patch beyond the side opposite to each corner, -1 at its border
    shape : (18, k) float64
        Place of the first corner from the eye, the ways from it to the other two, and the same of the normals.
    border : PictureCells, what lies near the border
    """

    cameras: Cameras
    mirror_map: MirrorMap
    face: np.ndarray
    across: np.ndarray
    shape: np.ndarray
    border: PictureCells

    @classmethod
    def largest(cls, cameras: Cameras, eligible: np.ndarray) -> Patch | None:
        """The patch that is largest in the picture, of the `eligible` (n,) cameras, each a whole triangle; None where
        none are."""
        mirror_map = cameras.mirror_map
        assert isinstance(mirror_map, MirrorMap)
        cameras = cameras.select(np.flatnonzero(eligible))
        cameras = cameras.select(_smooth(mirror_map, cameras.face) & ~may_fold(cameras))
        if not len(cameras):
            return None
        cameras = cameras.select(in_order(cameras.face))
        label = _parts(corners_beyond(cameras.corners) // 3)
        size = np.bincount(label, picture_areas(cameras))
        cameras = cameras.select(label == np.argmax(size))
        surface, face = mirror_map.surface, cameras.face
        # cameras begin at another corner than their triangles
        places = cameras.places[:, cameras.corners]
        turn = np.argmin(norm(places - surface.a[:, face, None]), axis=1)
        corners = np.take_along_axis(cameras.corners, (turn[:, None] + np.arange(3)) % 3, axis=1)
        eye = 0.0 if mirror_map.orthographic else mirror_map.eye
        shape = np.concatenate([part[:, face] for part in
                                (surface.a - eye, surface.u, surface.v, surface.normal, surface.normal_u,
                                 surface.normal_v)])
        across = corners_beyond(corners) // 3
        border = _border(cameras.view, cameras.places, corners, across)
        return None if border is None else cls(cameras, mirror_map, face, across, np.ascontiguousarray(shape), border)

    def __len__(self) -> int:
        return len(self.face)

    @property
    def view(self) -> View:
        return self.mirror_map.view

    @property
    def eye(self) -> np.ndarray:
        """(3, 1): what places and points are told from; the origin for an orthographic view."""
        return np.zeros((3, 1)) if self.mirror_map.orthographic else self.mirror_map.eye

    def places(self, member: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Places (3, n) from the eye."""
        k = self.shape[:9].take(member, axis=1)
        return k[:3] + uv[0] * k[3:6] + uv[1] * k[6:9]

    def arriving(self, places: np.ndarray) -> np.ndarray:
        """View directions (3, n) of places from the eye."""
        return np.broadcast_to(self.mirror_map.forward, places.shape) if self.mirror_map.orthographic else places

    def leaving(self, member: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places from the eye and the rays that leave there, (3, n) each."""
        place, ray = self.mirror_map.leave(self.face[member], uv)
        return place - self.eye, ray

    def far(self, corners: np.ndarray) -> np.ndarray:
        """To what length (n,) triangles with corners (3, 3, n) from the eye slide a share of towards it."""
        if self.mirror_map.orthographic:
            return np.full(corners.shape[2], np.ptp(self.shape[:3], axis=1).max())
        return norm(corners).max(axis=0)

    def scale(self, places: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Pixels (n,) that a scene unit is long at most where points are seen at `places` (3, n) from the eye: as long
        as in a flat mirror, or less."""
        length = np.sqrt((self.view.pixel_gradients(places + self.eye) ** 2).sum(axis=(0, 1)))
        return length if self.mirror_map.orthographic else length / (1.0 + s)

    def coordinates(self, member: np.ndarray, places: np.ndarray) -> np.ndarray:
        """(u, v) of places from the eye."""
        return self.mirror_map.coordinates(self.face[member], places + self.eye)

    def pixels(self, places: np.ndarray) -> np.ndarray:
        """Picture positions (2, n) of places from the eye."""
        return rows(self.view.pixels((places + self.eye).T))


def speck(view: View, sphere: np.ndarray) -> bool:
    """Whether what lies in a sphere (4,) is so small from where the eye is that places told from there have no digits
    left."""
    return bool(sphere[3] < SPECK * norm(sphere[:3] - view.eye))


def _border(view: View, places: np.ndarray, corners: np.ndarray, across: np.ndarray) -> PictureCells | None:
    """Where in the picture the border of triangles with `corners` (k, 3) among `places` (3, n) lies; None where some
    of them lie behind the eye."""
    used = corners.ravel()
    if not (view.depths(places[:, used].T) > 0.0).all():
        return None
    spots = rows(view.pixels(places.T))
    low, high = spots[:, used].min(axis=1), spots[:, used].max(axis=1)
    if not np.isfinite(low + high).all():
        return None
    row, side = np.nonzero(across < 0)
    start, end = (spots[:, corners[row, corner]] for corner in others(side))
    return PictureCells.empty(low - MARGIN, high + MARGIN).with_lines(start, end)


def _smooth(mirror_map: MirrorMap, face: np.ndarray) -> np.ndarray:
    """Faces whose normals stay together, and whose rays need not be lifted."""
    surface = mirror_map.surface
    a = surface.normal[:, face]
    b, c = a + surface.normal_u[:, face], a + surface.normal_v[:, face]
    return (dot(a, b) > SMOOTH) & (dot(b, c) > SMOOTH) & (dot(c, a) > SMOOTH) & ~mirror_map.grazing[face]


def _parts(across: np.ndarray) -> np.ndarray:
    """(k,): triangles that hang together by their sides have the same number."""
    own = np.arange(len(across))[:, None]
    return connected(np.concatenate((own, np.where(across >= 0, across, own)), axis=1))
