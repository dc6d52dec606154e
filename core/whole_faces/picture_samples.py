"""Grid of samples over the part of the picture that shows a patch."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..patches import Patch

MOST_SAMPLES = 1 << 23


@dataclass(frozen=True)
class Grid:
    """Samples over the part of the picture that shows the patch: its pixels, or fewer samples if these are too many.

    Attributes
    ----------
    low : (2,) float64, lower left corner, in pixels
    scale : float, samples per pixel
    size : (int, int), columns and rows of samples
    """

    low: np.ndarray
    scale: float
    size: tuple[int, int]

    @classmethod
    def over(cls, patch: Patch) -> Grid:
        resolution = np.array(patch.view.resolution, dtype=np.float64)
        low = np.clip(np.floor(patch.border.low), 0.0, resolution)
        high = np.clip(np.ceil(patch.border.high), 0.0, resolution)
        scale = min(1.0, float(np.sqrt(MOST_SAMPLES / max(np.prod(high - low), 1.0))))
        width, height = (max(int(side), 1) for side in np.ceil((high - low) * scale))
        return cls(low, scale, (width, height))

    def spots(self, pixels: np.ndarray) -> np.ndarray:
        """Convert `pixels` (2, f, 3) to samples of the grid."""
        return (pixels - self.low[:, None, None]) * self.scale


def least_around(front: np.ndarray) -> np.ndarray:
    """Return the minimum (height, width) of each pixel of `front` and its eight neighbours, with edges repeated."""
    front = np.pad(front, 1, mode="edge")
    rows_least = np.minimum(np.minimum(front[:-2], front[1:-1]), front[2:])
    return np.minimum(np.minimum(rows_least[:, :-2], rows_least[:, 1:-1]), rows_least[:, 2:])
