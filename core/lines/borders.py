"""Borders: sides that one face of a result alone has."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, groups, next_corner, shared_edges
from ..support import breathe


@dataclass(frozen=True)
class Borders(ColumnArrays):
    """Sides (b) that one face alone has: which side of which `face` it is, and from which vertex to which it goes."""

    face: np.ndarray
    side: np.ndarray
    start: np.ndarray
    end: np.ndarray

    @classmethod
    def of(cls, triangles: np.ndarray, pixels: np.ndarray) -> Borders:
        """Those of `triangles` (m, 3) that have a place in the picture."""
        _, first, edge = shared_edges(triangles)
        first = first[np.bincount(edge.ravel(), minlength=len(first)) == 1]
        breathe()
        face, side = np.divmod(first, 3)
        start, end = triangles.ravel()[first], triangles[face, next_corner(side)]
        known = np.isfinite(pixels[start]).all(axis=1) & np.isfinite(pixels[end]).all(axis=1)
        return cls(face, side, start, end).select(known)

    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        """Vertices of the borders, each with every face that it ends a side of."""
        vertex, face = np.concatenate((self.start, self.end)), np.concatenate((self.face, self.face))
        first, _ = groups(vertex, face)
        return vertex[first], face[first]
