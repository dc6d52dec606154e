"""Affine frames of diffuse triangles: barycentric coordinates and height above the plane, as dot products."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .vectors import columns, cross, dot, norm, rows

PARALLEL = 2.0 ** -53  # sine: rays that fall less steeply fall by rounding alone


def falling(normal: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """How fast rays (3, n) move along normals, never so slowly that it is rounding alone."""
    speed, least = dot(normal, rays), np.maximum(PARALLEL * norm(normal) * norm(rays), 1e-150)
    return np.where(np.abs(speed) > least, speed, least)


class Triangles(Protocol):
    """A mesh, or whatever else has triangles (m, 3) over positions (n, 3)."""

    @property
    def positions(self) -> np.ndarray: ...

    @property
    def triangles(self) -> np.ndarray: ...


@dataclass(frozen=True)
class SceneFrames:
    """Frames of chosen triangles.

    Attributes
    ----------
    triangle : (t,) int64, sorted: the triangles of the scene that the columns below belong to
    vertices : (3, t) int64, their vertices
    positions : (n, 3) float64, of all vertices
    origin : (3, t) float64, the third vertex
    first, second : (3, t) float64, gradients of the barycentric coordinates of the first and second vertex
    normal : (3, t) float64, along the plane's normal, scaled to the gradients' size
    """

    triangle: np.ndarray
    vertices: np.ndarray
    positions: np.ndarray
    origin: np.ndarray
    first: np.ndarray
    second: np.ndarray
    normal: np.ndarray

    @classmethod
    def of(cls, mesh: Triangles, triangle: np.ndarray) -> SceneFrames:
        """Frames of the triangles of a mesh, or of whatever has `positions` and `triangles`."""
        vertices = np.ascontiguousarray(mesh.triangles[triangle].T)
        a, b, c = (rows(mesh.positions[vertices[k]]) for k in range(3))
        u, v = a - c, b - c
        normal = cross(u, v)
        area = dot(normal, normal)
        size = np.sqrt(area)
        return cls(triangle, vertices, mesh.positions, c, cross(v, normal) / area, cross(normal, u) / area,
                   normal / (size * np.sqrt(size)))

    def coordinates(self, column: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Barycentric coordinates of the first and second vertex, and height, of points (3, ...) in frames `column`."""
        offset = points - self._take(self.origin, column, points)
        return self.directions(column, offset)

    def directions(self, column: np.ndarray, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same of vectors, which have no origin."""
        first, second, height = (dot(self._take(row, column, vectors), vectors)
                                 for row in (self.first, self.second, self.normal))
        return first, second, height

    def weights(self, column: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Barycentric coordinates (3, ...) of points (3, ...)."""
        first, second, _ = self.coordinates(column, points)
        return np.stack((first, second, 1.0 - first - second))

    def weights_within(self, column: np.ndarray, points: np.ndarray) -> np.ndarray:
        """The same, none negative: points beside their triangles as on their rims."""
        weights = np.maximum(self.weights(column, points), 0.0)
        weights /= weights.sum(axis=0)
        return weights

    def distance(self, column: np.ndarray, places: np.ndarray, rays: np.ndarray) -> np.ndarray:
        """s at which the rays Q + s R, (3, n) each, meet the planes of the frames: far away, but not infinitely far,
        where they are parallel."""
        return -self.height(column, places) / falling(self._take(self.normal, column, places), rays)

    def height(self, column: np.ndarray, places: np.ndarray) -> np.ndarray:
        """How high (n,) places (3, n) lie over the planes of the frames."""
        return dot(self._take(self.normal, column, places), places - self._take(self.origin, column, places))

    @staticmethod
    def _take(row: np.ndarray, column: np.ndarray, like: np.ndarray) -> np.ndarray:
        taken = columns(row, column)
        return taken.reshape(taken.shape[:1] + (1,) * (like.ndim - taken.ndim) + taken.shape[1:])
