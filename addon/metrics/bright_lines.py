"""Measure the distance of a picture's brightest line from a curve, by mean profiles across the curve in regions."""
from __future__ import annotations

import numpy as np

from ...core import breathe

BEFORE, BEHIND, STEP = 4.0, 8.0, 0.25  # pixels that a profile reaches to the dark side and to the lit one; its step
PIXEL = round(1.0 / STEP)
REGIONS = 12  # along the longest side of the box round the curve
FEWEST = 4  # pieces of the curve in a region
CONTRAST = 1.15  # of the brightest place of a profile to its ends


def line_offsets(pictures: dict, middle: np.ndarray, inward: np.ndarray, length: np.ndarray) -> dict:
    """Return the distance of the brightest line from a curve in each of several pictures, region by region.

    Parameters
    ----------
    pictures : dict of (height, width) float
        Pictures by name, rows from the bottom up.
    middle, inward : (n, 2) float64
        Middles of the curve's segments in pixels, and unit vectors across it to the lit side.
    length : (n,) float64
        Weight of each segment in the mean profile of its region.

    Returns
    -------
    offsets : dict of (k,) float64
        For each picture, signed distances in pixels, positive on the lit side. Regions are left out if any of the
        pictures has no bright line there.
    """
    at = np.arange(-BEFORE, BEHIND + STEP, STEP)
    places = middle[:, None] + at[None, :, None] * inward[:, None]
    size = max(float(np.ptp(middle, axis=0).max()) / REGIONS, 1.0)
    cell = np.floor((middle - middle.min(axis=0)) / size).astype(np.int64)
    # curves that cross are told apart by their side
    turn = np.floor((np.arctan2(inward[:, 1], inward[:, 0]) + np.pi) / (np.pi / 4.0)).astype(np.int64)
    _, region, count = np.unique(np.column_stack((cell, turn)), axis=0, return_inverse=True, return_counts=True)
    region, found = region.reshape(-1), {}
    for name, picture in pictures.items():
        breathe()
        profile = np.zeros((len(count), len(at)))
        values = length[:, None] * _values(picture, places)
        breathe()
        np.add.at(profile, region, values)
        found[name] = _peaks(profile, at)
    good = count >= FEWEST
    for offset in found.values():
        good &= np.isfinite(offset)
    return {name: offset[good] for name, offset in found.items()}


def _peaks(profile: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the positions (k,) of the maxima of profiles (k, s), refined by a parabola. NaN if no maximum is clear.

    `at` (s,) are the positions of the profiles' samples, in pixels.
    """
    top = np.argmax(profile, axis=1)
    row, inner = np.arange(len(top)), np.clip(top, PIXEL, len(at) - 1 - PIXEL)
    # a pixel apart: in between they are interpolated
    low, mid, high = (profile[row, inner + k] for k in (-PIXEL, 0, PIXEL))
    bend = low - 2.0 * mid + high
    shift = np.where(bend < 0.0, 0.5 * (low - high) / np.where(bend < 0.0, bend, 1.0), 0.0)
    clear = (top == inner) & (mid > CONTRAST * np.maximum(profile[:, 0], profile[:, -1]))
    return np.where(clear, at[inner] + PIXEL * STEP * shift, np.nan)


def _values(picture: np.ndarray, places: np.ndarray) -> np.ndarray:
    """A picture at places (..., 2) in pixels, whose middles lie at halves; its border goes on."""
    height, width = picture.shape
    x, y = (np.clip(places[..., k] - 0.5, 0.0, size - 1.0) for k, size in enumerate((width, height)))
    column, row = (np.minimum(values.astype(np.int64), size - 2) if size > 1 else values.astype(np.int64)
                   for values, size in ((x, width), (y, height)))
    x, y = x - column, y - row
    right, up = np.minimum(column + 1, width - 1), np.minimum(row + 1, height - 1)
    return ((1.0 - y) * ((1.0 - x) * picture[row, column] + x * picture[row, right])
            + y * ((1.0 - x) * picture[up, column] + x * picture[up, right]))
