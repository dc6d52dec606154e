"""A walk of images from triangle to triangle, to the mirror triangle that they lie on.

Newton's method uses the map of one triangle, which continues beyond its edges. An image that ends outside is searched
again on the triangle across the edge that it left by. Without such a triangle it lies off the mirror and is no image.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm
from .mirror_map import MirrorMap
from .mirror_surface import drawn_in, least_weight

STEPS = 6
INSIDE = 1e-9  # barycentric tolerance for rounding: images this little outside of a triangle count as inside
BETWEEN = 1e-3  # barycentric: width of the strip at an edge in which an image that belongs to neither side is accepted


def settle(mirror_map: MirrorMap, face: np.ndarray, uv: np.ndarray, s: np.ndarray,
           points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Walk images to the triangles that they lie on.

    Parameters
    ----------
    face, uv, s : (n,), (2, n), (n,), triangle, place and distance found by Newton's method on a first triangle
    points : (3, n) float64, reflected points in world space

    Returns
    -------
    face : (n,) int64
    uv : (2, n) float64
    s : (n,) float64
    found : (n,) bool, True for images on the mirror
    """
    face, uv, s, across = face.copy(), uv.copy(), s.copy(), mirror_map.surface.across
    found = np.zeros(len(face), dtype=bool)
    least, corner = _least(uv)
    found[least >= -INSIDE] = True
    wandering = np.flatnonzero(~found)
    came_from, before = np.full(len(face), -1), least
    for _ in range(STEPS):
        following = across[face[wandering], corner[wandering]]
        # each of two triangles sends the image to the other: it lies on their edge, where the map has a kink
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
    """Return the distances (n,) from `places` (3, n) to the places on their triangles `face` (n,) they would move to.

    The distance is zero for places inside of their triangle.
    """
    return norm(_drawn_in(mirror_map, face, places) - places)


def brought_back(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Move `places` (3, n) to the nearest place in the picture on their triangle, or on the one across the edge.

    The distance is measured in the picture, not in space: places a pixel outside of an almost edge-on triangle are far
    away from it in space.

    Parameters
    ----------
    face : (n,) int64, triangle of each place

    Returns
    -------
    places : (3, n) float64
    away : (n,) float64, distance moved, in pixels
    """
    _, corner = _least(mirror_map.coordinates(face, places))
    beyond = mirror_map.surface.across[face, corner]
    own, other = (_drawn_in(mirror_map, one, places) for one in (face, np.where(beyond >= 0, beyond, face)))
    pixels = mirror_map.view.pixels(places.T)
    away, other_away = (np.linalg.norm(mirror_map.view.pixels(one.T) - pixels, axis=1) for one in (own, other))
    return np.where(other_away < away, other, own), np.fmin(away, other_away)


@np.errstate(invalid="ignore", over="ignore")
def _drawn_in(mirror_map: MirrorMap, face: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return `places` (3, n), with those outside of their triangles moved to the border place nearest in the picture.

    The projection to the picture is linearised at each place.
    """
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
    # clamp once more: triangles without a picture, or exactly edge-on, give no reliable place
    uv[:, out] = drawn_in(rim)
    return mirror_map.places(face, uv)


def _least(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the least barycentric coordinate (n,), and the corner (n,) that it belongs to."""
    weights = np.stack((1.0 - uv[0] - uv[1], uv[0], uv[1]))
    corner = np.argmin(weights, axis=0)
    return weights[corner, np.arange(len(corner))], corner
