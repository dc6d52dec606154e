"""The flat triangles of a mirror with their interpolated normals, and how they turn a ray that arrives.

At a place on the flat triangle, with the normalised interpolated normal n, a ray of direction d leaves along
d - 2 (d . n) n, which is what Cycles traces on the same mesh.

Near silhouettes that ray would enter the flat triangle it leaves. There the normal n is turned towards the flat normal
g until the ray just clears the surface, as Cycles does (`ensure_valid_specular_reflection` in its kernel): with i the
unit vector to the eye and x the unit tangent in the plane of n and g, turning n in that plane only turns the part of
the reflected ray that lies in it, of length sqrt((i . x)^2 + (i . g)^2), while the part across it stays. The ray that
rises by t along g is therefore sqrt((i . x)^2 + (i . g)^2 - t^2) x + t g - (i - (i . x) x - (i . g) g).
"""
from __future__ import annotations

from collections.abc import Sequence
from copy import copy

import numpy as np

from ..geometry import TriangleMesh, columns, cross, dot, norm, rows, unit

LEAST_RISE = 0.01  # sine of the angle at which Cycles lets a bent ray leave
Way = np.ndarray | tuple[np.ndarray, np.ndarray]
"""A change of (u, v): (2, n), or its two rows."""


class MirrorSurface:
    """Triangles as places Q = A + u (B - A) + v (C - A), their unit interpolated normals, and rays reflected there.

    Arrays of places, rays and normals are component-first, (3, n); `face` (n,) names triangles, `uv` is (2, n).
    """

    def __init__(self, mirror: TriangleMesh) -> None:
        corners = mirror.positions[mirror.triangles]
        a, b, c = (rows(corners[:, k]) for k in range(3))
        normal, normal_b, normal_c = (rows(mirror.corner_normals[:, k]) for k in range(3))
        flat = cross(b - a, c - a)
        self._set(np.concatenate((a, b - a, c - a, flat, unit(flat), normal, normal_b - normal, normal_c - normal)))

    def _set(self, parts: np.ndarray) -> None:
        self._parts = parts
        (self.a, self.u, self.v, self.flat, self.face_normal, self.normal, self.normal_u,
         self.normal_v) = parts.reshape(8, 3, -1)

    def select(self, face: np.ndarray) -> MirrorSurface:
        """A surface of the triangles `face` (n,): to gather all that is known of them at once is quicker than one by
        one."""
        chosen = copy(self)
        chosen._set(columns(self._parts, face))
        return chosen

    def __len__(self) -> int:
        return self.a.shape[1]

    def places(self, face: np.ndarray | slice, uv: np.ndarray) -> np.ndarray:
        """Q."""
        return self.a[:, face] + uv[0] * self.u[:, face] + uv[1] * self.v[:, face]

    def corners(self, face: np.ndarray) -> np.ndarray:
        """(3, 3, n): the corners of triangles one behind another."""
        a = self.a[:, face]
        return np.stack((a, a + self.u[:, face], a + self.v[:, face]), axis=1)

    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """(u, v) of `places` on the planes of the triangles."""
        return self.move_coordinates(face, places - self.a[:, face])

    def move_coordinates(self, face: np.ndarray, moves: np.ndarray) -> np.ndarray:
        """The change of (u, v) that moves in the planes of the triangles make."""
        u, v, flat = self.u[:, face], self.v[:, face], self.flat[:, face]
        return np.stack((dot(cross(moves, v), flat), dot(cross(u, moves), flat))) / dot(flat, flat)

    def raw_normals(self, face: np.ndarray | slice, uv: np.ndarray) -> np.ndarray:
        """Interpolated normals before they are made unit vectors."""
        return self.normal[:, face] + uv[0] * self.normal_u[:, face] + uv[1] * self.normal_v[:, face]

    def normals(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Unit interpolated normals."""
        return self._unit_normal(self.raw_normals(face, uv), face)[0]

    def _unit_normal(self, raw: np.ndarray, face: np.ndarray | slice) -> tuple[np.ndarray, np.ndarray]:
        """Unit normals, and how long (n,) they were."""
        size = norm(raw)
        normal = raw / np.where(size > 0.0, size, 1.0)
        # opposite normals may cancel along an edge: the flat normal is then the only one left
        lost = np.flatnonzero(~(size > 1e-12))
        normal[:, lost] = self.face_normal[:, face][:, lost]
        return normal, np.maximum(size, 1e-12)

    def unbent(self, face: np.ndarray, uv: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Rays of the interpolated normals alone, whether they enter the triangle or not."""
        normal = self.normals(face, uv)
        return direction - 2.0 * dot(direction, normal) * normal

    def derivatives(self, face: np.ndarray | slice, uv: np.ndarray, direction: np.ndarray,
                    changes: Sequence[tuple[Way, np.ndarray]]) -> tuple[np.ndarray, list[np.ndarray]]:
        """The unbent rays, and what they change by for each of the `changes`: of (u, v), (2, n), and of the direction
        that arrives, (3, n)."""
        raw = self.raw_normals(face, uv)
        normal, size = self._unit_normal(raw, face)
        slope = dot(direction, normal)
        turned = []
        for way, move in changes:
            turn = way[0] * self.normal_u[:, face] + way[1] * self.normal_v[:, face]
            turn = (turn - dot(turn, normal) * normal) / size
            turned.append(move - 2.0 * (dot(move, normal) + dot(direction, turn)) * normal - 2.0 * slope * turn)
        return direction - 2.0 * slope * normal, turned

    def rise(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """How steeply rays leave the flat triangles on the side that they came from, as a sine."""
        flat = self.face_normal[:, face]
        length = np.maximum(norm(direction), 1e-300)
        return -dot(ray, flat) * np.sign(dot(direction, flat)) / length

    def enters(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray, slack: float = 0.0) -> np.ndarray:
        """Whether rays would enter their flat triangles and have to be lifted, or, by `slack` of their rise, all but
        have to be."""
        return self.rise(face, ray, direction) < self._least_rise(face, direction) + slack

    def _least_rise(self, face: np.ndarray, direction: np.ndarray) -> np.ndarray:
        upright = np.abs(dot(unit(direction), self.face_normal[:, face]))
        return np.minimum(0.9 * upright, LEAST_RISE)

    def lift(self, face: np.ndarray, uv: np.ndarray, ray: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """The rays, those that would enter the flat triangle turned until they just clear it."""
        length = np.maximum(norm(direction), 1e-300)
        to_eye = -direction / length
        side = np.where(dot(to_eye, self.face_normal[:, face]) < 0.0, -1.0, 1.0)
        flat, normal = side * self.face_normal[:, face], side * self.normals(face, uv)
        upright = dot(to_eye, flat)
        least = self._least_rise(face, direction)
        tangent = unit(normal - dot(normal, flat) * flat)
        sideways = dot(to_eye, tangent)
        forth = np.sqrt(np.maximum(sideways**2 + upright**2 - least**2, 0.0))
        lifted = forth * tangent + least * flat - (to_eye - sideways * tangent - upright * flat)
        return np.where(dot(ray, flat) < least * length, lifted * length, ray)


def least_weight(uv: np.ndarray) -> np.ndarray:
    """The least barycentric coordinate (n,) of places (u, v): negative outside of the triangle."""
    return np.minimum(np.minimum(uv[0], uv[1]), 1.0 - uv[0] - uv[1])


def drawn_in(uv: np.ndarray) -> np.ndarray:
    """Places (u, v), those outside of their triangle drawn to its rim."""
    uv = np.maximum(uv, 0.0)
    return uv / np.maximum(uv.sum(axis=0), 1.0)
