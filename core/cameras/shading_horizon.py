"""The horizon of a smooth mirror: where its interpolated normals would send rays under the flat faces they leave.

Beyond it the true map lifts the rays until they clear the surface, and bends sharply where it begins to. Cameras are
cut along that line, so that none has the bend inside. What lies beyond is a sliver at the silhouette of a fine mirror,
and may be a third of a coarse one, as of a cube with smooth normals.
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
LEVELS = 20  # of splits before the cut, for cameras across which the horizon bulges
LONG_EDGE = 8.0  # pixels: in a smaller camera a bulge does not matter
SLIVER = 2.0  # pixels: a narrower camera of lifted rays alone is not worth refining
ON_LINE = 1e-6  # rise of rays on the horizon itself, which belong to both its sides
_PROBES = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [1 / 3] * 3]).T


def beyond_horizon(cameras: Cameras) -> np.ndarray:
    """Which cameras (n,) lie beyond the horizon whole, of lifted rays alone, and are not worth refining: slivers in
    the picture, and all in a lamp's, whose light is made fine enough where it falls."""
    beyond = np.all(_lifted_probes(cameras, ON_LINE), axis=0)
    if not isinstance(cameras.view, LampView):
        asked = np.flatnonzero(beyond)
        with np.errstate(invalid="ignore", over="ignore"):
            pixels = cameras.view.pixels(cameras.places[:, cameras.corners[asked].ravel()].T).reshape(-1, 3, 2)
            beyond[asked] = np.abs(doubled_areas(pixels)) < SLIVER * edge_lengths(pixels).max(axis=1)
    return beyond


def _lifted_probes(cameras: Cameras, slack: float) -> np.ndarray:
    """(8, n): whether the rays at the corners, the edges' middles and the middle of the cameras are lifted, and where
    an eye close above a large mirror looks down on it."""
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
    """The places (3, n) of triangles with `corners` (3, n, 3), as [component, triangle, corner], that are nearest to
    the eye."""
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
    """The cameras, those across the horizon cut along it; large ones over whose side it bulges are split first."""
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
    """Cameras with corners on both sides of the horizon in up to three parts."""
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
