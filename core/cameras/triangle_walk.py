"""Images settled on the mirror triangle that they truly lie on.

Newton's method knows one triangle's map, which goes on beyond its edges. An image that ends outside is looked for again
on the triangle across the edge that it left by; where there is none, it lies beside the mirror and is no image.
"""
from __future__ import annotations

import numpy as np

from ..geometry import norm
from .mirror_map import MirrorMap
from .mirror_surface import drawn_in

STEPS = 6
INSIDE = 1e-9  # of a triangle: rounding
BETWEEN = 1e-3  # of a triangle: what two triangles may each leave to the other at their edge


def settle(mirror_map: MirrorMap, face: np.ndarray, uv: np.ndarray, s: np.ndarray,
           points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Faces, places (u, v) and s of the images of `points` (3, n), and which of them are images at all."""
    face, uv, s, across = face.copy(), uv.copy(), s.copy(), mirror_map.surface.across
    found = np.zeros(len(face), dtype=bool)
    least, corner = _least(uv)
    found[least >= -INSIDE] = True
    wandering = np.flatnonzero(~found)
    came_from, before = np.full(len(face), -1), least
    for _ in range(STEPS):
        following = across[face[wandering], corner[wandering]]
        # left by either of two triangles to the other: on their edge, where the map has a kink
        inner = following >= 0
        back = inner & (following == came_from[wandering]) & (np.minimum(least, before)[wandering] > -BETWEEN)
        found[wandering[back]] = True
        going = inner & ~back
        wandering, following = wandering[going], following[going]
        if not len(wandering):
            break
        place = mirror_map.places(face[wandering], uv[:, wandering])
        came_from[wandering], before[wandering] = face[wandering], least[wandering]
        face[wandering] = following
        target = points[:, wandering]
        uv[:, wandering], s[wandering] = mirror_map.locate(following, mirror_map.coordinates(following, place),
                                                           s[wandering], target)
        least[wandering], corner[wandering] = _least(uv[:, wandering])
        arrived = mirror_map.meets(following, uv[:, wandering], s[wandering], target)
        found[wandering[arrived & (least[wandering] >= -INSIDE)]] = True
        wandering = wandering[arrived & (least[wandering] < -INSIDE)]
    return face, uv, s, found


def distance_from(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> np.ndarray:
    """How far places (3, n) are from the triangles `face` (n,) that they belong to."""
    return _nearest(mirror_map, face, places)[1]


def brought_back(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The nearest to each of the places (3, n) on its triangle (n,) or on the one beyond the edge that it left by, and
    how far away that is."""
    _, corner = _least(mirror_map.coordinates(face, places))
    beyond = mirror_map.surface.across[face, corner]
    near, gap = _nearest(mirror_map, face, places)
    other, other_gap = _nearest(mirror_map, np.where(beyond >= 0, beyond, face), places)
    return np.where(other_gap < gap, other, near), np.minimum(gap, other_gap)


def _nearest(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (3, n) drawn into the triangles, and how far that moves them."""
    drawn = mirror_map.places(face, drawn_in(mirror_map.coordinates(face, places)))
    return drawn, norm(drawn - places)


def _least(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least barycentric coordinate (n,), and its corner."""
    weights = np.stack((1.0 - uv[0] - uv[1], uv[0], uv[1]))
    corner = np.argmin(weights, axis=0)
    return weights[corner, np.arange(len(corner))], corner
