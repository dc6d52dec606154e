"""The part of the picture that light is made for."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ....core import View
from ...reading import vectors
from ...writing import place_of

MARGIN = 3  # pixels around the results, where the picture's filter still mixes them with what lies beside


@dataclass(frozen=True)
class Window:
    """A part of the picture: its lowest column and row, its width and height, in pixels of a picture of `size`."""

    column: int
    row: int
    width: int
    height: int
    size: tuple[int, int]

    @classmethod
    def around(cls, view: View, places: np.ndarray) -> Window | None:
        """The window that shows places (n, 3) in world space; None where that is nothing."""
        spots = view.pixels(places)
        spots = spots[np.isfinite(spots).all(axis=1)]
        if not len(spots):
            return None
        lowest, highest = (np.clip(side, 0, view.resolution).astype(int) for side in (
            np.floor(spots.min(axis=0)) - MARGIN, np.ceil(spots.max(axis=0)) + MARGIN))
        if (highest <= lowest).any():
            return None
        return cls(*lowest.tolist(), *(highest - lowest).tolist(), view.resolution)


def on_the_mirror(result: bpy.types.Object) -> np.ndarray:
    """Places (n, 3) of a result's points where the camera sees them in the mirror: any on the same line of sight do."""
    if "mirror_position" in result.data.attributes:
        return vectors(result.data, "mirror_position")
    to_world = np.array(place_of(result))
    return vectors(result.data, "position") @ to_world[:3, :3].T + to_world[:3, 3]
