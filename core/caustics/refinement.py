"""Splitting of caustic faces until the irradiance is nearly linear in each; near a caustic the faces get very small.

A side is split in both of its faces. Sides on a side of a receiver's triangle are straight on the receiver. They are
split at their midpoint, and Newton's method finds the midpoint's place in the lamp's picture. All other sides, along
mirror triangles and occluders, are straight in the lamp's picture. The ray through the midpoint there finds the lit
point. So each face keeps its exact area in the lamp's picture, which is its flux.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import ReflectionMap, least_weight
from ..geometry import (
    SceneFrames,
    TriangleMesh,
    columns,
    cross,
    dot,
    following,
    norm,
    numbered,
    parent_side,
    shared_edges,
    split,
    unit,
)
from ..support import breathe, portions
from ..views import in_cone
from .corners import Corners, light_at
from .lamps import Lamp

LEVELS = 6
STRAYING = 0.02  # relative error allowed between the irradiance at a side's midpoint and the mean of its ends
AT_ONCE = 1 << 14
STEPS = 8  # Newton steps
BESIDE = 1e-9  # barycentric tolerance: points this little outside of a triangle count as inside
OFF = 0.02  # barycentric: a side's midpoint may lie this much farther outside of the mirror's triangle than its ends


@dataclass(frozen=True)
class LitFaces:
    """Lit faces on the receivers that one reflection map shows.

    Attributes
    ----------
    triangles : (m, 3) int64, vertices of the faces
    points : (3, n) float64, vertices on the receivers, in world space
    face : (m,) int64, face of the map
    normal : (3, m) float64, unit normal of the receiver
    source : (m,) int64, triangle of the receivers
    origin : (m,) int64, the face of the reflection that each is a part of
    on_side : (m, 3) bool, True for the sides 01, 12, 20 that lie on a side of their receiver's triangle
    beside : (m, 3) float64
        Flux between the straight sides 01, 12, 20 and their true curves on the receiver; negative if the curve lies
        inside of the face. NaN until it is computed.
    light : Corners, light at the faces' corners
    """

    triangles: np.ndarray
    points: np.ndarray
    face: np.ndarray
    normal: np.ndarray
    source: np.ndarray
    origin: np.ndarray
    on_side: np.ndarray
    beside: np.ndarray
    light: Corners

    def __len__(self) -> int:
        return len(self.face)

    def corners(self, chosen: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Return the corners (3, 3, k) of the faces `chosen` in world space, as [component, corner, face]."""
        return columns(self.points, self.triangles[chosen].T)


def refined(ray_map: ReflectionMap, faces: LitFaces, receivers: TriangleMesh, lamp: Lamp, least: tuple[float, float],
            most: int) -> tuple[LitFaces, bool]:
    """Split faces until their irradiance is nearly linear.

    Parameters
    ----------
    ray_map : ReflectionMap
    least : (float, float), smallest flux of a face and smallest length of a side that are split
    most : int, largest number of faces

    Returns
    -------
    faces : LitFaces
    bounded : bool, True if `most` stopped the refinement
    """
    with np.errstate(divide="ignore", invalid="ignore"):  # receiver triangles without an area are never lit
        within = SceneFrames.of(receivers, np.arange(len(receivers.triangles)))
    new, bounded = np.ones(len(faces), dtype=bool), False
    for _ in range(LEVELS):
        breathe()
        _, _, edge = shared_edges(faces.triangles)
        asked = np.flatnonzero(new)
        middles, points, found = _middles(ray_map, faces, asked, within, lamp)
        faces.beside[asked] = _beside(faces, asked, middles, points, found)
        chosen = np.zeros(int(edge.max(initial=-1)) + 1, dtype=bool)
        chosen[edge[asked][(_astray(faces, asked, middles, least, lamp) | _wide(faces, asked, lamp)) & found]] = True
        chosen[edge[asked][~found]] = False
        beside = np.flatnonzero(~new & chosen[edge].any(axis=1))
        more, more_points, more_found = _middles(ray_map, faces, beside, within, lamp)
        chosen[edge[beside][~more_found]] = False
        marked = chosen[edge]
        if not marked.any():
            break
        bounded = bool(len(faces) + marked.sum() > most)
        if bounded:
            break
        asked = np.concatenate((asked, beside))
        middles = Corners.joined([middles, more])
        place = numbered(len(faces), asked)
        faces, parent = _split(faces, edge, chosen, (place, middles, np.concatenate((points, more_points), axis=2)))
        new = marked.any(axis=1)[parent]
    asked = np.flatnonzero(np.isnan(faces.beside).any(axis=1))
    faces.beside[asked] = _beside(faces, asked, *_middles(ray_map, faces, asked, within, lamp))
    return faces, bounded


