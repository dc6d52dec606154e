"""Samples of what the picture shows of a patch."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..patches import Patch

MOST_SAMPLES = 1 << 23


@dataclass(frozen=True)
class Grid:
    """Samples of what the picture shows of the patch: pixels, unless these are too many."""

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
        """Spots (2, f, 3) of the picture on the grid."""
        return (pixels - self.low[:, None, None]) * self.scale


def least_around(front: np.ndarray) -> np.ndarray:
    """The least value of each pixel (height, width) and the eight round it; of those outside, the nearest inside."""
    front = np.pad(front, 1, mode="edge")
    rows_least = np.minimum(np.minimum(front[:-2], front[1:-1]), front[2:])
    return np.minimum(np.minimum(rows_least[:, :-2], rows_least[:, 1:-1]), rows_least[:, 2:])
