"""Affine frames of diffuse triangles: barycentric coordinates and height above the plane, as dot products."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from .vectors import columns, cross, dot, norm, rows

PARALLEL = 2.0 ** -53  # sine between a ray and a plane: smaller ones are rounding


def falling(normal: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """Return the dot products (n,) of normals (3, n) and rays (3, n), never zero, so that they can be divisors.

    They are positive for rays to the side to which the normal points, and negative for rays to the other side. For rays
    that are parallel to the plane up to rounding, with |normal . ray| <= max(2**-53 |normal| |ray|, 1e-150), this
    positive limit is returned instead.
    """
    speed, least = dot(normal, rays), np.maximum(PARALLEL * norm(normal) * norm(rays), 1e-150)
    return np.where(np.abs(speed) > least, speed, least)


class Triangles(Protocol):
    """Any object with triangles (m, 3) over positions (n, 3)."""

    @property
    def positions(self) -> np.ndarray: ...

    @property
    def triangles(self) -> np.ndarray: ...


@dataclass(frozen=True)
class SceneFrames:
    """Affine frames of selected triangles.

    Attributes
    ----------
    triangle : (t,) int64, sorted indices of the scene's triangles, one for each column of the arrays below
    vertices : (3, t) int64, their vertices
    positions : (n, 3) float64, positions of all vertices of the scene
    origin : (3, t) float64, position of the third vertex
    first, second : (3, t) float64, gradients of the barycentric coordinates of the first and second vertex
    normal : (3, t) float64, normal of the plane, scaled to the size of the gradients
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
        """Compute the frames of triangles `triangle` (t,), sorted, of a mesh with `positions` and `triangles`."""
        vertices = np.ascontiguousarray(mesh.triangles[triangle].T)
        a, b, c = (rows(mesh.positions[vertices[k]]) for k in range(3))
        u, v = a - c, b - c
        normal = cross(u, v)
        area = dot(normal, normal)
        size = np.sqrt(area)
        return cls(triangle, vertices, mesh.positions, c, cross(v, normal) / area, cross(normal, u) / area,
                   normal / (size * np.sqrt(size)))

    def coordinates(self, column: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return barycentric coordinates of the first and second vertex, and heights, of points (3, ...), as (...).

        `column` holds the frame of each point. Heights are in units of the scaled normals.
        """
        offset = points - self._take(self.origin, column, points)
        return self.directions(column, offset)

    def directions(self, column: np.ndarray, vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the changes of `coordinates` along `vectors` (3, ...), which have no origin."""
        first, second, height = (dot(self._take(row, column, vectors), vectors)
                                 for row in (self.first, self.second, self.normal))
        return first, second, height

    def weights(self, column: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return barycentric coordinates (3, ...) of points (3, ...) in frames `column`."""
        first, second, _ = self.coordinates(column, points)
        return np.stack((first, second, 1.0 - first - second))

    def weights_within(self, column: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Return barycentric coordinates (3, ...), with negative ones set to zero and the rest normalised to sum 1."""
        weights = np.maximum(self.weights(column, points), 0.0)
        weights /= weights.sum(axis=0)
        return weights

    def distance(self, column: np.ndarray, places: np.ndarray, rays: np.ndarray) -> np.ndarray:
        """Return s (n,) at which rays Q + s R, given as `places` and `rays` (3, n), hit the planes of the frames.

        For parallel rays the value is large but finite.
        """
        return -self.height(column, places) / falling(self._take(self.normal, column, places), rays)

    def height(self, column: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Return the heights (n,) of `places` (3, n) above the planes of the frames, in units of the scaled normals."""
        return dot(self._take(self.normal, column, places), places - self._take(self.origin, column, places))

    @staticmethod
    def _take(row: np.ndarray, column: np.ndarray, like: np.ndarray) -> np.ndarray:
        taken = columns(row, column)
        return taken.reshape(taken.shape[:1] + (1,) * (like.ndim - taken.ndim) + taken.shape[1:])
