"""Baked frames of one folder, and keys that say which of them is shown."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from .. import compat
from .frame_records import FrameRecord


@dataclass(frozen=True)
class Sequence:
    """Baked frames of one folder, at least one.

    Attributes
    ----------
    folder : str
        Absolute path.
    records : list of FrameRecord
        In the order of their frames.
    name : str
        Name that distinguishes it from other sequences of the same mirrors; empty if there are none.
    placements : dict
        Placement of each reflection, by the mirror's name.
    camera : str
        Name of its camera; empty if it follows the active camera.
    stretch : float
        Duration of a frame on animation curves, if the scene stretches time.
    """

    folder: str
    records: list[FrameRecord]
    name: str
    placements: dict
    camera: str = ""
    stretch: float = 1.0

    @property
    def layers(self) -> int:
        """Largest number of overlapping faces of caustics in any frame."""
        return max(record.layers for record in self.records)

    @property
    def empty(self) -> set[str]:
        """Keys of the results that are empty in every frame."""
        return {key for key in self.records[0].results
                if all(record.results[key].is_empty for record in self.records)}

    def times(self, values: dict) -> dict:
        """Return values by frame as values by time on animation curves, rounded like Blender does."""
        return {float(np.float32(frame) * np.float32(self.stretch)): value for frame, value in values.items()}


def keyed(data: bpy.types.ID, holder, name: str, values: dict) -> None:
    """Insert keys of a property, by time, with constant interpolation."""
    for time, value in values.items():
        setattr(holder, name, value)
        holder.keyframe_insert(name, frame=time)
    for curve in compat.curves_of(data):
        for key in curve.keyframe_points:
            key.interpolation = "CONSTANT"
