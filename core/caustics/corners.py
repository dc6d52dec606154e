"""Light at the corners of faces, by the derivative of the true map that the lamp sees them by.

Light of the intensity I that has gone the way d to the mirror has the irradiance I / |d|^2 across its direction there.
On its way on a thin bundle of it grows to `turned` times its area across the light, and falls on the receiver with the
cosine c: I c / (|d|^2 |turned|) is the irradiance there, infinite on a caustic, where `turned` is zero.

Flat triangles with smooth normals send a bundle on that is wider or narrower than what came, by the sines of both ways
to them. A path tracer, which comes from the receiver, does not see that: it finds the lamp as bright as ever in what it
sees of the triangle. So that both find the same, light must be weighted by how much wider its bundle leaves. E. Veach,
"Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.3.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import BouncedMap, ReflectionMap
from ..geometry import ColumnArrays, dot, following, norm, unit
from ..support import portions
from .lamps import Lamp, mean_of_seven

AT_ONCE = 1 << 13
ON_FOLD = 1e-12  # of the growth of a bundle: less is none
SMALLEST = 1e-12  # sine of a way to a triangle: one that runs along it is counted as if it did not quite
ARRIVED = 1e-6  # of the path: by how much the ray of a corner may miss it


@dataclass(frozen=True)
class Corners(ColumnArrays):
    """The three corners of each of m faces of one map.

    Attributes
    ----------
    uv : (2, 3, m) float64, where on the map's face, as [coordinate, corner, face]
    irradiance : (3, m) float64, infinite on a caustic
    turned : (3, m) float64
    cosine : (b, 3, m) float64, at each of the mirrors, the first one first; negative at the back of its triangle
    place : (3, 3, m) float64, where on the first mirror, as [component, corner, face]
    side : (3, m) float64, 1 where the front of the receiver is lit, -1 where its back is
    arrived : (3, m) bool, whether the ray really comes there
    """

    uv: np.ndarray
    irradiance: np.ndarray
    turned: np.ndarray
    cosine: np.ndarray
    place: np.ndarray
    side: np.ndarray
    arrived: np.ndarray

    def of_faces(self) -> Corners:
        """What is told of the first corners of m faces, behind them of the second and of the third, as theirs."""
        return Corners(*(values.reshape(*values.shape[:-1], 3, -1) for values in self._values()))

    def of_parts(self, middles: Corners, parent: np.ndarray, local: np.ndarray, place: np.ndarray) -> Corners:
        """Of parts of faces, whose corners `local` (m, 3) are 0 1 2 of these of their `parent` (m,), or 3 4 5 of the
        `middles` of its sides, which stand at its `place`."""
        corner = local.T
        index = np.where(corner < 3, corner * len(self) + parent,
                         3 * len(self) + (corner - 3) * len(middles) + place[parent])

        def chosen(*values: np.ndarray) -> np.ndarray:
            return np.concatenate([value.reshape(*value.shape[:-2], -1) for value in values], axis=-1).take(index, -1)
        return Corners(*map(chosen, self._values(), middles._values()))


def light_at(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray, points: np.ndarray,
             normals: np.ndarray, lamp: Lamp) -> Corners:
    """What a lamp of unit intensity, times its pattern, sends to `points` (3, n) that it sees at places (u, v) of
    faces, where flat receivers have the unit `normals` (3, n): told of n places, not of the corners of m faces."""
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
    ways = [way, *ray_map.leaving(face, uv)]
    widened, weight = _widened(ray_map, face, uv, ways)
    grown = np.abs(turned) * widened
    with np.errstate(divide="ignore"):
        irradiance = np.where(grown > ON_FOLD, falling * np.abs(cosine) / np.maximum(grown, ON_FOLD), np.inf)
    irradiance = np.where(weight > 0.0, irradiance, 0.0) * weight
    if lamp.pattern is not None:
        share = lamp.share(place.T)
        irradiance = np.where(share > 0.0, irradiance, 0.0) * share
    # a ray is turned by twice the angle that it has to the mirror's plane
    directions = [unit(way) for way in ways]
    upright = np.stack([np.sqrt(np.clip(0.5 * (1.0 - dot(came, sent)), 0.0, 1.0))
                        for came, sent in zip(directions, directions[1:])])
    upright *= _sides(ray_map, face, directions[:-1])
    miss = norm(origin + s * ray - points)
    size = sum(map(norm, ray_map.spans(face)))
    # where the mirror stands on what is lit, light comes from the very place
    arrived = (s * length >= -ARRIVED * size) & (miss <= ARRIVED * (norm(points - origin) + size))
    return Corners(uv, irradiance, turned, upright, place, np.sign(cosine), arrived)


def _sides(ray_map: ReflectionMap, face: np.ndarray, came: list[np.ndarray]) -> np.ndarray:
    """1 where light, whose ways (3, n) `came` to the mirrors, meets the fronts of their triangles, -1 where their
    backs, as (b, n)."""
    sides = []
    for way in came[::-1]:
        surface, triangle = ray_map.last(face)
        sides.append(np.where(dot(way, surface.face_normal[:, triangle]) > 0.0, -1.0, 1.0))
        if isinstance(ray_map, BouncedMap):
            face, ray_map = ray_map.face_before[face], ray_map.before
    return np.stack(sides[::-1])


def mean_weight(ray_map: ReflectionMap, face: np.ndarray, light: Corners, lamp: Lamp) -> np.ndarray:
    """What counts (m,) of the light of faces with these corners, of the lamp's pattern times the weight: what a path
    tracer sees of the light that comes, 1 where normals are those of the faces.

    Over the places of a face it is asked for by the light that comes: as these are seen from the lamp, and as steeply
    as it falls on the mirrors. Where it grazes them the weight alone has no bounds.
    """
    counted = np.empty(len(face))
    for own in portions(len(face), AT_ONCE):
        corners = light.uv[:, :, own]
        places = np.concatenate((corners, 0.5 * (corners + following(corners)), corners.mean(axis=1, keepdims=True)), 1)
        sent, came = (values.reshape(7, -1) for values in _passed(
            ray_map, np.tile(face[own], 7), places.reshape(2, -1), lamp))
        sent, came = (mean_of_seven(values[:3], values[3:6], values[6]) for values in (sent, came))
        counted[own] = sent / np.where(came > 0.0, came, 1.0)
    return counted


def _passed(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray, lamp: Lamp) -> tuple[np.ndarray, np.ndarray]:
    """The lamp's light (n,) that is found on an area of the first mirror, and that which comes there."""
    place = ray_map.places(face, uv)
    way = ray_map.view.forward[:, None] if ray_map.orthographic else place - ray_map.view.eye[:, None]
    ways = [np.broadcast_to(way, place.shape), *ray_map.leaving(face, uv)]
    falling = 1.0 / np.maximum(dot(ways[0], ways[0]), 1e-300)
    _, sent, came = _rises(ray_map, face, uv, ways)
    return sent * falling * lamp.share(place.T), came * falling


