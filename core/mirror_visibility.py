"""Which cameras the mirror's own body hides from the eye: found on a coarse grid of view rays.

A camera is dropped only where it and all cameras round it have samples on the grid and every one lies behind another
part of the mirror: what peeks out between samples then still has a neighbour that is seen.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .mirror_map import MirrorMap
from .mirror_refinement import split_cameras
from .vectors import ranges
from .view import View

SAMPLES = 256  # across the wider side of the picture
LEVELS = 4
LONG_EDGE = 32.0  # pixels: a shorter edge of a partly hidden camera is not worth a split
SURFACE = 1e-4  # relative difference of depth up to which two samples lie on one surface


def without_hidden(view: View, mirror_map: MirrorMap, cameras: Cameras) -> Cameras:
    """The cameras that the eye may see; large ones that are hidden in part are split, and their hidden parts dropped."""
    for level in range(LEVELS + 1):
        seen, hidden = _seen_and_hidden(view, cameras)
        pixels = view.pixels(cameras.places.T)[cameras.corners]
        long = np.linalg.norm(pixels - np.roll(pixels, -1, axis=1), axis=2) > LONG_EDGE
        marked = (seen & hidden)[:, None] & long
        if level == LEVELS or not marked.any():
            break
        cameras, _ = split_cameras(view, mirror_map, cameras, marked)
    keep = seen | ~hidden
    corner_seen = np.zeros(cameras.places.shape[1], dtype=bool)
    corner_seen[cameras.corners[keep]] = True
    return cameras.select(corner_seen[cameras.corners].any(axis=1))


def _seen_and_hidden(view: View, cameras: Cameras) -> tuple[np.ndarray, np.ndarray]:
    """Which of the cameras (n,) have samples that are seen, and which have samples behind other cameras."""
    depth = view.depths(cameras.places.T)[cameras.corners]
    before = (depth > 0.0).all(axis=1)
    pixels = view.pixels(cameras.places.T)[cameras.corners] * (SAMPLES / max(view.resolution))
    size = np.ceil(np.array(view.resolution) * (SAMPLES / max(view.resolution))).astype(np.int64)
    with np.errstate(invalid="ignore"):
        low = np.clip(np.ceil(np.nan_to_num(pixels.min(axis=1)) - 0.5), 0, size).astype(np.int64)
        high = np.clip(np.floor(np.nan_to_num(pixels.max(axis=1)) - 0.5) + 1, 0, size).astype(np.int64)
    extent = np.where(before[:, None], np.maximum(high - low, 0), 0)
    step, row = ranges(np.zeros(len(cameras), dtype=np.int64), extent[:, 1])
    y = low[row, 1] + step
    step, run = ranges(np.zeros(len(row), dtype=np.int64), extent[row, 0])
    camera, y = row[run], y[run]
    x = low[camera, 0] + step
    weights = _weights(pixels[camera], x + 0.5, y + 0.5)
    inside = (weights >= 0.0).all(axis=0)
    camera, sample, weights = camera[inside], (y * size[0] + x)[inside], weights[:, inside]
    if view.orthographic:
        nearness = -(weights * depth[camera].T).sum(axis=0)
        room = SURFACE * max(float(np.ptp(depth)), 1e-300)
    else:
        nearness = (weights / depth[camera].T).sum(axis=0)
        room = SURFACE * nearness
    nearest = np.full(int(size[0] * size[1]), -np.inf)
    np.maximum.at(nearest, sample, nearness)
    seen = nearness + room >= nearest[sample]
    states = []
    for state in (seen, ~seen):
        found = np.zeros(len(cameras), dtype=bool)
        found[camera[state]] = True
        states.append(found)
    return tuple(states)


def _weights(corners: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (3, n) of places in the picture in triangles (n, 3, 2); negative for edge-on ones."""
    dx, dy = corners[:, :, 0] - x[:, None], corners[:, :, 1] - y[:, None]
    area = [dx[:, i] * dy[:, j] - dx[:, j] * dy[:, i] for i, j in ((1, 2), (2, 0), (0, 1))]
    total = area[0] + area[1] + area[2]
    return np.stack(area) / np.where(total != 0.0, total, -np.inf)