def _astray(faces: LitFaces, asked: np.ndarray, middles: Corners, least: tuple[float, float],
            lamp: Lamp) -> np.ndarray:
    """Return True (k, 3) for sides of the faces `asked` (k,) whose irradiance is not linear.

    The irradiance at the midpoint (`middles`) is compared with the mean of both ends. Faces with less than the `least`
    flux and sides shorter than the least length are False.
    """
    ends, lit = faces.light.irradiance[:, asked].T, middles.irradiance.T
    corners = faces.corners(asked)
    with np.errstate(invalid="ignore"):
        astray = ~(np.abs(0.5 * (ends + following(ends)) - lit) <= STRAYING * np.sqrt(lamp.places) * lit)
    astray &= norm(corners - following(corners)).T > least[1]
    area = 0.5 * norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    mean = np.where(np.isfinite(lit), lit, 0.0).mean(axis=1)
    return astray & (area * mean > least[0])[:, None]


def _wide(faces: LitFaces, asked: np.ndarray, lamp: Lamp) -> np.ndarray:
    """Return True (k, 3) for sides of the faces `asked` (k,) that span a wider angle from the lamp than the details of
    its pattern.
    """
    if not np.isfinite(lamp.narrow):
        return np.zeros((len(asked), 3), dtype=bool)
    ways = faces.light.place[:, :, asked] - lamp.place[:, None, None]
    lit = np.ones(len(asked), dtype=bool) if lamp.cone is None else in_cone(lamp.cone, ways)
    ways = unit(ways)
    return lit[:, None] & (norm(ways - following(ways)).T > 2.0 * np.sin(0.5 * min(lamp.narrow, np.pi)))


def _beside(faces: LitFaces, asked: np.ndarray, middles: Corners, points: np.ndarray, found: np.ndarray) -> np.ndarray:
    """Compute the flux (k, 3) between straight sides of the faces `asked` (k,) and parabolas through their midpoints.

    `points` (3, 3, k) are the true midpoints, as [component, side, face]. The flux is zero if a midpoint was not
    `found` (k, 3), or lies on a caustic.
    """
    corners = faces.corners(asked)
    after = following(corners)
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    beyond = cross(points - 0.5 * (corners + after), after - corners)
    area = 2.0 / 3.0 * (beyond * (normal / np.maximum(norm(normal), 1e-300))[:, None]).sum(axis=0).T
    lit = middles.irradiance.T
    return area * np.where(found & np.isfinite(lit), lit, 0.0)


