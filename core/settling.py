"""Images settled on the mirror triangle that they truly lie on.

Newton's method knows one triangle's map, which goes on beyond its edges. An image that ends outside is looked for again
on the triangle across the edge that it left by; where there is none, it lies beside the mirror and is no image.
"""
from __future__ import annotations

import numpy as np

from .mirror_map import MirrorMap
from .vectors import norm

STEPS = 6
INSIDE = 1e-9  # of a triangle: rounding
BETWEEN = 1e-3  # of a triangle: what two triangles may each leave to the other at their edge


def settle(mirror_map: MirrorMap, face: np.ndarray, uv: np.ndarray, s: np.ndarray,
           points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Faces, places (u, v) and s of the images of `points` (3, n), and which of them are images at all."""
    face, uv, s, across = face.copy(), uv.copy(), s.copy(), mirror_map.across
    found = np.zeros(len(face), dtype=bool)
    least, corner = _least(uv)
    found[least >= -INSIDE] = True
    wandering = np.flatnonzero(~found)
    came_from, before = np.full(len(face), -1), least
    for _ in range(STEPS):
        following = across[face[wandering], corner[wandering]]
        # left by either of two triangles to the other: on their edge, where the map has a kink
        back = (following == came_from[wandering]) & (np.minimum(least, before)[wandering] > -BETWEEN)
        found[wandering[back]] = True
        going = (following >= 0) & ~back
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


def lies_outside(uv: np.ndarray) -> np.ndarray:
    """Which places (u, v) lie outside their triangle by more than rounding."""
    return _least(uv)[0] < -INSIDE


def brought_back(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray,
                 room: float) -> tuple[np.ndarray, np.ndarray]:
    """Places (3, n) that belong to triangles `face` (n,), those farther than `room` from them and from the triangle
    beyond the edge that they left by brought back to the nearer of the two; and how far each was from it."""
    places, away = places.copy(), np.zeros(len(face))
    least, corner = _least(mirror_map.coordinates(face, places))
    out = np.flatnonzero(least < -INSIDE)
    beyond = mirror_map.across[face[out], corner[out]]
    near, gap = _nearest(mirror_map, face[out], places[:, out])
    other, other_gap = _nearest(mirror_map, np.where(beyond >= 0, beyond, face[out]), places[:, out])
    near, away[out] = np.where(other_gap < gap, other, near), np.minimum(gap, other_gap)
    far = away[out] > room
    places[:, out[far]] = near[:, far]
    return places, away


def _nearest(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Places (3, n) drawn into the triangles, and how far that moves them."""
    uv = np.maximum(mirror_map.coordinates(face, places), 0.0)
    drawn = mirror_map.places(face, uv / np.maximum(uv.sum(axis=0), 1.0))
    return drawn, norm(drawn - places)


def _least(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least barycentric coordinate (n,), and its corner."""
    weights = np.stack((1.0 - uv[0] - uv[1], uv[0], uv[1]))
    corner = np.argmin(weights, axis=0)
    return weights[corner, np.arange(len(corner))], corner
