"""Faces split until their irradiance is nearly linear in each, and so finely towards a caustic, where it is infinite.

Sides are split on both their faces. Those on a side of a receiver's triangle are straight there, and are split in the
middle; Newton's method tells where the lamp sees it. All others, along the mirror's triangles and what hides, are
straight in the lamp's picture, and the ray through the middle there tells where its light falls. So the faces have
their exact share of the picture, which is the flux.
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
STRAYING = 0.02  # of the irradiance in the middle of a side: by how much that on its ends may miss it
AT_ONCE = 1 << 14
STEPS = 8  # of Newton's method
BESIDE = 1e-9  # barycentric: what lies that little beside a triangle lies in it
OFF = 0.02  # barycentric: by how much more than its ends a side's middle may lie beside the mirror's triangle


@dataclass(frozen=True)
class LitFaces:
    """Faces of one map.

    Attributes
    ----------
    triangles : (m, 3) int64
    points : (3, n) float64, of the vertices, on the receivers
    face : (m,) int64, of the map
    normal : (3, m) float64, unit normal of the receiver
    source : (m,) int64, triangle of the receivers
    origin : (m,) int64, the face of the reflection that each is a part of
    on_side : (m, 3) bool, which of the sides 01, 12, 20 lie on a side of their receiver's triangle
    beside : (m, 3) float64
        Their light that falls beyond the sides 01, 12, 20, for those that are straight in the lamp's picture are curves
        on the receiver; negative where it ends before them. Not a number until it has been asked for.
    light : Corners, of the corners
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
        """(3, 3, k) of the faces `chosen`, as [component, corner, face]."""
        return columns(self.points, self.triangles[chosen].T)


def refined(ray_map: ReflectionMap, faces: LitFaces, receivers: TriangleMesh, lamp: Lamp, least: tuple[float, float],
            most: int) -> tuple[LitFaces, bool]:
    """The faces in parts; for none that carries less than the `least` flux, or on sides of less than the least length,
    and not in more than `most`. And whether that ended it."""
    with np.errstate(divide="ignore", invalid="ignore"):  # what has no area is not lit
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
    """On which sides (k, 3) of the faces asked the irradiance in the middle is not that between the ends."""
    ends, lit = faces.light.irradiance[:, asked].T, middles.irradiance.T
    corners = faces.corners(asked)
    with np.errstate(invalid="ignore"):
        astray = ~(np.abs(0.5 * (ends + following(ends)) - lit) <= STRAYING * np.sqrt(lamp.places) * lit)
    astray &= norm(corners - following(corners)).T > least[1]
    area = 0.5 * norm(cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    mean = np.where(np.isfinite(lit), lit, 0.0).mean(axis=1)
    return astray & (area * mean > least[0])[:, None]


def _wide(faces: LitFaces, asked: np.ndarray, lamp: Lamp) -> np.ndarray:
    """Which sides (k, 3) of the faces asked span more of the lamp's picture than what its pattern may hold."""
    if not np.isfinite(lamp.narrow):
        return np.zeros((len(asked), 3), dtype=bool)
    ways = faces.light.place[:, :, asked] - lamp.place[:, None, None]
    lit = np.ones(len(asked), dtype=bool) if lamp.cone is None else in_cone(lamp.cone, ways)
    ways = unit(ways)
    return lit[:, None] & (norm(ways - following(ways)).T > 2.0 * np.sin(0.5 * min(lamp.narrow, np.pi)))


def _beside(faces: LitFaces, asked: np.ndarray, middles: Corners, points: np.ndarray, found: np.ndarray) -> np.ndarray:
    """The light (k, 3) between the sides of the faces asked and parabolas through their `points` (3, 3, k) as
    [component, side, face]; none where these were not `found` (k, 3), or are on a caustic."""
    corners = faces.corners(asked)
    after = following(corners)
    normal = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    beyond = cross(points - 0.5 * (corners + after), after - corners)
    area = 2.0 / 3.0 * (beyond * (normal / np.maximum(norm(normal), 1e-300))[:, None]).sum(axis=0).T
    lit = middles.irradiance.T
    return area * np.where(found & np.isfinite(lit), lit, 0.0)


def _middles(ray_map: ReflectionMap, faces: LitFaces, asked: np.ndarray, within: SceneFrames,
             lamp: Lamp) -> tuple[Corners, np.ndarray, np.ndarray]:
    """The light in the middles of the sides 01, 12, 20 of the faces `asked` (k,), where these are, (3, 3, k) as
    [component, side, face], and whether (k, 3) they were found."""
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
        # where light grazes, a line of the picture within the tolerance may run far out over the receiver's side
        good &= straight | (within.weights(faces.source[own], point).min(axis=0) >= -BESIDE)
        own = np.flatnonzero(straight)
        s = dot(point[:, own] - origin[:, own], ray[:, own]) / np.maximum(dot(ray[:, own], ray[:, own]), 1e-300)
        place = start.copy()
        place[:, own], _ = ray_map.locate(face[own], start[:, own], s, point[:, own], STEPS)
        light = light_at(ray_map, face, place, point, normal, lamp)
        # beyond its face Newton's method may have found another image
        size = np.tile(np.ptp(uv, axis=1).max(axis=0), 3)
        good &= light.arrived & (np.abs(place - start).max(axis=0) <= 0.5 * size + 1e-12)
        # nor does light come from beyond the mirror's triangle, but for what corners may lie beside it
        good &= _off(place) <= np.maximum(_off(uv), _off(following(uv))).ravel() + OFF
        parts.append(light.of_faces())
        points.append(point.reshape(3, 3, -1))
        found.append(good.reshape(3, -1).T)
    return Corners.joined(parts), np.concatenate(points, axis=2), np.concatenate(found)


def _off(uv: np.ndarray) -> np.ndarray:
    """How far places (2, ...) lie beside their triangles, in barycentric coordinates; 0 within."""
    return -np.minimum(least_weight(uv), 0.0)


def _split(faces: LitFaces, edge: np.ndarray, chosen: np.ndarray,
           middles: tuple[np.ndarray, Corners, np.ndarray]) -> tuple[LitFaces, np.ndarray]:
    """The faces split at the middles of the `chosen` edges, and the face that each lies in. Of the `middles` it is told
    where each face (m,) has them, their light, and where they are."""
    place, light, points = middles
    parent, local = split(chosen[edge])
    vertex = numbered(len(chosen), chosen, faces.points.shape[1])
    # of two faces the first tells where their side's middle is
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
