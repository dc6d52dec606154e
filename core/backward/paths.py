"""Light paths traced backwards: from places on a mirror, over further mirrors, to a diffuse triangle."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import MirrorSurface
from ..culling import SceneAndMirrors
from ..geometry import ColumnArrays, dot, norm, unit
from ..result import DEPTH, GAP, halfway
from ..support import breathe
from ..views import View

NOTHING = -1    # `source` of paths that hit nothing, or a mirror after the last bounce


@dataclass(frozen=True)
class Paths(ColumnArrays):
    """Light paths (n) from the eye.

    Attributes
    ----------
    face : (n,) int64, triangle of the first mirror
    place : (3, n) float64, place on the first mirror that the eye sees, in world space
    origin, ray : (3, n) float64, place on the last mirror, and the unit direction of the ray that leaves it
    source : (n,) int64, the diffuse triangle at the end, or `NOTHING`
    point : (3, n) float64, end of the path in world space
    length : (n,) float64, path length from the first mirror to the last one
    bounces : (n,) int64, number of mirrors
    later : (b, n) int64, triangles of the mirrors after the first one, -1 after the last
    normal : (b + 1, 3, n) float64, unit normals of all mirrors of the path, 0 after the last
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

    @property
    def total(self) -> np.ndarray:
        """(n,) float64, path length from the first mirror to the end."""
        return self.length + norm(self.point - self.origin)


@dataclass(frozen=True)
class PathTracer:
    """Tracer of paths from the eye over mirrors.

    Attributes
    ----------
    view : View
    surface : MirrorSurface, of the first mirror
    met : SceneAndMirrors, triangles that rays may hit
    size : float, extent of the first mirror, which layers before an orthographic eye are measured by
    """

    view: View
    surface: MirrorSurface
    met: SceneAndMirrors
    size: float

    def traced(self, face: np.ndarray, place: np.ndarray, depth: int, enough: float = 0.0
               ) -> tuple[Paths, np.ndarray]:
        """Trace the paths that the eye sees at places (3, n) on triangles `face` (n,) of the first mirror.

        Parameters
        ----------
        depth : int
            Largest number of mirrors of a path.
        enough : float
            Stop early if at most this share of the paths hits one more mirror.

        Returns
        -------
        paths : Paths
        left : (n,) bool
            True for paths that hit one more mirror.
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
        """Return True (n,) for places (3, n) on a mirror with scene objects so close in front that layers would hide
        them.
        """
        back = -self.view.directions(place.T).T
        away = norm(back)
        size = np.full(len(away), self.size) if self.view.orthographic else away
        return self.met.hidden_within(place, back / away, self.met.slide * (GAP + DEPTH) * size, many=True)


def _reflected(surface: MirrorSurface, face: np.ndarray, place: np.ndarray, way: np.ndarray) -> np.ndarray:
    """Return the reflected rays (3, n) at `place` (3, n) for arriving directions `way` (3, n), bent as in Cycles."""
    uv = surface.coordinates(face, place)
    ray = surface.unbent(face, uv, way)
    surface.lift(face, uv, ray, way)
    return ray


def _upper_sides(surface: MirrorSurface, face: np.ndarray, ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the planes of triangles `face` (n,): a place (3, n) on each, and its unit normal (3, n) on the side of the
    leaving rays (3, n).
    """
    normal = surface.face_normal[:, face]
    return surface.a[:, face], normal * np.sign(dot(ray, normal))
