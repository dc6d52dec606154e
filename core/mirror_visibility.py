"""What of the mirror its own body hides from the eye: found on a coarse grid of view rays.

Nothing is called hidden that might peek out between the samples: a camera is dropped only where it and all cameras
round it have samples and every one lies behind another part of the mirror, and a place only where the four samples
round it do.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .cameras import Cameras
from .mirror_map import MirrorMap
from .camera_splitting import split_cameras
from .vectors import ranges
from .view import View

SAMPLES = 256  # across the wider side of the picture
LEVELS = 4
LONG_EDGE = 32.0  # pixels: a shorter edge of a partly hidden camera is not worth a split
CELLS = 2.0  # of the grid: the largest face that its hidden corners can speak for
SURFACE = 2e-4  # relative difference of depth up to which two samples lie on one surface


@dataclass(frozen=True)
class DepthGrid:
    """Nearness of the mirror on a coarse grid: 1 / depth, or for an orthographic view -depth; larger is nearer.

    Attributes
    ----------
    view : View
    nearest : (height, width) float64, -inf where a sample sees no mirror
    scale : float, samples per pixel
    room : float, share of the nearness, or for an orthographic view depth, by which two samples of one surface differ
    """

    view: View
    nearest: np.ndarray
    scale: float
    room: float

    @classmethod
    def of(cls, view: View, cameras: Cameras) -> tuple[DepthGrid, np.ndarray, np.ndarray]:
        """The grid of cameras (n,); which of them have samples that are seen, and which have hidden samples."""
        scale = SAMPLES / max(view.resolution)
        width, height = (int(side) for side in np.ceil(np.array(view.resolution) * scale))
        depth = view.depths(cameras.places.T)
        room = SURFACE * max(float(np.ptp(depth)), 1e-300) if view.orthographic else SURFACE
        grid = cls(view, np.full((height, width), -np.inf), scale, room)
        camera, x, y, weights = grid._samples(view.pixels(cameras.places.T)[cameras.corners] * scale,
                                              (depth[cameras.corners] > 0.0).all(axis=1))
        depth = depth[cameras.corners[camera]].T
        nearness = -(weights * depth).sum(axis=0) if view.orthographic else (weights / depth).sum(axis=0)
        np.maximum.at(grid.nearest, (y, x), nearness)
        states, seen = [], nearness + grid._margin(nearness) >= grid.nearest[y, x]
        for state in (seen, ~seen):
            found = np.zeros(len(cameras), dtype=bool)
            found[camera[state]] = True
            states.append(found)
        return grid, *states

    @property
    def mirror_pixels(self) -> int:
        """About how many pixels see the mirror."""
        return round(float(np.isfinite(self.nearest).sum()) / self.scale**2)

    def hides(self, places: np.ndarray) -> np.ndarray:
        """Which places (3, n) on the mirror lie in the picture and behind nearer parts of it, at all four samples
        round them."""
        depth = self.view.depths(places.T)
        with np.errstate(divide="ignore"):
            nearness = -depth if self.view.orthographic else 1.0 / depth
        limit = nearness + self._margin(nearness)
        height, width = self.nearest.shape
        pixels = np.nan_to_num(self.view.pixels(places.T))
        corner = np.floor(pixels * self.scale - 0.5).astype(np.int64)
        hidden = (depth > 0.0) & (pixels >= 0.0).all(axis=1) & (pixels <= self.view.resolution).all(axis=1)
        for step_x, step_y in ((0, 0), (0, 1), (1, 0), (1, 1)):
            x, y = np.clip(corner[:, 0] + step_x, 0, width - 1), np.clip(corner[:, 1] + step_y, 0, height - 1)
            hidden &= self.nearest[y, x] > limit
        return hidden

    def hides_faces(self, places: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """Which small faces (m, 3) between `places` (3, n) have only hidden corners; between the corners of large ones
        anything might be seen."""
        pixels = self.view.pixels(places.T)[faces]
        small = (np.abs(pixels - np.roll(pixels, -1, axis=1)) * self.scale <= CELLS).all(axis=(1, 2))
        return small & self.hides(places)[faces].all(axis=1)

    def _margin(self, nearness: np.ndarray):
        return self.room if self.view.orthographic else self.room * nearness

    def _samples(self, corners: np.ndarray, before: np.ndarray):
        """Camera, column, row and barycentric coordinates of the samples inside triangles (n, 3, 2)."""
        size = self.nearest.shape[::-1]
        corners = np.nan_to_num(corners)
        low = np.clip(np.ceil(corners.min(axis=1) - 0.5), 0, size).astype(np.int64)
        high = np.clip(np.floor(corners.max(axis=1) - 0.5) + 1, 0, size).astype(np.int64)
        extent = np.where(before[:, None], np.maximum(high - low, 0), 0)
        y, row = ranges(low[:, 1], extent[:, 1])
        x, run = ranges(low[row, 0], extent[row, 0])
        camera, y = row[run], y[run]
        dx, dy = corners[camera, :, 0] - x[:, None] - 0.5, corners[camera, :, 1] - y[:, None] - 0.5
        area = np.stack([dx[:, i] * dy[:, j] - dx[:, j] * dy[:, i] for i, j in ((1, 2), (2, 0), (0, 1))])
        total = area.sum(axis=0)
        weights = area / np.where(total != 0.0, total, -np.inf)
        inside = (weights >= 0.0).all(axis=0) & (total != 0.0)
        return camera[inside], x[inside], y[inside], weights[:, inside]


def without_hidden(view: View, mirror_map: MirrorMap, cameras: Cameras) -> tuple[Cameras, DepthGrid]:
    """The cameras that the eye may see; large ones hidden in part are split, and their hidden parts dropped."""
    for level in range(LEVELS + 1):
        grid, seen, hidden = DepthGrid.of(view, cameras)
        pixels = view.pixels(cameras.places.T)[cameras.corners]
        long = np.linalg.norm(pixels - np.roll(pixels, -1, axis=1), axis=2) > LONG_EDGE
        marked = (seen & hidden)[:, None] & long
        if level == LEVELS or not marked.any():
            break
        cameras, *_ = split_cameras(view, mirror_map, cameras, marked)
    keep = seen | ~hidden
    corner_seen = np.zeros(cameras.places.shape[1], dtype=bool)
    corner_seen[cameras.corners[keep]] = True
    return cameras.select(corner_seen[cameras.corners].any(axis=1)), grid
