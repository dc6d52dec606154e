"""Cameras that the mirror's own body hides whole from the eye: found on a coarse grid of view rays.

Nothing is called hidden that might peek out between the samples: a camera is dropped only where it and all cameras
round it have samples and every one lies behind another part of the mirror; one that falls between the samples, where
its corners lie behind nearer parts at all samples round them. What is left is for `self_occlusion`.
"""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import largest, mask, rows, shares, smallest
from ..views import Covered, box, planes

SAMPLES = 256  # across the wider side of the picture
SAMPLES_AT_ONCE = 1 << 19
MOST_SAMPLES, LEAST_SAMPLES = 1 << 24, 32  # on all cameras, else the grid is made coarser; across the picture
SURFACE = 2e-4  # relative difference of depth up to which two samples lie on one surface


@dataclass(frozen=True)
class DepthGrid:
    """Nearness of the mirror on a coarse grid: 1 / depth, or for an orthographic view -depth; larger is nearer.

    Attributes
    ----------
    nearest : (height, width) float64, -inf where a sample sees no mirror
    layers : (height, width) int64, cameras at each sample, hidden ones too
    scale : float, samples per pixel
    room : float, difference of nearness, or share of it if `relative`, up to which two samples lie on one surface
    relative : bool, False for orthographic views
    """

    nearest: np.ndarray
    layers: np.ndarray
    scale: float
    room: float
    relative: bool

    @classmethod
    def of(cls, cameras: Cameras) -> tuple[DepthGrid, np.ndarray]:
        """Sample cameras (n) on a grid; return the grid, and True (n,) for cameras that the eye may see."""
        view = cameras.view
        depth, corners = view.depths(cameras.places.T), cameras.corners.T
        spots = np.nan_to_num(rows(view.pixels(cameras.places.T)))
        inside = (depth > 0.0) & (spots >= 0.0).all(axis=0) & (spots <= np.array(view.resolution)[:, None]).all(axis=0)
        with np.errstate(divide="ignore"):
            order = (-depth if view.orthographic else 1.0 / depth)[corners]
        spots, before = spots[:, corners], np.flatnonzero((depth[corners] > 0.0).all(axis=0))
        scale = SAMPLES / max(view.resolution)
        while True:
            width, height = (int(side) for side in np.ceil(np.array(view.resolution) * scale))
            size = np.array([[width], [height]])
            low, high = (np.floor(np.clip(end * scale, 0, size) + 0.5) for end in box(spots[:, :, before]))
            count = np.prod(high - low, axis=0).astype(np.int64)
            if count.sum() <= MOST_SAMPLES or max(width, height) <= LEAST_SAMPLES:
                break
            scale *= 0.5
        room = SURFACE * max(float(np.ptp(depth)), 1e-300) if view.orthographic else SURFACE
        grid = cls(np.full((height, width), -np.inf), np.zeros((height, width), dtype=np.int64), scale, room,
                   not view.orthographic)
        spots *= scale
        parts = [before[part] for part in shares(count, SAMPLES_AT_ONCE)]
        shows, hides = np.zeros(len(cameras), dtype=bool), np.zeros(len(cameras), dtype=bool)
        # keep the samples of a single share, the usual case; of several shares hold only one at a time
        kept = list(grid._samples(spots, order, parts)) if len(parts) == 1 else None
        for _, pixel, nearness in kept or grid._samples(spots, order, parts):
            np.maximum.at(grid.nearest.ravel(), pixel, nearness)
            np.add.at(grid.layers.ravel(), pixel, 1)
        for camera, pixel, nearness in kept or grid._samples(spots, order, parts):
            seen = nearness + grid._margin(nearness) >= grid.nearest.ravel()[pixel]
            shows[camera[seen]], hides[camera[~seen]] = True, True
        hides = (inside[corners] & grid._hides(spots, order)).all(axis=0) & (hides | ~shows)
        corner_seen = mask(cameras.places.shape[1], cameras.corners[shows | ~hides])
        return grid, corner_seen[cameras.corners].any(axis=1)

    @property
    def mirror_pixels(self) -> int:
        """Approximate number of pixels that see the mirror."""
        return round(float(np.isfinite(self.nearest).sum()) / self.scale**2)

    def _samples(self, spots: np.ndarray, order: np.ndarray,
                 parts: list[np.ndarray]) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """Rasterise triangles on the grid; yield triangle, sample and nearness of all covered samples, part by part.

        Parameters
        ----------
        spots : (2, 3, n) float64, corners of the triangles, in samples
        order : (3, n) float64, nearness of the corners
        parts : list of int64 arrays, triangles to rasterise at a time
        """
        height, width = self.nearest.shape
        for part in parts:
            own = order[:, part]
            covered = Covered.of(spots[:, :, part], own, (width, height), False)
            # clamp the nearness: in a sliver the plane may be arbitrarily steep
            nearness = np.clip(covered.order, smallest(own)[covered.face], largest(own)[covered.face])
            yield part[covered.face], covered.pixel, nearness

    @np.errstate(over="ignore", invalid="ignore")
    def _hides(self, spots: np.ndarray, order: np.ndarray) -> np.ndarray:
        """Return True for corners (3, n) of triangles that lie behind nearer parts of the mirror.

        A corner does if the triangle's own plane lies behind the nearest surface at all four samples around it.
        `spots` (2, 3, n) are the corners, in samples, `order` (3, n) their nearness.
        """
        # compare with the triangle's plane, so that an oblique triangle is not hidden by its own nearer parts
        slope, base = planes(spots, order)
        height, width = self.nearest.shape
        hidden, (column, row) = np.ones(order.shape, dtype=bool), np.floor(spots - 0.5)
        for right, up in ((0, 0), (1, 0), (0, 1), (1, 1)):
            x, y = np.clip(column + right, 0, width - 1), np.clip(row + up, 0, height - 1)
            own = slope[0] * (column + right + 0.5) + slope[1] * (row + up + 0.5) + base
            hidden &= self.nearest[y.astype(np.int64), x.astype(np.int64)] > own + self._margin(np.abs(own))
        return hidden

    def _margin(self, nearness: np.ndarray) -> np.ndarray | float:
        return self.room * nearness if self.relative else self.room


def without_hidden(cameras: Cameras) -> tuple[Cameras, DepthGrid]:
    """Return the cameras that the eye may see, and the grid that tells it."""
    grid, kept = DepthGrid.of(cameras)
    return cameras.select(kept), grid
