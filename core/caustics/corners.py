"""Light at the corners of faces, by the derivative of the true map that the lamp sees them by.

Light of the intensity I that has gone the way d to the mirror has the irradiance I / |d|^2 across its direction there.
On its way on a thin bundle of it grows to `turned` times its area across the light, and falls on the receiver with the
cosine c: I c / (|d|^2 |turned|) is the irradiance there, infinite on a caustic, where `turned` is zero. Flat triangles
with smooth normals send a bundle on that is wider or narrower than what came: by the sines of both ways to them.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..cameras import BouncedMap, ReflectionMap
from ..geometry import dot, norm, unit
from .lamps import Lamp

ON_FOLD = 1e-12  # of the growth of a bundle: less is none
ARRIVED = 1e-6  # of the path: by how much the ray of a corner may miss it


@dataclass(frozen=True)
class Corners:
    """Corners of faces of one map.

    Attributes
    ----------
    uv : (2, n) float64
        Where on the map's face.
    irradiance : (n,) float64
        Infinite on a caustic.
    turned : (n,) float64
    cosine : (n,) float64
        At the first mirror.
    place : (3, n) float64
        Where on the first mirror.
    side : (n,) float64
        1 where the front of the receiver is lit, -1 where its back is.
    arrived : (n,) bool
        Whether the ray really comes there.
    """

    uv: np.ndarray
    irradiance: np.ndarray
    turned: np.ndarray
    cosine: np.ndarray
    place: np.ndarray
    side: np.ndarray
    arrived: np.ndarray

    @staticmethod
    def joined(parts: Sequence[Corners], runs: int = 1) -> Corners:
        """Several as one, which are `runs` runs of corners each: run after run."""
        def together(name: str) -> np.ndarray:
            values = [getattr(part, name) for part in parts]
            values = [value.reshape(*value.shape[:-1], runs, -1) for value in values]
            joined = np.concatenate(values, axis=-1)
            return joined.reshape(*joined.shape[:-2], -1)
        return Corners(*(together(name) for name in NAMES))

    def of_parts(self, middles: Corners, parent: np.ndarray, local: np.ndarray, place: np.ndarray) -> Corners:
        """Of parts of faces, whose corners `local` (m, 3) are 0 1 2 of these of their `parent` (m,), or 3 4 5 of the
        `middles` of its sides, which stand at its `place`; all are runs of the first, second and third corners."""
        count, more, corner = self.uv.shape[1] // 3, middles.uv.shape[1] // 3, local.T
        index = np.where(corner < 3, corner * count + parent, (3 * count) + (corner - 3) * more + place[parent]).ravel()

        def chosen(name: str) -> np.ndarray:
            return np.concatenate((getattr(self, name), getattr(middles, name)), axis=-1).take(index, axis=-1)
        return Corners(*(chosen(name) for name in NAMES))


NAMES = tuple(Corners.__dataclass_fields__)


def light_at(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray, points: np.ndarray,
             normals: np.ndarray, lamp: Lamp) -> Corners:
    """What a lamp of unit intensity, times its pattern, sends to `points` (3, n) that it sees at places (u, v) of
    faces, where flat receivers have the unit `normals` (3, n)."""
    origin, ray = ray_map.leave(face, uv)
    length = np.maximum(norm(ray), 1e-300)
    s = dot(points - origin, ray) / length**2
    turned = ray_map.turned(face, uv, s)
    place = ray_map.places(face, uv)
    if ray_map.orthographic:
        way, falling = np.broadcast_to(ray_map.view.forward[:, None], place.shape), np.ones(place.shape[1])
    else:
        way = place - ray_map.view.eye[:, None]
        falling = 1.0 / np.maximum(dot(way, way), 1e-300)
    cosine = -dot(ray, normals) / length
    ways = [unit(way), *map(unit, ray_map.leaving(face, uv))]
    grown = np.abs(turned) * _widened(ray_map, face, ways)
    with np.errstate(divide="ignore"):
        irradiance = np.where(grown > ON_FOLD, falling * np.abs(cosine) / np.maximum(grown, ON_FOLD), np.inf)
    if lamp.pattern is not None:
        share = lamp.share(place.T)
        irradiance = np.where(share > 0.0, irradiance, 0.0) * share
    # a ray is turned by twice the angle that it has to the mirror's plane
    upright = np.sqrt(np.clip(0.5 * (1.0 - dot(ways[0], ways[1])), 0.0, 1.0))
    miss = norm(origin + s * ray - points)
    size = sum(map(norm, ray_map.spans(face)))
    # where the mirror stands on what is lit, light comes from the very place
    arrived = (s * length >= -ARRIVED * size) & (miss <= ARRIVED * (norm(points - origin) + size))
    return Corners(uv, irradiance, turned, upright, place, np.sign(cosine), arrived)


def _widened(ray_map: ReflectionMap, face: np.ndarray, ways: list[np.ndarray]) -> np.ndarray:
    """How much wider (n,) bundles leave the flat triangles of all mirrors than they come; `ways` (3, n) are the unit
    directions of light before the first mirror and behind each."""
    wider = np.ones(len(face))
    for before, after in zip(ways[-2::-1], ways[:0:-1]):
        surface, triangle = ray_map.last(face)
        normal = surface.face_normal[:, triangle]
        wider *= np.abs(dot(after, normal)) / np.maximum(np.abs(dot(before, normal)), 1e-12)
        if isinstance(ray_map, BouncedMap):
            face, ray_map = ray_map.face_before[face], ray_map.before
    return wider