def _middles(ray_map: ReflectionMap, faces: LitFaces, asked: np.ndarray, within: SceneFrames,
             lamp: Lamp) -> tuple[Corners, np.ndarray, np.ndarray]:
    """Compute the midpoints of the sides 01, 12, 20 of the faces `asked` (k,), with their light.

    Returns
    -------
    middles : Corners, light at the midpoints
    points : (3, 3, k) float64, midpoints on the receivers in world space, as [component, side, face]
    found : (k, 3) bool, True if the midpoint was found
    """
    parts, points, found = [], [], []
    for portion in portions(max(len(asked), 1), AT_ONCE):
        part = asked[portion]
        own, face = np.tile(part, 3), np.tile(faces.face[part], 3)
        uv = faces.light.uv[:, :, part]
        start = 0.5 * (uv + following(uv)).reshape(2, -1)
        corners = faces.corners(part)
        chord = 0.5 * (corners + following(corners)).reshape(3, -1)
        normal, straight = faces.normal[:, own], faces.on_side[part].T.ravel()
        origin, ray = ray_map.leave(face, start)
        falling = dot(ray, normal)
        with np.errstate(divide="ignore", invalid="ignore"):
            point = origin + dot(np.tile(corners[:, 0], 3) - origin, normal) / falling * ray
        point[:, straight] = chord[:, straight]
        good = np.isfinite(point).all(axis=0)
        point[:, ~good] = chord[:, ~good]
        # at grazing angles a small error in the picture may put the point far outside of the receiver's triangle
        good &= straight | (within.weights(faces.source[own], point).min(axis=0) >= -BESIDE)
        own = np.flatnonzero(straight)
        s = dot(point[:, own] - origin[:, own], ray[:, own]) / np.maximum(dot(ray[:, own], ray[:, own]), 1e-300)
        place = start.copy()
        place[:, own], _ = ray_map.locate(face[own], start[:, own], s, point[:, own], STEPS)
        light = light_at(ray_map, face, place, point, normal, lamp)
        # far from its start, Newton's method may have found another image
        size = np.tile(np.ptp(uv, axis=1).max(axis=0), 3)
        good &= light.arrived & (np.abs(place - start).max(axis=0) <= 0.5 * size + 1e-12)
        # the ray must leave the mirror's triangle, up to the distance that the corners lie outside of it
        good &= _off(place) <= np.maximum(_off(uv), _off(following(uv))).ravel() + OFF
        parts.append(light.of_faces())
        points.append(point.reshape(3, 3, -1))
        found.append(good.reshape(3, -1).T)
    return Corners.joined(parts), np.concatenate(points, axis=2), np.concatenate(found)


def _off(uv: np.ndarray) -> np.ndarray:
    """Return the distance (...) of places (2, ...) from their triangles, in barycentric coordinates; 0 inside."""
    return -np.minimum(least_weight(uv), 0.0)


def _split(faces: LitFaces, edge: np.ndarray, chosen: np.ndarray,
           middles: tuple[np.ndarray, Corners, np.ndarray]) -> tuple[LitFaces, np.ndarray]:
    """Split the faces at the midpoints of the `chosen` edges.

    Parameters
    ----------
    edge : (m, 3) int64, edges of the faces
    chosen : (e,) bool, edges to split
    middles : tuple
        For each face its column in the next two, (m,) int64, or -1; light at the midpoints; the midpoints (3, 3, k).

    Returns
    -------
    faces : LitFaces
    parent : (n,) int64, the old face that each new one lies in
    """
    place, light, points = middles
    parent, local = split(chosen[edge])
    vertex = numbered(len(chosen), chosen, faces.points.shape[1])
    # two faces share a side: take its midpoint from the first
    row, side = np.nonzero(chosen[edge] & (place >= 0)[:, None])
    _, first = np.unique(edge[row, side], return_index=True)
    new = points[:, side[first], place[row[first]]]
    six = np.concatenate((faces.triangles, vertex[edge]), axis=1)[parent]
    triangles = np.take_along_axis(six, local, axis=1)
    side = parent_side(local)
    on_side = (side < 3) & faces.on_side[parent[:, None], np.minimum(side, 2)]
    lit = faces.light.of_parts(light, parent, local, place)
    return LitFaces(triangles, np.concatenate((faces.points, new), axis=1), faces.face[parent], faces.normal[:, parent],
                    faces.source[parent], faces.origin[parent], on_side,
                    np.where(chosen[edge].any(axis=1)[:, None], np.nan, faces.beside)[parent], lit), parent
