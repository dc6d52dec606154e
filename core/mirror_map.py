"""The true reflection map of a mirror: from a place on a flat mirror triangle to the ray that leaves it.

At Q on the flat triangle, with the normalised interpolated normal n(Q), the ray leaves along d - 2 (d . n) n, which is
what Cycles traces on the same mesh. The three-ray camera interpolates rays instead and is O(h^2) off; Newton steps on
this map make its images exact.

Near silhouettes that ray would enter the flat triangle it leaves. There the normal n is turned towards the flat normal
g until the ray just clears the surface, as Cycles does (`ensure_valid_specular_reflection` in its kernel): with i the
unit vector to the eye and x the unit tangent in the plane of n and g, turning n in that plane only turns the part of
the reflected ray that lies in it, of length sqrt((i . x)^2 + (i . g)^2), while the part across it stays. The ray that
rises by t along g is therefore sqrt((i . x)^2 + (i . g)^2 - t^2) x + t g - (i - (i . x) x - (i . g) g).
"""
from __future__ import annotations

import numpy as np

from .triangle_mesh import TriangleMesh
from .vectors import cross, dot, norm, rows, solve, unit
from .view import View

LEAST_RISE = 0.01  # sine of the angle at which Cycles lets a bent ray leave
NEARLY_GRAZING = 0.03  # sine at a face's corners or middle below which some ray of the face may need to be bent
ARRIVED = 1e-10  # of the path and the viewing distance: by how much a ray that Newton's method found may miss
DIFFERENCE = 1e-5  # of a triangle's side: step of the difference quotients for bent rays


