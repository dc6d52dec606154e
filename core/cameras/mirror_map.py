"""The true reflection map of one mirror: from a place on a flat mirror triangle to the reflected ray.

The three-ray camera interpolates rays instead, with an error of O(h^2). Newton steps on this map make its images exact.
"""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh, unit
from ..views import View
from .mirror_surface import LEAST_RISE, MirrorSurface, Way, along
from .reflection_map import ReflectionMap

NEARLY_GRAZING = 0.03  # sine at a face's sampled places, below which some ray of the face may need to be bent
FEW = np.array([(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0 / 3.0, 1.0 / 3.0)])
STEPS = 6  # samples along the sides of faces that the few places do not decide
MANY = np.array([(i, j) for i in range(STEPS + 1) for j in range(STEPS + 1 - i)]) / STEPS


class MirrorMap(ReflectionMap):
    """Reflection map after one bounce: rays of the mirror's triangles as the view sees them.

    The origin of a ray is the place on the mirror. With `parallel`, all rays of a triangle have one direction, that of
    its centroid: the parallel three-ray camera, whose projection is linear and jumps between triangles. The `surface`
    of the mirror is computed if it is not given.
    """

    def __init__(self, view: View, mirror: TriangleMesh, parallel: bool = False,
                 surface: MirrorSurface | None = None) -> None:
        self.view, self.bounce = view, 1
        self.surface = MirrorSurface(mirror) if surface is None else surface
        self.orthographic = view.orthographic
        self.eye, self.forward = view.eye[:, None], view.forward[:, None]
        self.parallel = parallel
        self._last: tuple[np.ndarray, MirrorSurface] | None = None
        count = len(self.surface)
        self.grazing = np.zeros(count, dtype=bool)
        every = np.arange(count)
        if parallel:
            middle = np.full((2, count), 1.0 / 3.0)
            self.constant = self.surface.unbent(every, middle, unit(self.arriving(self.places(every, middle))))
            return
        least, most = self._rises(every, FEW)
        self.grazing = least < NEARLY_GRAZING
        # near the eye, or with strongly curved normals, rays between these places may have smaller sines than at them
        doubtful = np.flatnonzero((2.0 * least - most < NEARLY_GRAZING) & ~self.grazing)
        least, most = self._rises(doubtful, MANY)
        # between samples the sine may be lower by an amount that shrinks with the square of their distance
        self.grazing[doubtful] = least - (most - least) / STEPS**2 < LEAST_RISE

    def _rises(self, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the smallest and the largest sine (n,) between a face's plane and its unlifted reflected rays.

        The rays leave each `face` (n,) at `places` (k, 2), in (u, v).
        """
        least, most = np.full(len(face), np.inf), np.full(len(face), -np.inf)
        for place in places:
            uv = np.repeat(place[:, None], len(face), axis=1)
            direction = self.arriving(self.places(face, uv))
            rise = self.surface.rise(face, self.surface.unbent(face, uv, direction), direction)
            least, most = np.minimum(least, rise), np.maximum(most, rise)
        return least, most

    def arriving(self, places: np.ndarray) -> np.ndarray:
        """Return view directions (3, n) at `places` (3, n), as long as the distance from the eye (orthographic: 1)."""
        if self.orthographic:
            return np.broadcast_to(self.forward, places.shape)
        return places - self.eye

    def coordinates(self, face: np.ndarray, places: np.ndarray) -> np.ndarray:
        return self.surface.coordinates(face, places)

    def places(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        return self.surface.places(face, uv)

    def spans(self, face: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.surface.u[:, face], self.surface.v[:, face]

    def first(self, face: np.ndarray) -> np.ndarray:
        return face

    def last(self, face: np.ndarray) -> tuple[MirrorSurface, np.ndarray]:
        return self.surface, face

    def rays(self, face: np.ndarray, uv: np.ndarray) -> np.ndarray:
        if self.parallel:
            return self.constant[:, face]
        direction = self.arriving(self.places(face, uv))
        ray = self.surface.unbent(face, uv, direction)
        part = np.flatnonzero(self.grazing[face])
        if len(part):
            lifted = ray[:, part]
            self.surface.lift(face[part], uv[:, part], lifted, direction[:, part])
            ray[:, part] = lifted
        return ray

    def leave(self, face: np.ndarray, uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        return self.places(face, uv), self.rays(face, uv)

    def met_later(self, face: np.ndarray, uv: np.ndarray) -> list[np.ndarray]:
        return []

    def leaving(self, face: np.ndarray, uv: np.ndarray, bent: bool = True) -> list[np.ndarray]:
        if bent or self.parallel:
            return [self.rays(face, uv)]
        return [self.surface.unbent(face, uv, self.arriving(self.places(face, uv)))]

    def turned_before(self, face: np.ndarray, uv: np.ndarray) -> float:
        return 1.0

    def lifted(self, face: np.ndarray, uv: np.ndarray, slack: float = 0.0) -> np.ndarray:
        found = np.zeros(len(face), dtype=bool)
        part = np.flatnonzero(self.grazing[face])
        if len(part) and not self.parallel:
            face, uv = face[part], uv[:, part]
            direction = self.arriving(self.places(face, uv))
            found[part] = self.surface.enters(face, self.surface.unbent(face, uv, direction), direction, slack)
        return found

    def _gathered(self, face: np.ndarray) -> MirrorSurface:
        """Return the surface's triangles `face` (n,), cached for the steps of Newton's method."""
        if self._last is None or self._last[0] is not face:
            self._last = face, self.surface.select(face)
        return self._last[1]

    def linearise(self, face: np.ndarray, uv: np.ndarray, *ways: Way) -> tuple:
        own, every = self._gathered(face), slice(None)
        place = own.places(every, uv)
        moves = [along(way, own.u, own.v) for way in ways]
        if self.parallel:
            return place, self.constant[:, face], [(move, np.zeros_like(move)) for move in moves]
        seen = [np.zeros_like(move) if self.orthographic else move for move in moves]
        ray, changes = own.derivatives(every, uv, self.arriving(place), list(zip(ways, seen)))
        self._bend(np.flatnonzero(self.lifted(face, uv)), (face, uv), ways, ray, changes)
        return place, ray, list(zip(moves, changes))
