"""The shading horizon of a smooth mirror: the line where interpolated normals start to send rays into flat faces.

Beyond it the true map lifts the rays until they clear the surface, and it has a kink along the line. Cameras are cut
along that line, so that none has the kink inside. The region beyond is a sliver at the silhouette of a fine mirror. It
may be a third of a coarse mirror, such as a cube with smooth normals.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, doubled_areas, edge_lengths, following, mask, next_corner, split
from ..support import portions
from ..views import LampView
from .camera_splitting import split_cameras
from .three_ray_cameras import Cameras

STEPS = 30
CAMERAS_AT_ONCE = 4096
LEVELS = 20  # levels of splitting before the cut, for cameras with a curved horizon inside
LONG_EDGE = 8.0  # pixels: on shorter edges a curved horizon does not matter
SLIVER = 2.0  # pixels: a narrower camera of lifted rays alone is not worth refining
ON_LINE = 1e-6  # sine: tolerance for rays on the horizon itself, which belong to both sides
_PROBES = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [1 / 3] * 3]).T


def beyond_horizon(cameras: Cameras) -> np.ndarray:
    """Return True (n,) for cameras that lie completely beyond the horizon and are not worth refining.

    All their rays are lifted. In a lamp's view all such cameras count, because caustics are refined on the receivers.
    In other views only slivers count.
    """
    beyond = np.all(_lifted_probes(cameras, ON_LINE), axis=0)
    if not isinstance(cameras.view, LampView):
        asked = np.flatnonzero(beyond)
        with np.errstate(invalid="ignore", over="ignore"):
            pixels = cameras.view.pixels(cameras.places[:, cameras.corners[asked].ravel()].T).reshape(-1, 3, 2)
            beyond[asked] = np.abs(doubled_areas(pixels)) < SLIVER * edge_lengths(pixels).max(axis=1)
    return beyond


def _lifted_probes(cameras: Cameras, slack: float) -> np.ndarray:
    """Return True (8, n) for lifted rays at eight places of each camera.

    The places are the three corners, the three edge midpoints, the centroid, and the place nearest to the eye. The last
    one matters for an eye close above a large mirror.
    """
    mirror_map = cameras.mirror_map
    found = np.zeros((_PROBES.shape[1] + 1, len(cameras)), dtype=bool)
    grazing = np.flatnonzero(mirror_map.grazing[cameras.face])
    for part in portions(len(grazing), CAMERAS_AT_ONCE):
        near = grazing[part]
        corners = cameras.places[:, cameras.corners[near]]
        below = _nearest(corners, cameras.view.eye)[:, None]
        places = np.concatenate((np.einsum("xnk,kp->xpn", corners, _PROBES), below), axis=1).reshape(3, -1)
        face = np.tile(cameras.face[near], len(found))
        lifted = mirror_map.lifted(face, mirror_map.coordinates(face, places), slack)
        found[:, near] = lifted.reshape(len(found), -1)
    return found


def _nearest(corners: np.ndarray, eye: np.ndarray) -> np.ndarray:
    """Return the places (3, n) nearest to the `eye` on triangles with `corners` (3, n, 3), as [component, triangle,
    corner].
    """
    away = corners - eye[:, None, None]
    sides = following(corners, axis=2) - corners
    share = np.clip(-dot(away, sides) / np.maximum(dot(sides, sides), 1e-300), 0.0, 1.0)
    on_sides = away + share * sides
    distance = dot(on_sides, on_sides)
    side = np.argmin(distance, axis=1)
    normal = np.cross(sides[:, :, 0], sides[:, :, 1], axis=0)
    below = dot(away[:, :, 0], normal) / np.maximum(dot(normal, normal), 1e-300) * normal
    inside = np.all(dot(np.cross(sides, below[:, :, None] - away, axis=0), normal[:, :, None]) > 0.0, axis=1)
    nearest = np.where(inside, below, np.take_along_axis(on_sides, side[None, :, None], axis=2)[:, :, 0])
    return nearest + eye[:, None]


def cut_at_horizon(cameras: Cameras) -> Cameras:
    """Cut cameras along the horizon; split large ones first if the horizon crosses an edge twice."""
    view = cameras.view
    for _ in range(LEVELS):
        probes = _lifted_probes(cameras, 0.0)
        pixels = view.pixels(cameras.places.T)[cameras.corners]
        long = edge_lengths(pixels) > LONG_EDGE
        whole = (probes[:3] == probes[0]).all(axis=0)
        bulging = (whole & (probes[3:] != probes[0]).any(axis=0))[:, None] & long
        if not bulging.any():
            break
        cameras, *_ = split_cameras(cameras, bulging)
    return _cut(cameras)


def _cut(cameras: Cameras) -> Cameras:
    """Cut cameras with corners on both sides of the horizon into up to three parts."""
    mirror_map = cameras.mirror_map
    near = np.flatnonzero(mirror_map.grazing[cameras.face])
    corner_places = cameras.places[:, cameras.corners[near]].reshape(3, -1)
    face = np.repeat(cameras.face[near], 3)
    beyond = mirror_map.lifted(face, mirror_map.coordinates(face, corner_places)).reshape(-1, 3)
    crossed = beyond != following(beyond)
    row, side = np.nonzero(crossed)
    if not len(row):
        return cameras
    corners, face = cameras.corners[near], cameras.face[near[row]]
    start, end = cameras.places[:, corners[row, side]], cameras.places[:, corners[row, next_corner(side)]]
    low, high = np.where(beyond[row, side], end, start), np.where(beyond[row, side], start, end)
    for _ in range(STEPS):
        middle = 0.5 * (low + high)
        lifted = mirror_map.lifted(face, mirror_map.coordinates(face, middle))
        low, high = np.where(lifted, low, middle), np.where(lifted, middle, high)
    leaving = mirror_map.leave(face, mirror_map.coordinates(face, low))
    six = np.concatenate((corners, np.full_like(corners, -1)), axis=1)
    six[row, 3 + side] = np.arange(len(row)) + cameras.places.shape[1]
    parent, local = split(crossed)
    whole = ~mask(len(cameras), near)
    return cameras.replaced(np.concatenate((cameras.corners[whole], six[parent[:, None], local])),
                            np.concatenate((cameras.face[whole], cameras.face[near[parent]])), low, *leaving)
