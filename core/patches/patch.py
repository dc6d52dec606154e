"""The patch: a single-image region of a mirror, in which a diffuse point has at most one image and nothing is hidden.

Rays that leave a smooth convex or flat part of a mirror spread and never cross: no triangle turns over, however far it
is moved along its rays. There a vertex has at most one image, and Newton's method finds it from any start.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, MirrorMap, PictureCells, may_fold, picture_areas
from ..geometry import connected, corners_beyond, dot, in_order, norm, others, rows
from ..views import View

MARGIN = 8.0  # pixels: margin of the picture's grid around the patch
SPECK = 1e-6  # radius over distance from the eye, below which coordinates relative to the eye lose precision
SMOOTH = 0.5  # smallest cosine between the normals at a triangle's corners


@dataclass(frozen=True)
class Patch:
    """Connected triangles (k) of one mirror that are uncut and completely visible.

    Attributes
    ----------
    cameras : Cameras, one for each triangle
    mirror_map : MirrorMap, of the cameras
    face : (k,) int64, indices of the mirror's triangles, rising
    across : (k, 3) int64, the triangle of the patch across the side opposite to each corner, -1 at the border
    shape : (18, k) float64
        First corner relative to the eye, vectors from it to the other two corners, and the same for the normals.
    border : PictureCells, marked near the border of the patch
    """

    cameras: Cameras
    mirror_map: MirrorMap
    face: np.ndarray
    across: np.ndarray
    shape: np.ndarray
    border: PictureCells

    @classmethod
    def largest(cls, cameras: Cameras, eligible: np.ndarray) -> Patch | None:
        """Find the patch that is largest in the picture; return None if there is none.

        `eligible` (n,) bool marks cameras that may belong to it; each must be an uncut triangle.
        """
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
        # rotate the cameras' corners, so that each starts at the first corner of its triangle
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
        """Origin (3, 1) of the patch's coordinates: the eye, or for an orthographic view the world origin."""
        return np.zeros((3, 1)) if self.mirror_map.orthographic else self.mirror_map.eye

    def places(self, member: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Return places (3, n) relative to the eye, at `uv` (2, n) on triangles `member` (n,) of the patch."""
        k = self.shape[:9].take(member, axis=1)
        return k[:3] + uv[0] * k[3:6] + uv[1] * k[6:9]

    def arriving(self, places: np.ndarray) -> np.ndarray:
        """Return the view directions (3, n) of `places` (3, n), which are relative to the eye."""
        return np.broadcast_to(self.mirror_map.forward, places.shape) if self.mirror_map.orthographic else places

    def leaving(self, member: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return places relative to the eye, and the rays that leave there, (3, n) each."""
        place, ray = self.mirror_map.leave(self.face[member], uv)
        return place - self.eye, ray

    def far(self, corners: np.ndarray) -> np.ndarray:
        """Return the length (n,) that the offset of layers towards the eye is a share of.

        `corners` (3, 3, n) of triangles are relative to the eye, as [component, corner, triangle].
        """
        if self.mirror_map.orthographic:
            return np.full(corners.shape[2], np.ptp(self.shape[:3], axis=1).max())
        return norm(corners).max(axis=0)

    def scale(self, places: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Return an upper bound (n,) on the image length of one scene unit, in pixels: that in a flat mirror.

        The points' images are at `places` (3, n) relative to the eye; `s` (n,) are their distances along the rays.
        """
        length = np.sqrt((self.view.pixel_gradients(places + self.eye) ** 2).sum(axis=(0, 1)))
        return length if self.mirror_map.orthographic else length / (1.0 + s)

    def coordinates(self, member: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Return (u, v) (2, n) of `places` (3, n), relative to the eye, on triangles `member` (n,)."""
        return self.mirror_map.coordinates(self.face[member], places + self.eye)

    def pixels(self, places: np.ndarray) -> np.ndarray:
        """Return picture positions (2, n), in pixels, of `places` (3, n) relative to the eye."""
        return rows(self.view.pixels((places + self.eye).T))


def speck(view: View, sphere: np.ndarray) -> bool:
    """Return True if a sphere (4,) is so small and far that coordinates relative to the eye lose too much precision."""
    return bool(sphere[3] < SPECK * norm(sphere[:3] - view.eye))


def _border(view: View, places: np.ndarray, corners: np.ndarray, across: np.ndarray) -> PictureCells | None:
    """Mark the border of a patch in the picture; return None if some corners lie behind the eye.

    Parameters
    ----------
    places : (3, n) float64, in world space
    corners : (k, 3) int64, corners of the triangles
    across : (k, 3) int64, triangle across the side opposite to each corner, -1 at the border
    """
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
    """Return True (n,) for faces whose corner normals differ little, and whose rays need not be lifted."""
    surface = mirror_map.surface
    a = surface.normal[:, face]
    b, c = a + surface.normal_u[:, face], a + surface.normal_v[:, face]
    return (dot(a, b) > SMOOTH) & (dot(b, c) > SMOOTH) & (dot(c, a) > SMOOTH) & ~mirror_map.grazing[face]


def _parts(across: np.ndarray) -> np.ndarray:
    """Return component numbers (k,): triangles connected by sides have the same one. `across` (k, 3) are neighbours."""
    own = np.arange(len(across))[:, None]
    return connected(np.concatenate((own, np.where(across >= 0, across, own)), axis=1))
