"""The horizon of a smooth mirror: where its interpolated normals would send rays under the flat faces they leave.

Beyond it the true map lifts the rays until they clear the surface, and bends sharply where it begins to. Cameras are
cut along that line, so that none has the bend inside; what lies beyond is a sliver at the silhouette.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .mirror_map import MirrorMap
from .subdivision import split

STEPS = 30


def cut_at_horizon(mirror_map: MirrorMap, cameras: Cameras) -> Cameras:
    """The cameras, each still on its whole mirror triangle, those across the horizon in up to three parts."""
    near = np.flatnonzero(mirror_map.grazing[cameras.face])
    corner_places = cameras.places[:, cameras.corners[near]].reshape(3, -1)
    face = np.repeat(cameras.face[near], 3)
    beyond = mirror_map.lifted(face, mirror_map.coordinates(face, corner_places)).reshape(-1, 3)
    crossed = beyond != np.roll(beyond, -1, axis=1)
    row, side = np.nonzero(crossed)
    if not len(row):
        return cameras
    corners, face = cameras.corners[near], cameras.face[near[row]]
    start, end = cameras.places[:, corners[row, side]], cameras.places[:, corners[row, (side + 1) % 3]]
    low, high = np.where(beyond[row, side], end, start), np.where(beyond[row, side], start, end)
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        lifted = mirror_map.lifted(face, mirror_map.coordinates(face, middle))
        low, high = np.where(lifted, low, middle), np.where(lifted, middle, high)
    rays = mirror_map.rays(face, mirror_map.coordinates(face, low))
    six = np.concatenate((corners, np.full_like(corners, -1)), axis=1)
    six[row, 3 + side] = np.arange(len(row)) + cameras.places.shape[1]
    parent, local = split(crossed)
    whole = np.ones(len(cameras), dtype=bool)
    whole[near] = False
    return Cameras(np.concatenate((cameras.corners[whole], six[parent[:, None], local])),
                   np.concatenate((cameras.face[whole], cameras.face[near[parent]])),
                   np.concatenate((cameras.places, low), axis=1), np.concatenate((cameras.rays, rays), axis=1))
