"""The horizon of a smooth mirror: cameras end where their rays would go below the flat face that they leave.

Where the interpolated normal turns the reflected ray under the flat triangle, near silhouettes, there is no reflection:
the ray would start inside the body. (Cycles bends the normal there instead, C. Schlick's and others' old trouble with
shading normals.) Without this cut those slivers fold over and show what lies behind the mirror.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .mirror_map import MirrorMap
from .subdivision import split
from .vectors import dot
from .view import View

STEPS = 30


def cut_at_horizon(view: View, mirror_map: MirrorMap, cameras: Cameras) -> Cameras:
    """The parts of the cameras, each still on its whole mirror triangle, whose rays leave on the eye's side of it."""
    rise = _rise(view, mirror_map, cameras.face[:, None], cameras.rays[:, cameras.corners])
    above = rise >= 0.0
    whole = cameras.select(above.all(axis=1))
    cut = np.flatnonzero(above.any(axis=1) & ~above.all(axis=1))
    if not len(cut):
        return whole
    corners, above = cameras.corners[cut], above[cut]
    crossed = above != np.roll(above, -1, axis=1)
    row, side = np.nonzero(crossed)
    start = cameras.places[:, corners[row, side]]
    end = cameras.places[:, corners[row, (side + 1) % 3]]
    # the half that lies above, by bisection on the true map from the corner that is above
    upward = above[row, side]
    high, low = np.where(upward, start, end), np.where(upward, end, start)
    face = cameras.face[cut[row]]
    for _ in range(STEPS):
        middle = 0.5 * (high + low)
        rays = mirror_map.rays(face, mirror_map.coordinates(face, middle))
        good = _rise(view, mirror_map, face, rays) >= 0.0
        high, low = np.where(good, middle, high), np.where(good, low, middle)
    rays = mirror_map.rays(face, mirror_map.coordinates(face, high))
    six = np.concatenate((corners, np.full_like(corners, -1)), axis=1)
    six[row, 3 + side] = np.arange(len(row)) + cameras.places.shape[1]
    six_above = np.concatenate((above, np.zeros_like(above)), axis=1)
    parent, local = split(crossed)
    kept = six_above[parent[:, None], local].any(axis=1)
    parent, local = parent[kept], local[kept]
    return Cameras(np.concatenate((whole.corners, six[parent[:, None], local])),
                   np.concatenate((whole.face, cameras.face[cut[parent]])),
                   np.concatenate((cameras.places, high), axis=1), np.concatenate((cameras.rays, rays), axis=1))


def _rise(view: View, mirror_map: MirrorMap, face: np.ndarray, rays: np.ndarray) -> np.ndarray:
    """How steeply `rays` (3, ...) leave the flat `face` on the eye's side."""
    flat, corner = mirror_map.flat[:, face], mirror_map.a[:, face]
    if view.orthographic:
        towards = -dot(np.broadcast_to(view.forward.reshape((3,) + (1,) * (corner.ndim - 1)), corner.shape), flat)
    else:
        towards = -dot(corner - view.eye.reshape((3,) + (1,) * (corner.ndim - 1)), flat)
    return dot(rays, flat) * np.sign(towards)
