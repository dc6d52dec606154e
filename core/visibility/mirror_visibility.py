"""Cameras that the mirror's own body hides whole from the eye: found on a coarse grid of view rays.

Nothing is called hidden that might peek out between the samples: a camera is dropped only where it and all cameras
round it have samples and every one lies behind another part of the mirror; one that falls between the samples, where
its corners lie behind nearer parts at all samples round them. What is left is for `self_occlusion`.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import ranges, shares
from ..support import breathe
from ..views import View

SAMPLES = 256  # across the wider side of the picture
SAMPLES_AT_ONCE = 1 << 19
MOST_SAMPLES, LEAST_SAMPLES = 1 << 24, 32  # on all cameras, else the grid is made coarser; across the picture
SURFACE = 2e-4  # relative difference of depth up to which two samples lie on one surface


@dataclass(frozen=True)
class DepthGrid:
    """Nearness of the mirror on a coarse grid: 1 / depth, or for an orthographic view -depth; larger is nearer.

    Attributes
    ----------
    view : View
    nearest : (height, width) float64, -inf where a sample sees no mirror
    layers : (height, width) int64, cameras at each sample, hidden ones too
    scale : float, samples per pixel
    room : float, share of the nearness, or for an orthographic view depth, by which two samples of one surface differ
    """

    view: View
    nearest: np.ndarray
    layers: np.ndarray
    scale: float
    room: float

    @classmethod
    def of(cls, cameras: Cameras) -> tuple[DepthGrid, np.ndarray]:
        """The grid of cameras (n,), and which of them the eye may see."""
        view = cameras.view
        depth = view.depths(cameras.places.T)
        depths, pixels = depth[cameras.corners], view.pixels(cameras.places.T)[cameras.corners]
        scale = SAMPLES / max(view.resolution)
        while True:
            width, height = (int(side) for side in np.ceil(np.array(view.resolution) * scale))
            runs = _runs(pixels * scale, (depths > 0.0).all(axis=1), (width, height))
            if runs[2].sum() <= MOST_SAMPLES or max(width, height) <= LEAST_SAMPLES:
                break
            scale *= 0.5
        room = SURFACE * max(float(np.ptp(depth)), 1e-300) if view.orthographic else SURFACE
        grid = cls(view, np.full((height, width), -np.inf), np.zeros((height, width), dtype=np.int64), scale, room)
        pixels = pixels * scale
        parts = list(shares(runs[2], SAMPLES_AT_ONCE))
        shows, hides = np.zeros(len(cameras), dtype=bool), np.zeros(len(cameras), dtype=bool)
        kept = None
        for marking in (True, False):
            for part in parts:
                breathe()
                # one share, as nearly always, is worked out once; of more only one is held at a time
                camera, x, y, nearness = kept if kept and len(parts) == 1 else grid._samples(pixels, depths, runs, part)
                kept = camera, x, y, nearness
                if marking:
                    np.maximum.at(grid.nearest, (y, x), nearness)
                    np.add.at(grid.layers, (y, x), 1)
                else:
                    seen = nearness + grid._margin(nearness) >= grid.nearest[y, x]
                    shows[camera[seen]], hides[camera[~seen]] = True, True
        hides = grid.hides(cameras.places, cameras.corners).all(axis=1) & (hides | ~shows)
        corner_seen = np.zeros(cameras.places.shape[1], dtype=bool)
        corner_seen[cameras.corners[shows | ~hides]] = True
        return grid, corner_seen[cameras.corners].any(axis=1)

    @property
    def mirror_pixels(self) -> int:
        """About how many pixels see the mirror."""
        return round(float(np.isfinite(self.nearest).sum()) / self.scale**2)

    def hides(self, places: np.ndarray, faces: np.ndarray) -> np.ndarray:
        """Which corners (m, 3) of faces between `places` (3, n) on the mirror lie in the picture and behind nearer
        parts of it: at all four samples round them the face's own plane does."""
        depth = self.view.depths(places.T)
        with np.errstate(divide="ignore"):
            nearness = (-depth if self.view.orthographic else 1.0 / depth)[faces]
        height, width = self.nearest.shape
        pixels = np.nan_to_num(self.view.pixels(places.T))
        inside = (depth > 0.0) & (pixels >= 0.0).all(axis=1) & (pixels <= self.view.resolution).all(axis=1)
        hidden, pixels = inside[faces], pixels[faces]
        # nearness is affine over a face's plane: an oblique face must not be hidden by its own nearer parts
        (ax, ay), (bx, by) = (np.moveaxis(pixels[:, k] - pixels[:, 0], 1, 0) for k in (1, 2))
        a, b = nearness[:, 1] - nearness[:, 0], nearness[:, 2] - nearness[:, 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            slope = np.stack((a * by - b * ay, b * ax - a * bx), axis=1) / (ax * by - bx * ay)[:, None]
        corner = np.floor(np.clip(pixels, -1.0, np.add(self.view.resolution, 1.0)) * self.scale - 0.5).astype(np.int64)
        for step in ((0, 0), (0, 1), (1, 0), (1, 1)):
            sample = corner + step
            away = (sample + 0.5) / self.scale - pixels
            with np.errstate(invalid="ignore"):
                own = nearness + (slope[:, None] * away).sum(axis=2)
                x, y = np.clip(sample[..., 0], 0, width - 1), np.clip(sample[..., 1], 0, height - 1)
                hidden &= self.nearest[y, x] > own + self._margin(np.abs(own))
        return hidden

    def _margin(self, nearness: np.ndarray):
        return self.room if self.view.orthographic else self.room * nearness

    def _samples(self, corners: np.ndarray, depths: np.ndarray, runs, part: slice):
        """Camera, column, row and nearness of the samples inside triangles (n, 3, 2) with `depths` (n, 3) at their
        corners, those of a `part` of the runs."""
        camera, y, length = (run[part] for run in runs)
        corners = np.nan_to_num(corners)
        start = np.clip(np.ceil(corners[camera, :, 0].min(axis=1) - 0.5), 0, self.nearest.shape[1]).astype(np.int64)
        x, run = ranges(start, length)
        camera, y = camera[run], y[run]
        dx, dy = corners[camera, :, 0] - x[:, None] - 0.5, corners[camera, :, 1] - y[:, None] - 0.5
        area = np.stack([dx[:, i] * dy[:, j] - dx[:, j] * dy[:, i] for i, j in ((1, 2), (2, 0), (0, 1))])
        total = area.sum(axis=0)
        weights = area / np.where(total != 0.0, total, -np.inf)
        inside = (weights >= 0.0).all(axis=0) & (total != 0.0)
        camera, weights = camera[inside], weights[:, inside]
        depth = depths[camera].T
        nearness = -(weights * depth).sum(axis=0) if self.view.orthographic else (weights / depth).sum(axis=0)
        return camera, x[inside], y[inside], nearness


def _runs(corners: np.ndarray, before: np.ndarray, size: tuple[int, int]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Runs of samples over the boxes of triangles (n, 3, 2): the triangle, the row, and how many."""
    corners = np.nan_to_num(corners)
    low = np.clip(np.ceil(corners.min(axis=1) - 0.5), 0, size).astype(np.int64)
    high = np.clip(np.floor(corners.max(axis=1) - 0.5) + 1, 0, size).astype(np.int64)
    extent = np.where(before[:, None], np.maximum(high - low, 0), 0)
    y, camera = ranges(low[:, 1], extent[:, 1])
    return camera, y, extent[camera, 0]


def without_hidden(cameras: Cameras) -> tuple[Cameras, DepthGrid]:
    """The cameras that the eye may see, and the grid."""
    grid, kept = DepthGrid.of(cameras)
    return cameras.select(kept), grid
