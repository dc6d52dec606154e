"""What mirrors cameras show, as it was found before the cameras were refined: most are not, and need not ask again."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import groups, in_order, mask, numbered, ranges


@dataclass(frozen=True)
class MirrorsShown:
    """Mirrors that cameras (n) may show.

    Attributes
    ----------
    faces : (f,) bool, which faces of the map may show a mirror in any of the cameras
    plainly : (f,) bool, which of them may show more of one than rises above them by the rounding of single precision
    cameras : Cameras, those of which all mirrors are known
    start : (n + 1,) int64, camera i may show triangle[start[i]:start[i + 1]]
    triangle : (p,) int64
    """

    faces: np.ndarray
    plainly: np.ndarray
    cameras: Cameras
    start: np.ndarray
    triangle: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, pairs: tuple[np.ndarray, np.ndarray], plainly: np.ndarray,
           given_up: np.ndarray) -> MirrorsShown:
        """Of pairs of a camera and a triangle, some `plainly` seen (p,); the cameras `given_up` (n,) may show any."""
        camera, triangle = pairs
        any_, last = np.flatnonzero(given_up), int(cameras.face.max(initial=-1))
        faces, plain = (mask(last + 1, cameras.face[np.append(chosen, any_)]) for chosen in (camera, camera[plainly]))
        kept, number = cameras.select(~given_up), numbered(len(given_up), ~given_up)
        count = np.bincount(number[camera], minlength=len(kept))
        return cls(faces, plain, kept, np.append(0, np.cumsum(count)), triangle[in_order(camera)])

    @classmethod
    def unknown(cls, cameras: Cameras) -> MirrorsShown:
        """Any camera may show any mirror."""
        every, none = np.ones(int(cameras.face.max(initial=-1)) + 1, dtype=bool), np.zeros(0, dtype=np.int64)
        return cls(every, every, cameras.select(none), np.zeros(1, dtype=np.int64), none)

    def known(self, cameras: Cameras) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Pairs (p,) of a camera and a triangle for those of other cameras (m,) that are among these, on the very same
        corners; and which those are."""
        own = len(self.cameras)
        corners = np.concatenate((self.cameras.corners, cameras.corners))
        first, group = groups(*corners.T, np.concatenate((self.cameras.face, cameras.face)))
        row = first[group[own:]]
        same = np.flatnonzero(row < own)
        entry, run = ranges(self.start[row[same]], np.diff(self.start)[row[same]])
        return same[run], self.triangle[entry], row < own
