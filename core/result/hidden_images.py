"""Hidden images: if a mirror shows a point several times, the eye may see only some of its images.

The virtual images of all faces, each as far behind the mirror as its path is long, are drawn into a z-buffer. A piece
of a face is hidden where the plane of the face that a pixel shows is nearer than its own plane.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import cross, rows
from ..support import breathe, portions
from ..views import View, draw
from .placement import place
from .reflection_mesh import ReflectionMesh

AT_ONCE = 1 << 15   # pieces
NEARER = 1e-3   # share of a distance: surfaces that touch do not hide one another
INWARDS = 0.8   # share of the distance from a piece's middle to its corners: test points keep off its border


@dataclass(frozen=True)
class FrontImages:
    """Frontmost face of a reflection at each pixel, and the nearness of all its m faces, linear in the picture.

    Attributes
    ----------
    width, height : int, of the picture
    face : (width x height,) int64, the nearest, along the rows from below; -1 where there is none
    plane : (m, 3) float64, coefficients of x, y and 1 in pixels
    nearness : (m, 3) float64
        Of the faces' corners: the inverse distance, or, in orthographic views, what is left of the longest one.
    several : (m,) bool, True if the scene triangle that a face shows has other images
    """

    width: int
    height: int
    face: np.ndarray
    plane: np.ndarray
    nearness: np.ndarray
    several: np.ndarray

    @classmethod
    def of(cls, view: View, mesh: ReflectionMesh, image: np.ndarray) -> FrontImages:
        """Draw all faces of `mesh`, which belong to `image` (m,)."""
        images = place(view, rows(mesh.mirror_position), mesh.path_length, "VIRTUAL").T
        clip, depth = view.clip(images)[mesh.triangles], view.depths(images)[mesh.triangles]
        w = clip[..., 3:]
        corners = np.concatenate((0.5 * (clip[..., :2] + w) * view.resolution, w), axis=2)
        a, b, c = np.moveaxis(corners, (1, 2), (0, 1))
        breathe()
        with np.errstate(divide="ignore", invalid="ignore"):
            before = np.where(depth > 0.0, depth, np.nan)
            nearness = depth.max(initial=0.0) - depth if view.orthographic else 1.0 / before
            value = (nearness * w[..., 0]).T
            plane = value[0] * cross(b, c) + value[1] * cross(c, a) + value[2] * cross(a, b)
            breathe()
            plane /= (a * cross(b, c)).sum(axis=0)
        breathe()
        front = draw(view, images, mesh.triangles).triangle
        return cls(*view.resolution, front, plane.T, nearness, _several(mesh.source_face, image))

    def hidden(self, face: np.ndarray, pixels: np.ndarray) -> np.ndarray:
        """Test whether nearer faces hide the middle of pieces, and a point before each of their three corners.

        Only pieces of scene triangles with several images are tested. A point outside the picture gets the result of
        the middle.

        Parameters
        ----------
        face : (k,) int64, face that each piece is a part of
        pixels : (k, 3, 2) float64, of its corners

        Returns
        -------
        (k, 4) bool, True where hidden: the middle, then the corners
        """
        hidden = np.zeros((len(face), 4), dtype=bool)
        asked = np.flatnonzero(self.several[face])
        for portion in portions(len(asked), AT_ONCE):
            part = asked[portion]
            hidden[part] = self._hidden(face[part], pixels[part])
        return hidden

    def _hidden(self, face: np.ndarray, pixels: np.ndarray) -> np.ndarray:
        """Test pieces as `hidden` does, all of them of scene triangles with several images."""
        middle = pixels.mean(axis=1, keepdims=True)
        spots = np.concatenate((middle, middle + INWARDS * (pixels - middle)), axis=1)
        column, row = np.moveaxis(np.floor(spots).astype(np.int64), 2, 0)
        inside = (column >= 0) & (column < self.width) & (row >= 0) & (row < self.height)
        front = np.where(inside, self.face[np.where(inside, row * self.width + column, 0)], -1)
        own = np.broadcast_to(face[:, None], front.shape)
        nearness = self._nearness(own, spots)
        behind = (front >= 0) & (front != own) & (self._nearness(front, spots) > nearness + NEARER * np.abs(nearness))
        return np.where(inside, behind, behind[:, :1])

    def _nearness(self, face: np.ndarray, spots: np.ndarray) -> np.ndarray:
        """Return the nearness (k, n) of each `face` (k, n) at `spots` (k, n, 2) in pixels; NaN for faces seen edge on.

        It is clamped to the range of the face's corners.
        """
        plane, corners = self.plane[face], self.nearness[face]
        with np.errstate(invalid="ignore"):
            found = (plane[..., :2] * spots).sum(axis=2) + plane[..., 2]
        return np.clip(found, corners.min(axis=2), corners.max(axis=2))


def _several(source: np.ndarray, image: np.ndarray) -> np.ndarray:
    """Return True for faces (m,) whose scene triangle `source` (m,) has more than one `image` (m,)."""
    count = int(source.max(initial=-1)) + 1
    low, high = np.full(count, len(image)), np.full(count, -1)
    np.minimum.at(low, source, image)
    np.maximum.at(high, source, image)
    return (low < high)[source]
