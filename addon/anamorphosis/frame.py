"""The part of the camera's view that a picture fills."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core import View, draw

NOWHERE = -1.0      # beside every picture
SMALLEST = 1e-6     # pixels


@dataclass(frozen=True)
class Frame:
    """The part of the view that a picture fills: its lower left corner and its size in pixels."""

    low: np.ndarray
    size: np.ndarray

    @classmethod
    def of(cls, kind: str, view: View, pixels: np.ndarray, proportion: float = 1.0) -> Frame:
        """Return the frame for the parts that a mirror shows, at the pixel positions `pixels` (k, 3, 2) of pieces.

        Parameters
        ----------
        kind : str
            CAMERA: the whole view of the camera. MIRROR: the bounding box of what the mirror shows. WHOLE: the largest
            frame with the aspect `proportion` (width / height) that the mirror shows without a gap.
        """
        whole = np.array(view.resolution, dtype=np.float64)
        if kind == "CAMERA":
            return cls(np.zeros(2), whole)
        if kind == "WHOLE":
            return cls(*_largest_frame(_shown(view, pixels), proportion))
        shown = np.clip(pixels.reshape(-1, 2), 0.0, whole)
        low, high = shown.min(axis=0), shown.max(axis=0)
        return cls(low, np.maximum(high - low, SMALLEST))

    def uv(self, pixels: np.ndarray) -> np.ndarray:
        """Return positions in the picture, 0 to 1, from pixel positions. NaN becomes a position outside the picture."""
        return np.nan_to_num((pixels - self.low) / self.size, nan=NOWHERE).astype(np.float32)


def _shown(view: View, pixels: np.ndarray) -> np.ndarray:
    """Return True (height, width) for pixels of the view in which the mirror shows a piece."""
    width, height = view.resolution
    flat = View.looking_at((0.5 * width, 0.5 * height, 1.0), (0.5 * width, 0.5 * height, 0.0), view.resolution,
                           orthographic_scale=float(max(width, height)), up=(0.0, 1.0, 0.0))
    corners = np.concatenate((pixels.reshape(-1, 2), np.zeros((pixels.size // 2, 1))), axis=1)
    return draw(flat, corners, np.arange(len(corners)).reshape(-1, 3)).triangle.reshape(height, width) >= 0


def _largest_frame(shown: np.ndarray, proportion: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower left corner and the size of the largest box of pixels that are all shown. Of several boxes,
    return the one nearest to the middle of the shown pixels.
    """
    height, width = shown.shape
    total = np.zeros((height + 1, width + 1), dtype=np.int64)
    total[1:, 1:] = shown.cumsum(axis=0).cumsum(axis=1)

    def places(high: int) -> tuple[np.ndarray, int]:
        across = max(1, round(high * proportion))
        if high > height or across > width:
            return np.empty((0, 2), dtype=np.int64), across
        full = (total[high:, across:] - total[:-high, across:] - total[high:, :-across] + total[:-high, :-across])
        return np.argwhere(full == high * across), across
    fits, too_high = 0, height + 1
    while too_high - fits > 1:
        middle = (fits + too_high) // 2
        fits, too_high = (middle, too_high) if len(places(middle)[0]) else (fits, middle)
    if not fits:
        return np.zeros(2), np.array((width, height), dtype=np.float64)
    found, across = places(fits)
    off = found + 0.5 * np.array((fits, across)) - np.argwhere(shown).mean(axis=0)
    row, column = found[np.argmin((off**2).sum(axis=1))]
    return np.array((column, row), dtype=np.float64), np.array((across, fits), dtype=np.float64)
