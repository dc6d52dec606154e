"""Light at the corners of faces, from the derivative of the true map from the lamp's picture.

Light of intensity I that has travelled the vector d to the mirror has the irradiance I / |d|^2 there, on a plane
perpendicular to it. After the mirror, the cross section of a thin bundle grows by the factor `turned`. It arrives at
the receiver with the cosine c, so the irradiance there is I c / (|d|^2 |turned|). It is infinite on a caustic, where
`turned` is zero.

Flat triangles with smooth normals change the cross section of a bundle, by the ratio of the sines of the leaving and
the arriving ray to the triangle. A path tracer that comes from the receiver does not know this factor: it finds the
lamp at full brightness in its image of the triangle. To get the same result, light is weighted by the growth of its
bundle. E. Veach, "Robust Monte Carlo Methods for Light Transport Simulation", 1997, section 5.3.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import BouncedMap, ReflectionMap
from ..geometry import ColumnArrays, dot, following, norm, unit
from ..support import portions
from .lamps import Lamp, mean_of_seven

AT_ONCE = 1 << 13
ON_FOLD = 1e-12  # growth of a bundle below which it counts as zero: the irradiance is infinite
SMALLEST = 1e-12  # smallest sine between a ray and a triangle's plane: keeps the ratio of sines finite
ARRIVED = 1e-6  # share of the path length: largest distance at which a corner's ray counts as hitting its point


@dataclass(frozen=True)
class Corners(ColumnArrays):
    """The three corners of each of m faces of one map.

    Attributes
    ----------
    uv : (2, 3, m) float64, place on the map's face, as [coordinate, corner, face]
    irradiance : (3, m) float64, infinite on a caustic
    turned : (3, m) float64, area growth of the ray bundle, `ReflectionMap.turned`
    cosine : (b, 3, m) float64, at each of the b mirrors, the first one first; negative at the back of its triangle
    place : (3, 3, m) float64, place on the first mirror in world space, as [component, corner, face]
    side : (3, m) float64, 1 if the front of the receiver is lit, -1 if its back is lit
    arrived : (3, m) bool, True if the ray hits the corner
    """

    uv: np.ndarray
    irradiance: np.ndarray
    turned: np.ndarray
    cosine: np.ndarray
    place: np.ndarray
    side: np.ndarray
    arrived: np.ndarray

    def of_faces(self) -> Corners:
        """Reshape the data of 3 m places to the corners of m faces: first all first corners, then all second, third."""
        return Corners(*(values.reshape(*values.shape[:-1], 3, -1) for values in self._values()))

    def of_parts(self, middles: Corners, parent: np.ndarray, local: np.ndarray, place: np.ndarray) -> Corners:
        """Collect the corner data of the m parts that faces were split into.

        Parameters
        ----------
        middles : Corners, data at the midpoints of the sides of the faces that are split
        parent : (m,) int64, the face that each part lies in
        local : (m, 3) int64, the part's corners: 0, 1, 2 are corners of the parent, 3, 4, 5 midpoints of its sides
        place : (n,) int64, for each of the n parent faces its column in `middles`
        """
        corner = local.T
        index = np.where(corner < 3, corner * len(self) + parent,
                         3 * len(self) + (corner - 3) * len(middles) + place[parent])

        def chosen(*values: np.ndarray) -> np.ndarray:
            return np.concatenate([value.reshape(*value.shape[:-2], -1) for value in values], axis=-1).take(index, -1)
        return Corners(*map(chosen, self._values(), middles._values()))


def light_at(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray, points: np.ndarray,
             normals: np.ndarray, lamp: Lamp) -> Corners:
    """Compute the light of a lamp of unit intensity, times its pattern, at n points.

    Parameters
    ----------
    ray_map : ReflectionMap
    face : (n,) int64, face of the map that the lamp sees each point in
    uv : (2, n) float64, place in that face
    points : (3, n) float64, lit points in world space
    normals : (3, n) float64, unit normals of the flat receivers
    lamp : Lamp

    Returns
    -------
    Corners
        Data of the n points, in arrays with a last axis of length n. `Corners.of_faces` reshapes them to faces.
    """
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
    # half the deflection of a ray is its angle to the mirror, whose sine is the cosine of incidence
    directions = [unit(way) for way in ways]
    upright = np.stack([np.sqrt(np.clip(0.5 * (1.0 - dot(came, sent)), 0.0, 1.0))
                        for came, sent in zip(directions, directions[1:])])
    upright *= _sides(ray_map, face, directions[:-1])
    miss = norm(origin + s * ray - points)
    size = sum(map(norm, ray_map.spans(face)))
    # s may be slightly negative by rounding at points where the mirror touches the receiver
    arrived = (s * length >= -ARRIVED * size) & (miss <= ARRIVED * (norm(points - origin) + size))
    return Corners(uv, irradiance, turned, upright, place, np.sign(cosine), arrived)


def _sides(ray_map: ReflectionMap, face: np.ndarray, came: list[np.ndarray]) -> np.ndarray:
    """Return (b, n) float64: 1 if light hits the front of a mirror triangle, -1 if it hits the back.

    Row i belongs to mirror i on the light's path from the lamp. The front is the side from which the corners of the
    triangle run counterclockwise.

    Parameters
    ----------
    face : (n,) int64, face of the `ray_map` for each ray: one mirror triangle, or a chain of b mirror triangles
    came : list of b arrays (3, n), directions in which the light travels before it hits each mirror
    """
    sides = []
    for way in came[::-1]:
        surface, triangle = ray_map.last(face)
        sides.append(np.where(dot(way, surface.face_normal[:, triangle]) > 0.0, -1.0, 1.0))
        if isinstance(ray_map, BouncedMap):
            face, ray_map = ray_map.face_before[face], ray_map.before
    return np.stack(sides[::-1])


def mean_weight(ray_map: ReflectionMap, face: np.ndarray, light: Corners, lamp: Lamp) -> np.ndarray:
    """Return the mean (m,) over each face of the lamp's pattern times the shading-normal weight.

    The pattern is `lamp.share`, the relative intensity towards a place on the first mirror.

    The weight is the share of the arriving light that a path tracer finds: the product over all mirrors of
    sin(leaving) / sin(arriving). These are the angles of the light's rays to the flat mirror triangle. Leaving rays
    count before they are lifted, and as zero if they would enter the triangle. The weight is 1 if the shading normals
    are the face normals.

    The mean is taken over the face's area on the first mirror, at seven points. It is weighted by the product of
    sin(arriving), divided by the squared distance from a lamp that is not a sun. For such a lamp and one mirror it is
    the mean over solid angle. Without the sines the mean would be unbounded at grazing angles.

    Parameters
    ----------
    face : (m,) int64, face of `ray_map` that each lit face is seen in
    light : Corners, of the m lit faces; only `uv` is used
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
    """Return the lamp's light (n,) that a path tracer finds per area of the first mirror, and the light (n,) that
    arrives there.
    """
    place = ray_map.places(face, uv)
    way = ray_map.view.forward[:, None] if ray_map.orthographic else place - ray_map.view.eye[:, None]
    ways = [np.broadcast_to(way, place.shape), *ray_map.leaving(face, uv)]
    falling = 1.0 / np.maximum(dot(ways[0], ways[0]), 1e-300)
    _, sent, came = _rises(ray_map, face, uv, ways)
    return sent * falling * lamp.share(place.T), came * falling


