"""A lattice of sample points in the picture, one per pixel or per few pixels."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..support import Settings
from ..views import View, draw

ASIDE = np.array([0.005, 0.003])  # pixels: offset of vertices from pixel centres, which engines sample; above rounding
LARGEST_STEP = 4.0  # pixels


def lattice_step(settings: Settings) -> float:
    """Return the distance of samples in pixels: one, or about the tolerance if that is more."""
    return float(np.clip(np.floor(0.75 * settings.tolerance), 1.0, LARGEST_STEP))


@dataclass(frozen=True)
class Lattice:
    """Points of a picture in rows from below, numbered along the rows.

    Attributes
    ----------
    view : View
    low : (2,) float64, the first point, in pixels
    step : float, from one point to the next, in pixels
    size : (columns, rows)
    """

    view: View
    low: np.ndarray
    step: float
    size: tuple[int, int]

    @classmethod
    def around(cls, view: View, positions: np.ndarray, step: float) -> Lattice:
        """Return the lattice around the picture of `positions` (n, 3), with a margin of one step.

        Its points are pixel centres, or every few of them. The margin may lie outside of the view's picture.
        """
        resolution = np.array(view.resolution, dtype=np.float64)
        low, high = np.zeros(2), resolution
        if (view.depths(positions) > 0.0).all():
            pixels = np.clip(view.pixels(positions), 0.0, resolution)
            low, high = pixels.min(axis=0), pixels.max(axis=0)
        first = np.floor((low - 0.5) / step) - 1.0
        count = np.ceil((high - 0.5) / step) + 1.0 - first + 1.0
        return cls(view, 0.5 + first * step, step, (int(count[0]), int(count[1])))

    def coarser(self, most: int) -> Lattice:
        """Return this lattice, or a coarser one over the same part of the picture with about `most` points."""
        times = np.ceil(np.sqrt(self.size[0] * self.size[1] / most))
        if times <= 1.0:
            return self
        count = [int(np.ceil(side / times)) for side in self.size]
        return Lattice(self.view, self.low, self.step * times, (count[0], count[1]))

    def spots(self, number: np.ndarray) -> np.ndarray:
        """Return the positions (n, 2) of points `number` (n,) in pixels."""
        row, column = np.divmod(number, self.size[0])
        return self.low + self.step * np.stack((column, row), axis=1)

    def drawn(self, positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the nearest triangle (n,) at each point, -1 for none, and barycentric coordinates (3, n) on it."""
        size, own = np.array(self.size), np.array(self.view.resolution)
        scale = own / (self.step * size)
        # project such that lattice point k is the centre of pixel k
        shift = scale - 2.0 * self.low / (self.step * size) + 1.0 / size - 1.0
        projection = self.view.projection.copy()
        projection[:2] = scale[:, None] * projection[:2] + shift[:, None] * projection[3]
        found = draw(View(self.view.camera_to_world, projection, self.size), positions, triangles)
        return found.triangle, found.weights
