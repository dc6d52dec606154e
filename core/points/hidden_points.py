"""Points that lie behind a mirror, seen from the places on the mirrors that show them."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras
from ..culling import ABOVE, SceneAndMirrors
from ..geometry import cross, dot, norm, ranges, shares, unit
from ..trees import Bound, Cones

IMAGES_AT_ONCE = 500_000  # pairs of an image and a triangle of a mirror that may hide it
MOST_PAIRS = 1 << 22  # of cameras and triangles of mirrors that are asked which images they hide


def hidden_by_mirrors(met: SceneAndMirrors, cameras: Cameras, camera: np.ndarray,
                      places: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which of the `points` (3, n), seen at `places` (3, n) in the cameras (n,), lie behind a mirror."""
    found = met.mirrors_in(cameras, Bound(MOST_PAIRS, np.ones(len(cameras))))
    order = np.argsort(found.cone, kind="stable")
    owner, triangle = found.cone[order], found.triangle[order]
    start = np.searchsorted(owner, camera)
    offered = np.searchsorted(owner, camera, side="right") - start
    hidden = np.zeros(len(camera), dtype=bool)
    # many images in cameras that may see much of a mirror are more pairs than memory holds
    for part in shares(offered, IMAGES_AT_ONCE):
        entry, image = ranges(start[part], offered[part])
        image += part.start
        behind = _passes(met, triangle[entry], places[:, image], points[:, image])
        hidden[image[behind]] = True
    # where cameras see too much of the mirrors, each image is asked for by itself
    alone = np.flatnonzero(found.given_up[camera])
    zero, way = np.zeros(len(alone)), unit(points[:, alone] - places[:, alone])
    rays = Cones(places[:, alone], zero, way, zero, zero + 1.0)
    for image, triangle, _ in met.mirror_tree.traced(rays, np.ones(len(alone), dtype=bool)):
        behind = _passes(met, triangle, places[:, alone[image]], points[:, alone[image]])
        hidden[alone[image[behind]]] = True
    return hidden


def _passes(met: SceneAndMirrors, triangle: np.ndarray, places: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Whether the way from `places` (3, p) to `points` (3, p) passes through triangles (p,) of the mirrors."""
    a, b, c = np.moveaxis(np.take(met.mirror_corners, triangle, axis=1), 2, 0)
    way, offset = points - places, places - a
    normal, turned = cross(b - a, c - a), cross(offset, way)
    facing = -dot(way, normal)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = dot(offset, normal) / facing
        second, third = dot(turned, c - a) / facing, -dot(turned, b - a) / facing
        hit = (second >= 0.0) & (third >= 0.0) & (second + third <= 1.0)
        # a point on a mirror has no way to go
        length = norm(way)
        return hit & (share * length > ABOVE * met.size) & ((1.0 - share) * length > ABOVE * met.size)