class MirrorMap:
    """Rays of the mirror's triangles at places (u, v): Q = A + u (B - A) + v (C - A).

    With `parallel`, every triangle sends all its rays along one direction, that of its middle: the parallel
    three-ray camera, whose projection is linear and jumps between triangles.
    """

    def __init__(self, view: View, mirror: TriangleMesh, parallel: bool = False) -> None:
        corners = mirror.positions[mirror.triangles]
        self.a = rows(corners[:, 0])
        self.u, self.v = rows(corners[:, 1]) - self.a, rows(corners[:, 2]) - self.a
        self.flat = cross(self.u, self.v)
        self.normal = rows(mirror.corner_normals[:, 0])
        self.normal_u = rows(mirror.corner_normals[:, 1]) - self.normal
        self.normal_v = rows(mirror.corner_normals[:, 2]) - self.normal
        self.orthographic = view.orthographic
        self.eye, self.forward = view.eye[:, None], view.forward[:, None]
        self.parallel = parallel
        self.face_normal = unit(self.flat)
        self.grazing = np.zeros(self.a.shape[1], dtype=bool)
        if not parallel:
            every = np.arange(self.a.shape[1])
            for u, v in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0 / 3.0, 1.0 / 3.0)):
                uv = np.stack((np.full(len(every), u), np.full(len(every), v)))
                self.grazing |= self._rise(every, *self._unbent(every, uv)[:2]) < NEARLY_GRAZING
        if parallel:
            middle = self.a + (self.u + self.v) / 3.0
            direction = unit(self._directions(middle))
            normal = self._unit_normal(self.normal + (self.normal_u + self.normal_v) / 3.0, self.flat)
            self.constant = direction - 2.0 * dot(direction, normal) * normal

    def _directions(self, places: np.ndarray) -> np.ndarray:
        if self.orthographic:
            return np.broadcast_to(self.forward, places.shape)
        return places - self.eye

    @staticmethod
    def _unit_normal(normal: np.ndarray, flat: np.ndarray) -> np.ndarray:
        # opposite normals may cancel along an edge: the flat normal is then the only one left
        return np.where(norm(normal) > 1e-12, unit(normal), unit(flat))

    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        """(u, v) as (2, n) of `places` (3, n) on the planes of triangles `face` (n,)."""
        u, v, flat = self.u[:, face], self.v[:, face], self.flat[:, face]
        offset, area = places - self.a[:, face], dot(flat, flat)
        return np.stack((dot(cross(offset, v), flat), dot(cross(u, offset), flat))) / area

    def places(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Q as (3, n)."""
        return self.a[:, face] + uv[0] * self.u[:, face] + uv[1] * self.v[:, face]

    def normals(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """Unit interpolated normals as (3, n)."""
        normal = self.normal[:, face] + uv[0] * self.normal_u[:, face] + uv[1] * self.normal_v[:, face]
        return self._unit_normal(normal, self.flat[:, face])

    def rays(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        """R as (3, n), not normalised: as long as d."""
        if self.parallel:
            return self.constant[:, face]
        ray, direction, normal = self._unbent(face, uv)
        part = np.flatnonzero(self.grazing[face])
        if len(part):
            ray[:, part] = self._lifted(face[part], ray[:, part], direction[:, part], normal[:, part])
        return ray

    def lifted(self, face: np.ndarray, uv: np.ndarray, slack: float = 0.0) -> np.ndarray:
        """Whether the rays (n,) would enter their flat faces and are turned until they clear them, or, by `slack` of
        their rise, all but are."""
        found = np.zeros(len(face), dtype=bool)
        part = np.flatnonzero(self.grazing[face])
        if len(part) and not self.parallel:
            face, uv = face[part], uv[:, part]
            ray, direction, _ = self._unbent(face, uv)
            found[part] = self._rise(face, ray, direction) < self._least_rise(face, direction) + slack
        return found

    def _least_rise(self, face: np.ndarray, direction: np.ndarray) -> np.ndarray:
        upright = np.abs(dot(unit(direction), self.face_normal[:, face]))
        return np.minimum(0.9 * upright, LEAST_RISE)

    def _unbent(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Ray, view direction and unit normal, all (3, n), before the ray is lifted above the flat face."""
        direction = self._directions(self.places(face, uv))
        normal = self.normals(face, uv)
        return direction - 2.0 * dot(direction, normal) * normal, direction, normal

    def _rise(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """How steeply rays leave the flat faces on the eye's side, as a sine."""
        flat = self.face_normal[:, face]
        length = np.maximum(norm(direction), 1e-300)
        return -dot(ray, flat) * np.sign(dot(direction, flat)) / length

    def _lifted(self, face: np.ndarray, ray: np.ndarray, direction: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """The rays, those that would enter the flat face turned until they just clear it."""
        length = np.maximum(norm(direction), 1e-300)
        to_eye = -direction / length
        side = np.where(dot(to_eye, self.face_normal[:, face]) < 0.0, -1.0, 1.0)
        flat, normal = side * self.face_normal[:, face], side * normal
        upright = dot(to_eye, flat)
        least = self._least_rise(face, direction)
        tangent = unit(normal - dot(normal, flat) * flat)
        sideways = dot(to_eye, tangent)
        forth = np.sqrt(np.maximum(sideways**2 + upright**2 - least**2, 0.0))
        lifted = forth * tangent + least * flat - (to_eye - sideways * tangent - upright * flat)
        return np.where(dot(ray, flat) < least * length, lifted * length, ray)

    def linearise(self, face: np.ndarray, uv: np.ndarray, *ways: np.ndarray) -> tuple:
        """Place, ray, and for each of the `ways` (2, n) in (u, v) the derivatives of both along it, all (3, n)."""
        u, v = self.u[:, face], self.v[:, face]
        place = self.a[:, face] + uv[0] * u + uv[1] * v
        moves = [way[0] * u + way[1] * v for way in ways]
        if self.parallel:
            return place, self.constant[:, face], [(move, np.zeros_like(move)) for move in moves]
        normal_u, normal_v = self.normal_u[:, face], self.normal_v[:, face]
        raw = self.normal[:, face] + uv[0] * normal_u + uv[1] * normal_v
        normal = self._unit_normal(raw, self.flat[:, face])
        size = np.maximum(norm(raw), 1e-12)
        direction = self._directions(place)
        slope = dot(direction, normal)
        derivatives = []
        for way, move in zip(ways, moves):
            turn = way[0] * normal_u + way[1] * normal_v
            turn = (turn - dot(turn, normal) * normal) / size
            seen = np.zeros_like(move) if self.orthographic else move
            change = seen - 2.0 * (dot(seen, normal) + dot(direction, turn)) * normal - 2.0 * slope * turn
            derivatives.append((move, change))
        ray = direction - 2.0 * slope * normal
        part = np.flatnonzero(self.lifted(face, uv))
        if len(part):
            near = face[part], uv[:, part]
            ray[:, part] = self.rays(*near)
            for way, (_, change) in zip(ways, derivatives):
                step = DIFFERENCE * np.broadcast_to(way, uv.shape)[:, part]
                after, before = (self.rays(near[0], near[1] + sign * step) for sign in (1.0, -1.0))
                change[:, part] = (after - before) / (2.0 * DIFFERENCE)
        return place, ray, derivatives

    def locate(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray, points: np.ndarray,
               steps: int = 4) -> tuple[np.ndarray, np.ndarray]:
        """Newton's method for Q(u, v) + s R(u, v) = P from a near start, `points` P as (3, n); returns uv and s."""
        one, zero = np.ones_like(s), np.zeros_like(s)
        for _ in range(steps):
            place, ray, ((qu, ru), (qv, rv)) = self.linearise(face, uv, (one, zero), (zero, one))
            step = solve(qu + s * ru, qv + s * rv, ray, points - place - s * ray)
            # a step longer than the triangle tells a start too far off: keep its direction only
            step = step / np.maximum(1.0, np.abs(step[:2]).max(axis=0))
            uv, s = uv + step[:2], s + step[2]
        return uv, s

    def meet(self, face: np.ndarray, start: np.ndarray, end: np.ndarray, t: np.ndarray, s: np.ndarray,
             point: np.ndarray, edge: np.ndarray, steps: int = 5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Newton's method for the ray from the mirror's line `start` to `end`, (2, n) in (u, v), that meets the line
        P + r E, `point` P and `edge` E as (3, n); returns t along the mirror's line, r along the other, and s."""
        way = end - start
        r = np.zeros_like(t)
        for _ in range(steps):
            place, ray, ((q, change),) = self.linearise(face, start + t * way, way)
            moved = solve(q + s * change, ray, -edge, point - place - s * ray)
            # s is a length in orthographic views: only t can tell a step that is too long
            step = moved[:2] / np.maximum(1.0, np.abs(moved[0]))
            t, s, r = t + step[0], s + step[1], moved[2]
        return t, r, s

    def meets(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Whether the ray at (u, v) really passes through `points` (3, n) at s > 0: that Newton's method arrived."""
        place, ray = self.places(face, uv), self.rays(face, uv)
        miss = norm(place + s * ray - points)
        return (s >= 0.0) & (miss <= ARRIVED * (norm(points - place) + norm(ray)))

    def turned(self, face: np.ndarray, uv: np.ndarray, s: np.ndarray) -> np.ndarray:
        """How the map magnifies at distance s: the moved triangle's area across the ray over the area at s = 0.

        Its sign is the image's parity: it starts at +1 on the mirror and crosses zero on a caustic.
        """
        one, zero = np.ones_like(s), np.zeros_like(s)
        _, ray, ((qu, ru), (qv, rv)) = self.linearise(face, uv, (one, zero), (zero, one))
        before = dot(cross(qu, qv), ray)
        after = dot(cross(qu + s * ru, qv + s * rv), ray)
        return after / np.where(before != 0.0, before, 1.0)

