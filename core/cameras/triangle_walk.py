"""Images settled on the mirror triangle that they truly lie on.

Newton's method knows one triangle's map, which goes on beyond its edges. An image that ends outside is looked for again
on the triangle across the edge that it left by; where there is none, it lies beside the mirror and is no image.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm
from .mirror_map import MirrorMap
from .mirror_surface import drawn_in, least_weight

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
    """How far places (3, n) are from what they are brought back to of the triangles `face` (n,) that they belong to."""
    return norm(_drawn_in(mirror_map, face, places) - places)


def brought_back(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the eye sees nearest to each of the places (3, n) of its triangle (n,) or of the one beyond the edge that it
    left by, and how many pixels away that is. In space what lies a pixel beside a triangle seen all but edge on is far
    from it, and something else in the picture may be nearer."""
    _, corner = _least(mirror_map.coordinates(face, places))
    beyond = mirror_map.surface.across[face, corner]
    own, other = (_drawn_in(mirror_map, one, places) for one in (face, np.where(beyond >= 0, beyond, face)))
    pixels = mirror_map.view.pixels(places.T)
    away, other_away = (np.linalg.norm(mirror_map.view.pixels(one.T) - pixels, axis=1) for one in (own, other))
    return np.where(other_away < away, other, own), np.fmin(away, other_away)


@np.errstate(invalid="ignore", over="ignore")
def _drawn_in(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Places (3, n), those outside of their triangles drawn to the rim, to what the eye sees nearest, in the first
    order."""
    uv = mirror_map.coordinates(face, places)
    out = np.flatnonzero(least_weight(uv) < 0.0)
    gradients = mirror_map.view.pixel_gradients(places[:, out])
    pixels = [np.stack([dot(gradient, span) for gradient in gradients]) for span in mirror_map.spans(face[out])]
    least, rim = np.full(len(out), np.inf), uv[:, out]
    for start, end in (((0.0, 0.0), (1.0, 0.0)), ((1.0, 0.0), (0.0, 1.0)), ((0.0, 1.0), (0.0, 0.0))):
        corner, way = np.array(start)[:, None], np.subtract(end, start)[:, None]
        offset = corner - uv[:, out]
        first, side = (one[0] * pixels[0] + one[1] * pixels[1] for one in (offset, way))
        share = np.clip(-(first * side).sum(axis=0) / np.maximum((side * side).sum(axis=0), 1e-300), 0.0, 1.0)
        distance = ((first + share * side)**2).sum(axis=0)
        rim = np.where(distance < least, corner + share * way, rim)
        least = np.minimum(distance, least)
    # what has no picture, or is seen edge on to the last digit
    uv[:, out] = drawn_in(rim)
    return mirror_map.places(face, uv)


def _least(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least barycentric coordinate (n,), and its corner."""
    weights = np.stack((1.0 - uv[0] - uv[1], uv[0], uv[1]))
    corner = np.argmin(weights, axis=0)
    return weights[corner, np.arange(len(corner))], corner
