"""Numbers per pixel -> colours: a heat map with its scale below, in perceptually even, colour-blind-safe colours."""
from __future__ import annotations

import numpy as np

from ...core import breathe
from .png_file import png_bytes

# 33 of the 256 colours of viridis, by S. van der Walt, N. Smith and E. Firing (matplotlib, 2015), which is dedicated to
# the public domain (CC0 1.0); in between, linear in sRGB
VIRIDIS = (
    "440154 470d60 48186a 482374 472d7b 453681 424086 3f4989 3b528b 375a8d 33638d "
    "2f6a8e 2c728e 297a8e 26818e 23898e 21908c 1f988b 1f9f88 21a685 28ae80 31b57b "
    "3ebc74 4cc26c 5dc963 6ece58 82d34c 96d83f abdc32 c0df24 d5e21a eae51a fde725")
STEPS = 240
# entries of the palette behind the colours
NO_VALUE, INK, PAPER = STEPS, STEPS + 1, STEPS + 2
GREYS = np.array([[70, 70, 70], [20, 20, 20], [255, 255, 255]], dtype=np.uint8)
# three columns of each of five rows, from the top down, as octal digits
GLYPHS = {"0": "75557", "1": "26227", "2": "71747", "3": "71717", "4": "55711", "5": "74717", "6": "74757",
          "7": "71111", "8": "75757", "9": "75717", ".": "00002", "p": "06564", "x": "00525", " ": "00000"}


def palette() -> np.ndarray:
    """(STEPS + 3, 3) uint8: the colours from low to high, then no value, ink and paper."""
    anchors = np.array([[int(code[k:k + 2], 16) for k in (0, 2, 4)] for code in VIRIDIS.split()], dtype=np.float64)
    places = np.linspace(0.0, len(anchors) - 1.0, STEPS)
    colours = np.stack([np.interp(places, np.arange(len(anchors)), anchors[:, k]) for k in range(3)], axis=1)
    return np.concatenate([np.rint(colours).astype(np.uint8), GREYS])


def heat_map(values: np.ndarray, low: float, high: float, unit: str = "") -> bytes:
    """A PNG of a heat map on a logarithmic scale, with the scale drawn below.

    Parameters
    ----------
    values : (height, width) float
        From the lowest row up; NaN where there is nothing to show, which is grey.
    low, high : float
        Powers of ten at the ends of the scale; what lies beyond takes the colour of the end.
    unit : str
        Written after the last number of the scale.
    """
    indices = np.full(values.shape, NO_VALUE, dtype=np.uint8)
    known = np.isfinite(values)
    breathe()
    share = np.log(np.clip(values[known], low, high) / low) / np.log(high / low)
    breathe()
    indices[known] = np.minimum(share * STEPS, STEPS - 1).astype(np.uint8)
    return png_bytes(np.concatenate([indices[::-1], scale(values.shape[1], low, high, unit)]), palette())


def scale(width: int, low: float, high: float, unit: str) -> np.ndarray:
    """A bar from `low` to `high` with a number at each power of ten, (height, width) entries of the palette."""
    size = max(width // 200, 1)
    bar, text = 6 * size, 5 * size
    drawn = np.full((size + bar + 2 * size + text + 2 * size, width), PAPER, dtype=np.uint8)
    left, right = 3 * size, max(width - 3 * size, 3 * size + 2)
    drawn[size:size + bar, left:right] = np.linspace(0, STEPS - 1, right - left).astype(np.uint8)
    decades = round(np.log10(high / low))
    for step in range(decades + 1):
        column = left + round((right - 1 - left) * step / decades)
        drawn[size + bar:2 * size + bar, column:column + 1] = INK
        written = glyphs(f"{low * 10.0 ** step:g}" + (f" {unit}" if unit and step == decades else ""), size)
        start = int(np.clip(column - written.shape[1] // 2, size, max(width - written.shape[1] - size, size)))
        space = drawn[2 * size + bar + size:, start:start + written.shape[1]][:written.shape[0]]
        space[written[:, :space.shape[1]]] = INK
    return drawn


def glyphs(text: str, size: int) -> np.ndarray:
    """Text as pixels (5 * size, columns) bool, one column apart."""
    rows = [[bool(int(GLYPHS[letter][row]) & bit) for letter in text for bit in (4, 2, 1, 0)] for row in range(5)]
    return np.array(rows).repeat(size, axis=0).repeat(size, axis=1)
