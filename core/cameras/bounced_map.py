"""The reflection map of a mirror seen in mirrors: chains of mirror triangles, one bounce more than the previous map.

A chain is a face of the previous map and a mirror triangle that its rays hit. The ray hits the triangle at O + s R of
the previous map. Its direction vector is as long as the whole path from the eye, so that chains of flat mirrors are
exact too: they have one virtual eye.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, falling
from .mirror_surface import MirrorSurface, Way, drawn_in
from .reflection_map import ReflectionMap


class BouncedMap(ReflectionMap):
    """Reflection map of rays that bounce once more.

    Parameters
    ----------
    before : ReflectionMap
        Map with one bounce less.
    surface : MirrorSurface
        All mirrors that may be seen in the mirrors.
    face_before : (k,) int64
        For each chain, the face of `before`.
    triangle : (k,) int64
        For each chain, the triangle of `surface` that its rays hit.
    orthographic : bool
        True if the arriving rays are unit vectors.
    """

    parallel = False

    def __init__(self, before: ReflectionMap, surface: MirrorSurface, face_before: np.ndarray, triangle: np.ndarray,
                 orthographic: bool) -> None:
        self.view, self.bounce = before.view, before.bounce + 1
        self.before, self.surface = before, surface
        self.face_before, self.triangle = face_before, triangle
        self.orthographic = orthographic
        # angles of incidence are not known per triangle: any ray may need to be lifted
        self.grazing = np.ones(len(triangle), dtype=bool)

    def first(self, face: np.ndarray) -> np.ndarray:
        return self.before.first(self.face_before[face])

    def last(self, face: np.ndarray) -> tuple[MirrorSurface, np.ndarray]:
        return self.surface, self.triangle[face]

    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        return self.before.coordinates(self.face_before[face], places)

    def places(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return self.before.places(self.face_before[face], uv)

    def spans(self, face: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.before.spans(self.face_before[face])

    def _arriving(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the hit points (3, n) of rays on their triangles, their directions (3, n), and s (n,) of `before`.

        The directions are as long as the whole path from the eye, or unit vectors if `orthographic`.
        """
        origin, ray = self.before.leave(self.face_before[face], uv)
        s = self._distance(face, origin, ray)
        return origin + s * ray, ray if self.orthographic else (1.0 + s) * ray, s

    def _distance(self, face: np.ndarray, origin: np.ndarray, ray: np.ndarray) -> np.ndarray:
        triangle = self.triangle[face]
        flat = self.surface.face_normal[:, triangle]
        # a negative distance is rounding, where the two mirrors touch
        return np.maximum(dot(self.surface.a[:, triangle] - origin, flat) / falling(flat, ray), 0.0)

    def leave(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        triangle = self.triangle[face]
        place, direction, _ = self._arriving(face, uv)
        on = self.surface.coordinates(triangle, place)
        ray = self.surface.unbent(triangle, on, direction)
        self.surface.lift(triangle, on, ray, direction)
        return place, ray

    def rays(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return self.leave(face, uv)[1]

    def met_later(self, face: np.ndarray, uv: np.ndarray) -> list[np.ndarray]:
        triangle = self.triangle[face]
        # the ray of a corner slightly outside of its chain may hit the plane of an edge-on triangle far away
        on = drawn_in(self.surface.coordinates(triangle, self._arriving(face, uv)[0]))
        return [*self.before.met_later(self.face_before[face], uv), self.surface.places(triangle, on)]

    def leaving(self, face: np.ndarray, uv: np.ndarray, bent: bool = True) -> list[np.ndarray]:
        before = self.before.leaving(self.face_before[face], uv, bent)
        if bent:
            return [*before, self.rays(face, uv)]
        triangle = self.triangle[face]
        place, direction, _ = self._arriving(face, uv)
        return [*before, self.surface.unbent(triangle, self.surface.coordinates(triangle, place), direction)]

    def turned_before(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return self.before.turned(self.face_before[face], uv, self._arriving(face, uv)[2])

    def lifted(self, face: np.ndarray, uv: np.ndarray, slack: float = 0.0) -> np.ndarray:
        triangle = self.triangle[face]
        place, direction, _ = self._arriving(face, uv)
        ray = self.surface.unbent(triangle, self.surface.coordinates(triangle, place), direction)
        return (self.before.lifted(self.face_before[face], uv, slack)
                | self.surface.enters(triangle, ray, direction, slack))

    def linearise(self, face: np.ndarray, uv: np.ndarray, *ways: Way) -> tuple:
        triangle = self.triangle[face]
        origin, ray, moves = self.before.linearise(self.face_before[face], uv, *ways)
        s = self._distance(face, origin, ray)
        flat = self.surface.face_normal[:, triangle]
        speed = falling(flat, ray)
        place, direction = origin + s * ray, ray if self.orthographic else (1.0 + s) * ray
        places, changes = [], []
        for move, change in moves:
            move = move + s * change
            farther = -dot(move, flat) / speed
            places.append(move + farther * ray)
            changes.append((self.surface.move_coordinates(triangle, places[-1]),
                            change if self.orthographic else farther * ray + (1.0 + s) * change))
        on = self.surface.coordinates(triangle, place)
        leaving, turned = self.surface.derivatives(triangle, on, direction, changes)
        self._bend(np.flatnonzero(self.surface.enters(triangle, leaving, direction)), (face, uv), ways, leaving, turned)
        return place, leaving, list(zip(places, turned))