def _widened(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray,
             ways: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the growth (n,) of bundles at the flat triangles of all mirrors, and their shading-normal weight (n,).

    The growth is the ratio of a bundle's cross sections after and before the mirrors. `ways` holds the light's
    directions (3, n) before the first mirror and after each mirror.
    """
    lifted, sent, came = _rises(ray_map, face, uv, ways)
    came = np.maximum(came, SMALLEST)
    return lifted / came, sent / came


def _rises(ray_map: ReflectionMap, face: np.ndarray, uv: np.ndarray,
           ways: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return products over all mirrors of the sines between light and the mirrors' flat triangles.

    The first two results differ only where rays would enter a triangle and are lifted. A path tracer that arrives along
    the lifted ray finds no light there, and less light before that, in proportion to the sine.

    Returns
    -------
    lifted : (n,) float64, sines of the leaving rays
    sent : (n,) float64, sines of the leaving rays before they are lifted, as a path tracer weights them
    came : (n,) float64, sines of the arriving rays
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
    """Return the products (n,) over all mirrors of the sines of leaving rays, and of arriving rays.

    The sines are those of the angles to the flat triangles. `came` and `sent` hold the unit directions (3, n) before
    and after each mirror.
    """
    rises, falls = np.ones(len(face)), np.ones(len(face))
    for before, after in zip(came[len(sent) - 1::-1], sent[::-1]):
        surface, triangle = ray_map.last(face)
        falls *= np.abs(dot(before, surface.face_normal[:, triangle]))
        rises *= np.maximum(surface.rise(triangle, after, before), 0.0)
        if isinstance(ray_map, BouncedMap):
            face, ray_map = ray_map.face_before[face], ray_map.before
    return rises, falls
