"""Cache of the mirrors that cameras may show, found before refinement: cameras that stay unsplit need no new search."""
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
    faces : (f,) bool, True for faces of the map that may show a mirror in any of the cameras
    plainly : (f,) bool, True if that mirror rises above the face's plane by more than single-precision rounding
    cameras : Cameras, the n cameras for which all mirrors are known
    start : (n + 1,) int64, camera i may show triangle[start[i]:start[i + 1]]
    triangle : (p,) int64, triangles of mirrors
    """

    faces: np.ndarray
    plainly: np.ndarray
    cameras: Cameras
    start: np.ndarray
    triangle: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, pairs: tuple[np.ndarray, np.ndarray], plainly: np.ndarray,
           given_up: np.ndarray) -> MirrorsShown:
        """Build the cache from pairs of a camera and a triangle.

        Parameters
        ----------
        cameras : Cameras
        pairs : tuple, cameras (p,) and triangles (p,)
        plainly : (p,) bool, True if the triangle rises above the camera's plane by more than rounding
        given_up : (n,) bool, True for cameras without a complete list: they may show any mirror
        """
        camera, triangle = pairs
        any_, last = np.flatnonzero(given_up), int(cameras.face.max(initial=-1))
        faces, plain = (mask(last + 1, cameras.face[np.append(chosen, any_)]) for chosen in (camera, camera[plainly]))
        kept, number = cameras.select(~given_up), numbered(len(given_up), ~given_up)
        count = np.bincount(number[camera], minlength=len(kept))
        return cls(faces, plain, kept, np.append(0, np.cumsum(count)), triangle[in_order(camera)])

    @classmethod
    def unknown(cls, cameras: Cameras) -> MirrorsShown:
        """Return a cache without knowledge: any camera may show any mirror."""
        every, none = np.ones(int(cameras.face.max(initial=-1)) + 1, dtype=bool), np.zeros(0, dtype=np.int64)
        return cls(every, every, cameras.select(none), np.zeros(1, dtype=np.int64), none)

    def known(self, cameras: Cameras) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Look up the pairs of other cameras (m,) that are in the cache, with the same corners.

        Returns
        -------
        camera, triangle : (p,) int64, pairs of one of the other cameras and a triangle
        known : (m,) bool, True for cameras in the cache
        """
        own = len(self.cameras)
        corners = np.concatenate((self.cameras.corners, cameras.corners))
        first, group = groups(*corners.T, np.concatenate((self.cameras.face, cameras.face)))
        row = first[group[own:]]
        same = np.flatnonzero(row < own)
        entry, run = ranges(self.start[row[same]], np.diff(self.start)[row[same]])
        return same[run], self.triangle[entry], row < own
