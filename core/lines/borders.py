"""Borders: sides that belong to only one face of a result."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, groups, next_corner, shared_edges
from ..support import breathe


@dataclass(frozen=True)
class Borders(ColumnArrays):
    """Sides (b) that belong to one face only.

    Attributes
    ----------
    face : (b,) int64, the face
    side : (b,) int64, number of the side in it: 0, 1, 2 for 01, 12, 20
    start, end : (b,) int64, vertices at its ends
    """

    face: np.ndarray
    side: np.ndarray
    start: np.ndarray
    end: np.ndarray

    @classmethod
    def of(cls, triangles: np.ndarray, pixels: np.ndarray) -> Borders:
        """Find the borders of `triangles` (m, 3); sides with ends whose `pixels` (n, 2) are not finite are left out."""
        _, first, edge = shared_edges(triangles)
        first = first[np.bincount(edge.ravel(), minlength=len(first)) == 1]
        breathe()
        face, side = np.divmod(first, 3)
        start, end = triangles.ravel()[first], triangles[face, next_corner(side)]
        known = np.isfinite(pixels[start]).all(axis=1) & np.isfinite(pixels[end]).all(axis=1)
        return cls(face, side, start, end).select(known)

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Return pairs (k,) of a border's end vertex and the border's face, without duplicates."""
        vertex, face = np.concatenate((self.start, self.end)), np.concatenate((self.face, self.face))
        first, _ = groups(vertex, face)
        return vertex[first], face[first]
