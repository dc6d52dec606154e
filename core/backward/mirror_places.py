"""Places on the mirror that are seen at given positions in the picture."""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..cameras import MirrorSurface
from ..geometry import TriangleMesh, dot, following, norm
from ..trees import SceneTree, first_of_many
from ..views import View
from .paths import Paths

BESIDE = 1e-9   # barycentric coordinate by which a place on a triangle's plane may lie outside of it
CHORD = 8.0     # pixels, at its depth: largest distance of the middle between two samples from the mirror


@dataclass(frozen=True)
class MirrorPlaces:
    """The mirror as a view sees it.

    Attributes
    ----------
    view : View
    mirror : TriangleMesh
    surface : MirrorSurface, of that mirror
    tree : SceneTree, of that mirror
    chosen : (m,) bool, triangles of the mirror that are sampled
    """

    view: View
    mirror: TriangleMesh
    surface: MirrorSurface
    tree: SceneTree
    chosen: np.ndarray

    def of(self, paths: Paths, spots: np.ndarray) -> Paths:
        """Return the paths with their places on the mirror, where the view rays at `spots` (n, 2) in pixels meet it.

        The places of the given paths are near these. Rays that pass by the mirror, beside a silhouette, take about the
        nearest place on the triangle of their path.
        """
        surface, (origin, ray) = self.surface, (given.T for given in self.view.rays(spots))
        normal = surface.face_normal[:, paths.face]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            place = origin + dot(normal, surface.a[:, paths.face] - origin) / dot(normal, ray) * ray
            u, v = surface.coordinates(paths.face, place)
            inside = np.minimum(np.minimum(u, v), 1.0 - u - v) >= -BESIDE
        some = np.flatnonzero(~inside)
        found, distance = first_of_many(self.tree, origin[:, some], ray[:, some])
        distance = np.where(found >= 0, distance, 0.0)
        near = origin[:, some] + distance * ray[:, some]
        beside = (given.T for given in self.view.rays(spots[some] + (1.0, 0.0)))
        pixel = norm(next(beside) + distance * next(beside) - near)
        close = (found >= 0) & self.chosen[found] & (norm(near - paths.place[:, some]) <= CHORD * pixel)
        face = paths.face.copy()
        face[some[close]] = found[close]
        place[:, some[close]] = self._within(found[close], near[:, close])
        some = some[~close]
        place[:, some] = self._beside(face[some], spots[some])
        return replace(paths, face=face, place=place, origin=np.where(paths.bounces == 1, place, paths.origin))

    def _within(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Return the `places` (3, n) moved into mirror triangles `face` (n,): rays may pass a little beside a side."""
        u, v = self.surface.coordinates(face, places)
        weights = np.maximum((1.0 - u - v, u, v), 0.0)
        corners = self.mirror.positions[self.mirror.triangles[face]]
        return np.einsum("kn,nki->in", weights / weights.sum(axis=0), corners)

    def _beside(self, face: np.ndarray, spots: np.ndarray) -> np.ndarray:
        """Return places (3, n) on mirror triangles `face` (n,), about the nearest to `spots` (n, 2) in the picture."""
        corners = self.mirror.positions[self.mirror.triangles[face]]
        flat = corners.reshape(-1, 3)
        pixels = self.view.pixels(flat).reshape(-1, 3, 2) - spots[:, None]
        depth = 1.0 if self.view.orthographic else self.view.depths(flat).reshape(-1, 3)
        one, other = following(pixels), following(following(pixels))
        with np.errstate(divide="ignore", invalid="ignore"):
            weights = one[..., 0] * other[..., 1] - one[..., 1] * other[..., 0]
            # corners behind the eye have no place in the picture
            weights = np.maximum(np.maximum(weights / weights.sum(axis=1, keepdims=True), 0.0) / depth, 0.0)
            weights /= weights.sum(axis=1, keepdims=True)
        weights[~np.isfinite(weights).all(axis=1)] = 1.0 / 3.0
        return np.einsum("nk,nki->in", weights, corners)
