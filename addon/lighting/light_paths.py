"""Light paths that Cycles follows for each texel of a picture: from where, to which point."""
from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

STEPS = ((0, 1), (0, -1), (1, 0), (-1, 0), (1, 1), (1, -1), (-1, 1), (-1, -1))
"""Rows and columns to the texels beside one, the nearest first."""


@dataclass(frozen=True)
class LightPaths:
    """One light path for each texel of a picture (h, w), rows from below; world space.

    Attributes
    ----------
    used : (h, w) bool
        Texels that have a path.
    left : (h, w, 3) float32
        What of the light the picture is to show, in red, green and blue.
    target : (h, w, 3) float32
        The point whose light is looked for.
    origin : (h, w, 3) float32
        A point on the line along which the target is looked at: the mirror's, or the eye.
    lead : (h, w) float32
        Share of the line from the origin to the target that is left where the path begins: nothing before that hides
        the target.
    across, up : (h, w, 3) float32
        Change of the target from one texel to the next one, along a row and along a column.
    spread : (h, w, 2) float32
        Shares of `across` and `up` over which samples are spread: 0 beside the outline of what is shown, so that no
        light of what lies behind it is mixed in.
    turn : (h, w) float32
        Angle in radians by which the direction may change without a change of the light that counts.
    """

    used: np.ndarray
    left: np.ndarray
    target: np.ndarray
    origin: np.ndarray
    lead: np.ndarray
    across: np.ndarray
    up: np.ndarray
    spread: np.ndarray
    turn: np.ndarray

    @classmethod
    def empty(cls, height: int, width: int) -> LightPaths:
        """Return paths without any texel in use."""
        vectors = (np.zeros((height, width, 3), dtype=np.float32) for _ in range(4))
        target, origin, across, up = vectors
        lead, turn = (np.zeros((height, width), dtype=np.float32) for _ in range(2))
        return cls(np.zeros((height, width), dtype=bool), np.ones((height, width, 3), dtype=np.float32), target, origin,
                   lead, across, up, np.ones((height, width, 2), dtype=np.float32), turn)

    def grown(self, rings: int) -> LightPaths:
        """Return the paths with so many rings of unused texels that take those of a texel beside them.

        Between its texels a picture is interpolated, and a denoiser looks at what lies around each.
        """
        return LightPaths(*grown(self.used, [getattr(self, one.name) for one in fields(self)[1:]], rings))


def grown(used: np.ndarray, arrays: list[np.ndarray], rings: int) -> list[np.ndarray]:
    """Return a mask (h, w) with so many rings of further texels, and arrays (h, w, ...) of which these take the values
    of a texel beside them."""
    used, arrays = used.copy(), [array.copy() for array in arrays]
    height, width = used.shape
    for _ in range(rings):
        known = np.pad(used, 1)
        for y, x in STEPS:
            beside = known[1 + y:1 + y + height, 1 + x:1 + x + width] & ~used
            row, column = np.nonzero(beside)
            used[row, column] = True
            for array in arrays:
                array[row, column] = array[row + y, column + x]
    return [used, *arrays]