def _widened(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray,
             ways: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """How much wider (n,) bundles leave the flat triangles of all mirrors than they come, and their weight (n,); `ways`
    (3, n) are the light's directions before the first mirror and behind each."""
    lifted, sent, came = _rises(ray_map, face, uv, ways)
    came = np.maximum(came, SMALLEST)
    return lifted / came, sent / came


def _rises(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray,
           ways: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """How steeply (n,) light leaves the flat triangles of all mirrors, the sines multiplied; how steeply it would as a
    path tracer finds it; and how steeply it came.

    The first two differ where rays would enter a triangle and are lifted: a path tracer that comes along the lifted ray
    finds no light there, and as much less before as the ray rises less.
    """
    ways = [unit(way) for way in ways]
    lifted, came = _sines(ray_map, face, ways, ways[1:])
    asked, sent = np.flatnonzero(ray_map.grazing[face]), lifted
    if len(asked):
        unbent = [unit(way) for way in ray_map.leaving(face[asked], uv[:, asked], False)]
        sent = lifted.copy()
        sent[asked], _ = _sines(ray_map, face[asked], [way[:, asked] for way in ways], unbent)
    return lifted, sent, came


def _sines(ray_map: ReflectionMap, face: np.ndarray, came: list[np.ndarray],
           sent: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """How steeply (n,) light leaves the flat triangles of mirrors, and how steeply it comes, the sines multiplied: of
    unit vectors (3, n) that `came`, and were `sent` on."""
    rises, falls = np.ones(len(face)), np.ones(len(face))
    for before, after in zip(came[len(sent) - 1::-1], sent[::-1]):
        surface, triangle = ray_map.last(face)
        falls *= np.abs(dot(before, surface.face_normal[:, triangle]))
        rises *= np.maximum(surface.rise(triangle, after, before), 0.0)
        if isinstance(ray_map, BouncedMap):
            face, ray_map = ray_map.face_before[face], ray_map.before
    return rises, falls
