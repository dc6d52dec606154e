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
        What tells it from other sequences of the same mirrors; empty where there are none.
    placements : dict
        Where each mirror's reflection lies, by the mirror's name.
    camera : str
        The name of its camera; empty where it is right for every camera, as markers choose them.
    stretch : float
        How long a frame lasts on animation curves, where its scene stretches time.
    """

    folder: str
    records: list[FrameRecord]
    name: str
    placements: dict
    camera: str = ""
    stretch: float = 1.0

    @property
    def layers(self) -> int:
        """How many faces of light lie over each other in any frame, whoever has made it."""
        return max(record.layers for record in self.records)

    @property
    def empty(self) -> set[str]:
        """Those of its results, as the records name them, that are empty in every frame."""
        return {key for key in self.records[0].results
                if all(record.results[key].is_empty for record in self.records)}

    def times(self, values: dict) -> dict:
        """Values by frames as values by where Blender looks for them on curves, rounded as it rounds."""
        return {float(np.float32(frame) * np.float32(self.stretch)): value for frame, value in values.items()}


def keyed(data: bpy.types.ID, holder, name: str, values: dict) -> None:
    """Keys of a value, by where they lie on its curve, that stays as it is until the next one."""
    for time, value in values.items():
        setattr(holder, name, value)
        holder.keyframe_insert(name, frame=time)
    for curve in compat.curves_of(data):
        for key in curve.keyframe_points:
            key.interpolation = "CONSTANT"
