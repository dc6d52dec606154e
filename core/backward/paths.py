"""Light paths traced backwards: from places on a mirror, mirror after mirror, to what they end at."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import MirrorSurface
from ..culling import SceneAndMirrors
from ..geometry import ColumnArrays, dot, norm, unit
from ..result import DEPTH, GAP, halfway
from ..support import breathe
from ..views import View

NOTHING = -1    # `source` of paths that end at nothing, or at a mirror after the last bounce


@dataclass(frozen=True)
class Paths(ColumnArrays):
    """Light paths (n) from the eye.

    Attributes
    ----------
    face : (n,) int64, the first mirror's triangle
    place : (3, n) float64, where the eye sees the first mirror
    origin, ray : (3, n) float64, where the path leaves the last mirror, and the unit direction
    source : (n,) int64, the diffuse triangle that it ends at, or `NOTHING`
    point : (3, n) float64, where it ends
    length : (n,) float64, from the first mirror to the last one
    bounces : (n,) int64, mirrors that it meets
    later : (b, n) int64, triangles of all mirrors after the first one, -1 behind the last
    normal : (b + 1, 3, n) float64, unit normals of all its mirrors, 0 behind the last
    """

    face: np.ndarray
    place: np.ndarray
    origin: np.ndarray
    ray: np.ndarray
    source: np.ndarray
    point: np.ndarray
    length: np.ndarray
    bounces: np.ndarray
    later: np.ndarray
    normal: np.ndarray


@dataclass(frozen=True)
class PathTracer:
    """What paths from an eye meet.

    Attributes
    ----------
    view : View
    surface : MirrorSurface, of the first mirror
    met : SceneAndMirrors
    """

    view: View
    surface: MirrorSurface
    met: SceneAndMirrors

    def traced(self, face: np.ndarray, place: np.ndarray, depth: int, enough: float = 0.0
               ) -> tuple[Paths, np.ndarray]:
        """Trace the paths that the eye sees at places (3, n) on triangles `face` (n,) of the first mirror.

        Parameters
        ----------
        depth : int
            Mirrors that are met at most.
        enough : float
            Share of the paths that may meet one mirror more and be left at that.

        Returns
        -------
        paths : Paths
        left : (n,) bool
            Those that meet one mirror more.
        """
        met, count = self.met, len(face)
        way = self.view.directions(place.T).T
        away = norm(way)
        ray = unit(_reflected(self.surface, face, place, way))
        normals, later = [halfway(way, ray)], []
        ends, last, source = place.copy(), ray.copy(), np.full(count, NOTHING)
        point, length, bounces = place + ray * away, np.zeros(count), np.ones(count, dtype=np.int64)
        at, origin, planes = np.arange(count), place, (self.surface, face)
        for bounce in range(1, depth + 1):
            breathe()
            triangle, distance = met.first_met(_upper_sides(*planes, ray), origin, ray, many=True)
            found = (triangle >= 0) & (triangle < met.diffuse)
            source[at[found]] = triangle[found]
            point[:, at[found]] = origin[:, found] + distance[found] * ray[:, found]
            on = np.flatnonzero(triangle >= met.diffuse)
            on = on[met.reflecting[triangle[on] - met.diffuse]]
            if bounce == depth or len(on) <= enough * count:
                break
            at, mirror, arriving, step = at[on], triangle[on] - met.diffuse, ray[:, on], distance[on]
            origin = origin[:, on] + step * arriving
            ray = unit(_reflected(met.surface, mirror, origin, arriving))
            normals.append(np.zeros((3, count)))
            normals[-1][:, at] = halfway(arriving, ray)
            later.append(np.full(count, -1))
            later[-1][at] = met.given[mirror]
            length[at] += step
            bounces[at] += 1
            ends[:, at], last[:, at], planes = origin, ray, (met.surface, mirror)
            point[:, at] = origin + ray * away[at]
        left = np.zeros(count, dtype=bool)
        left[at[on]] = True
        return Paths(face, place, ends, last, source, point, length, bounces,
                     np.stack(later) if later else np.zeros((0, count), dtype=np.int64), np.stack(normals)), left

    def covered(self, place: np.ndarray) -> np.ndarray:
        """Return True for places (3, n) on a mirror before which the scene is so near that layers would cover it."""
        back = -self.view.directions(place.T).T
        away = norm(back)
        size = np.full(len(away), np.ptp(place, axis=1).max()) if self.view.orthographic else away
        return self.met.hidden_within(place, back / away, self.met.slide * (GAP + DEPTH) * size, many=True)


def _reflected(surface: MirrorSurface, face: np.ndarray, place: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Return the rays (3, n) that leave triangles where they are met along a way (3, n), as Cycles bends them."""
    uv = surface.coordinates(face, place)
    ray = surface.unbent(face, uv, way)
    surface.lift(face, uv, ray, way)
    return ray


def _upper_sides(surface: MirrorSurface, face: np.ndarray, ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the planes (n) of triangles: a place on each, and its normal on the side that rays (3, n) leave."""
    normal = surface.face_normal[:, face]
    return surface.a[:, face], normal * np.sign(dot(ray, normal))
