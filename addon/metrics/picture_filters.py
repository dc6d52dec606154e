"""Separable filters on pictures, in NumPy alone."""
from __future__ import annotations

import numpy as np

from ...core import breathe


def gaussian(sigma: float, radius: int) -> np.ndarray:
    """Samples of exp(-x^2 / (2 sigma^2)) at -radius .. radius, not normalised."""
    offsets = np.arange(-radius, radius + 1, dtype=np.float64)
    return np.exp(-offsets ** 2 / (2.0 * sigma ** 2))


def filtered(picture: np.ndarray, down: np.ndarray, across: np.ndarray, border: str) -> np.ndarray:
    """Correlate a picture with the kernel down[:, None] * across[None, :].

    Parameters
    ----------
    picture : (height, width) or (height, width, channels) float
    down, across : (2 n + 1,) float
        Weights along the first and the second axis.
    border : str
        How the picture goes on outside, as numpy.pad calls it: "edge" repeats the last pixel, "symmetric" mirrors.
    """
    for axis, kernel in ((0, down), (1, across)):
        pad = [(0, 0)] * picture.ndim
        pad[axis] = (len(kernel) // 2, len(kernel) // 2)
        padded = np.moveaxis(np.pad(picture, pad, mode=border), axis, 0)
        length = picture.shape[axis]
        total = kernel[0] * padded[:length]
        for index in range(1, len(kernel)):
            breathe()
            total += kernel[index] * padded[index:index + length]
        picture = np.moveaxis(total, 0, axis)
    return picture
