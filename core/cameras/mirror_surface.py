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

ALONG_UV = np.array([[1.0], [0.0]]), np.array([[0.0], [1.0]])  # unit directions in (u, v)
LOST = 1e-12  # length of an interpolated normal: shorter ones have no reliable direction
LEAST_RISE = 0.01  # sine of the angle to the flat triangle at which Cycles lets a bent ray leave
Way = np.ndarray | tuple[np.ndarray, np.ndarray]
"""A change of (u, v): (2, n), or its two rows."""


class MirrorSurface:
    """Triangles as places Q = A + u (B - A) + v (C - A), with unit interpolated normals and reflected rays.

    Arrays of places, rays and normals are component-first, (3, n). `face` (n,) holds triangle indices, `uv` is (2, n).
    """

    def __init__(self, mirror: TriangleMesh) -> None:
        corners = mirror.positions[mirror.triangles]
        a, b, c = (rows(corners[:, k]) for k in range(3))
        normal, normal_b, normal_c = (rows(mirror.corner_normals[:, k]) for k in range(3))
        u, v = b - a, c - a
        flat = cross(u, v)
        self._set(np.concatenate((normal, normal_b - normal, normal_c - normal, a, u, v, flat, dot(flat, flat)[None])))
        self.face_normal, self._mirror = unit(flat), mirror

    @property
    def across(self) -> np.ndarray:
        """Indices (m, 3) of the triangle across the side opposite to each corner; -1 if there is none, or several."""
        return self._mirror.neighbours

    def _set(self, parts: np.ndarray) -> None:
        self._parts = parts
        self.normal, self.normal_u, self.normal_v, self.a, self.u, self.v = parts[:18].reshape(6, 3, -1)

    def select(self, face: np.ndarray) -> MirrorSurface:
        """Return a surface of the triangles `face` (n,), for places, normals and rays.

        Gathering all data of the triangles once is faster than gathering each array when it is needed.
        """
        chosen = copy(self)
        chosen._set(columns(self._parts[:18], face))
        chosen.face_normal = columns(self.face_normal, face)
        return chosen

    def __len__(self) -> int:
        return self.a.shape[1]

    def _between(self, first: int, face: np.ndarray | slice, uv: np.ndarray) -> np.ndarray:
        """Return A + u B + v C (3, n), where A, B, C are rows `first` to `first + 9` of the triangles' data."""
        own = self._parts[first:first + 9]
        if not isinstance(face, slice):
            own = columns(own, face)
        between = own[3:6] * uv[0]
        between += own[:3]
        return np.add(between, own[6:] * uv[1], out=between)

    def places(self, face: np.ndarray | slice, uv: np.ndarray) -> np.ndarray:
        """Return the places Q (3, n) at `uv` on the triangles."""
        return self._between(9, face, uv)

    def corners(self, face: np.ndarray) -> np.ndarray:
        """Return the corners (3, 3, n) of triangles, as [component, corner, triangle]."""
        own = columns(self._parts[9:18], face)
        return np.stack((own[:3], own[:3] + own[3:6], own[:3] + own[6:]), axis=1)

    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """Return (u, v) (2, n) of `places` (3, n) on the planes of the triangles."""
        own = columns(self._parts[9:], face)
        return _coordinates(own[3:], places - own[:3])

    def move_coordinates(self, face: np.ndarray, moves: np.ndarray) -> np.ndarray:
        """Return the change (2, n) of (u, v) for `moves` (3, n) in the planes of the triangles."""
        return _coordinates(columns(self._parts[12:], face), moves)

    def normals(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Return unit interpolated normals (3, n)."""
        return self._unit_normal(self._between(0, face, uv), face)[0]

    def _unit_normal(self, raw: np.ndarray, face: np.ndarray | slice) -> tuple[np.ndarray, np.ndarray]:
        """Normalise the `raw` normals (3, n) in place; return them and their previous lengths (n,)."""
        size = norm(raw)
        known = size > LOST
        if known.all():
            raw /= size
            return raw, size
        raw /= np.where(size > 0.0, size, 1.0)
        # opposite normals may cancel along an edge: use the flat normal there
        lost = np.flatnonzero(~known)
        raw[:, lost] = self.face_normal[:, face][:, lost]
        return raw, np.maximum(size, LOST)

    def unbent(self, face: np.ndarray, uv: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Return rays (3, n) reflected by the interpolated normals, even if they enter the triangle."""
        normal = self.normals(face, uv)
        slope = dot(direction, normal)
        slope *= 2.0
        normal *= slope
        return np.subtract(direction, normal, out=normal)

    def derivatives(self, face: np.ndarray | slice, uv: np.ndarray, direction: np.ndarray,
                    changes: Sequence[tuple[Way, np.ndarray]]) -> tuple[np.ndarray, list[np.ndarray]]:
        """Return the unbent rays (3, n), and a list of their derivatives (3, n), one for each of the `changes`.

        A change is a pair: the change of (u, v), (2, n), and of the arriving direction, (3, n).
        """
        normal = self._between(0, face, uv)
        square = dot(normal, normal)
        if not (square > LOST**2).all():
            normal, size = self._unit_normal(normal, face)
            square = size**2
            normal *= size
        twice = 2.0 / square
        slope = dot(direction, normal)
        slope *= twice
        own_u, own_v = (self._parts[first:first + 3] if isinstance(face, slice) else
                        columns(self._parts[first:first + 3], face) for first in (3, 6))
        turned = []
        for way, move in changes:
            turn = along(way, own_u, own_v)
            steeper = dot(direction, turn)
            steeper += dot(move, normal)
            steeper -= slope * dot(normal, turn)
            steeper *= twice
            change = steeper * normal
            np.subtract(move, change, out=change)
            change -= slope * turn
            turned.append(change)
        normal *= slope
        return np.subtract(direction, normal, out=normal), turned

    def rise(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Return the sine (n,) between each leaving `ray` and the flat triangle, negative if the ray enters it.

        `direction` (3, n) are the arriving rays, which define the triangle's front; both have the same length.
        """
        flat = columns(self.face_normal, face)
        length = np.maximum(norm(direction), 1e-300)
        return -dot(ray, flat) * np.sign(dot(direction, flat)) / length

    def enters(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray, slack: float = 0.0) -> np.ndarray:
        """Return True (n,) for rays that would enter their flat triangle and have to be lifted.

        With `slack`, rays whose sine is up to `slack` above the limit count too.
        """
        flat = columns(self.face_normal, face)
        length, upright = np.maximum(norm(direction), 1e-300), dot(direction, flat)
        return -dot(ray, flat) * np.sign(upright) / length < _least_rise(upright / length) + slack

    def lift(self, face: np.ndarray, uv: np.ndarray, ray: np.ndarray, direction: np.ndarray) -> None:
        """Turn rays that would enter their flat triangle until they just clear it. `ray` (3, n) is changed in place."""
        flat = columns(self.face_normal, face)
        length, upright = np.maximum(norm(direction), 1e-300), dot(direction, flat)
        # flip the normals of triangles seen from behind
        side = np.where(upright > 0.0, -1.0, 1.0)
        asked = np.flatnonzero(side * dot(ray, flat) < _least_rise(upright / length) * length)
        if not len(asked):
            return
        face, uv, side, length = face[asked], uv[:, asked], side[asked], length[asked]
        to_eye = -direction[:, asked] / length
        flat, normal = side * flat[:, asked], side * self.normals(face, uv)
        upright = dot(to_eye, flat)
        least = _least_rise(upright)
        tangent = unit(normal - dot(normal, flat) * flat)
        sideways = dot(to_eye, tangent)
        forth = np.sqrt(np.maximum(sideways**2 + upright**2 - least**2, 0.0))
        ray[:, asked] = (forth * tangent + least * flat - (to_eye - sideways * tangent - upright * flat)) * length


def _coordinates(own: np.ndarray, moves: np.ndarray) -> np.ndarray:
    """Return (u, v) (2, n) of `moves` (3, n) in the planes of triangles; exact for moves along a side.

    `own` (10, n) holds the sides u and v, the area normal, and its square.
    """
    u, v, flat, uv = own[:3], own[3:6], own[6:9], np.empty((2, *moves.shape[1:]))
    for k, turned in enumerate((cross(moves, v), cross(u, moves))):
        np.divide(dot(turned, flat), own[9], out=uv[k])
    return uv


def _least_rise(upright: np.ndarray) -> np.ndarray:
    """Return the least sine (n,) of the angle between a reflected ray and the flat triangle that it leaves.

    Cycles bends smooth normals until rays leave at this angle. `upright` (n,) is the sine of the angle between the
    arriving ray and the triangle.
    """
    return np.minimum(0.9 * np.abs(upright), LEAST_RISE)


def along(way: Way, u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the derivative (3, n) along a direction `way` in (u, v), from the derivatives `u` and `v` (3, n)."""
    for alone, own in zip(ALONG_UV, (u, v)):
        if way is alone:
            return own
    return way[0] * u + way[1] * v


def least_weight(uv: np.ndarray) -> np.ndarray:
    """Return the least barycentric coordinate (n,) of places (u, v): negative outside of the triangle."""
    return np.minimum(np.minimum(uv[0], uv[1]), 1.0 - uv[0] - uv[1])


def drawn_in(uv: np.ndarray) -> np.ndarray:
    """Return places (u, v) with those outside of their triangle moved to its border."""
    uv = np.maximum(uv, 0.0)
    return uv / np.maximum(uv.sum(axis=0), 1.0)
