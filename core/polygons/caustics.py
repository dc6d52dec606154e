"""Caustics: faces that fold over are cut where the map's magnification is zero, so that each has one parity.

Across a caustic the image of a point is mirrored, and two images appear or vanish. A face with corners on both sides
would join images of different parity. The cut lies on the caustic itself; the faces on both sides share its nodes.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, may_fold
from ..geometry import SceneFrames, following, mask, numbered, shared_edges
from ..support import portions
from .polygon_corners import Nodes
from .triangulation import Faces

STEPS = 24
PLACES_AT_ONCE = 32768


def split_at_caustics(cameras: Cameras, frames: SceneFrames, nodes: Nodes,
                      faces: Faces) -> tuple[Nodes, Faces, int]:
    """Split faces at caustics so that each has one parity. Only cameras whose rays may cross are examined.

    Returns
    -------
    nodes : Nodes, the given ones, then those on caustics
    faces : Faces
    cut : int, number of edges that were cut
    """
    mirror_map = cameras.mirror_map
    folding = np.flatnonzero(may_fold(cameras)[faces.camera])
    chosen = faces.select(folding)
    start, end = chosen.nodes.ravel(), following(chosen.nodes).ravel()
    face, column = np.repeat(cameras.face[chosen.camera], 3), np.repeat(chosen.column, 3)
    turned = _magnification(mirror_map, frames, face, column, nodes.place[:, start])
    mixed = turned * following(turned.reshape(-1, 3)).ravel() < 0.0
    if not mixed.any():
        return nodes, faces, 0
    ends, _, edge = shared_edges(chosen.nodes)
    owner = np.full(len(ends), -1)
    owner[edge.ravel()[mixed]] = np.flatnonzero(mixed)
    cut = owner >= 0
    owner = owner[cut]
    at = _zero(mirror_map, frames, face[owner], column[owner], nodes.place[:, start[owner]],
               nodes.place[:, end[owner]])
    new = numbered(len(ends), cut, len(nodes))
    children, _ = chosen.split(new[edge])
    resting = faces.select(~mask(len(faces), folding))
    return nodes.joined((nodes, Nodes(*at))), Faces.joined([resting, children]), int(cut.sum())


def _magnification(mirror_map, frames, face, column, place) -> np.ndarray:
    turned = np.empty(len(face))
    for part in portions(len(face), PLACES_AT_ONCE):
        uv = mirror_map.coordinates(face[part], place[:, part])
        s = frames.distance(column[part], *mirror_map.leave(face[part], uv))
        turned[part] = mirror_map.turned(face[part], uv, s)
    return turned


def _zero(mirror_map, frames, face, column, start, end) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Find by bisection the place of zero magnification between two places of opposite parity on the mirror.

    Parameters
    ----------
    face, column : (e,) int64, mirror face, and scene triangle as a column of `frames`
    start, end : (3, e) float64, places on the mirror

    Returns
    -------
    place : (3, e) float64, on the mirror
    point : (3, e) float64, seen there on the scene triangle's plane
    s : (e,) float64, its ray parameter
    """
    low, high = np.zeros(len(face)), np.ones(len(face))
    sign = np.sign(_magnification(mirror_map, frames, face, column, start))
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        same = _magnification(mirror_map, frames, face, column, start + middle * (end - start)) * sign > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    place = start + 0.5 * (low + high) * (end - start)
    origin, ray = mirror_map.leave(face, mirror_map.coordinates(face, place))
    s = np.maximum(frames.distance(column, origin, ray), 0.0)
    return place, origin + s * ray, s
