"""Pieces of the diffuse triangles, and which of them are whole faces.

A triangle with three images that lies on the patch away from its border is a whole face.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, doubled_areas, parent_side, rows, split
from ..patches import Patch
from ..views import box
from .images import Images

NEAR = 0.5  # pixels from the box of a face: where its bent edges may lie


@dataclass(frozen=True)
class Pieces(ColumnArrays):
    """Pieces (f) of scene triangles.

    Attributes
    ----------
    nodes : (3, f) int64
    source : (f,) int64, the triangle that each is a piece of
    lost : (3, f) bool, edges 01, 12, 20 whose middle has no image on the patch
    done : (3, f) bool, edges of which nothing more is to be decided
    """

    nodes: np.ndarray
    source: np.ndarray
    lost: np.ndarray
    done: np.ndarray

    @classmethod
    def of(cls, triangles: np.ndarray, source: np.ndarray) -> Pieces:
        """The triangles (f, 3), whole."""
        nodes = rows(triangles)
        return cls(nodes, source, np.zeros(nodes.shape, dtype=bool), np.zeros(nodes.shape, dtype=bool))

    def split(self, middle: np.ndarray) -> Pieces:
        """Pieces split at the nodes `middle` (3, f) of their edges, -1 for none."""
        parent, local = split((middle >= 0).T)
        side, local = rows(parent_side(local)), rows(local)
        unsplit = (local < 3) & (np.roll(local, -1, axis=0) < 3) & (side < 3)
        own = np.minimum(side, 2)
        return Pieces(np.concatenate((self.nodes, middle))[local, parent], self.source[parent],
                      unsplit & self.lost[own, parent], unsplit & self.done[own, parent])


def whole(patch: Patch, images: Images, pieces: Pieces) -> np.ndarray:
    """Which pieces (f,) are seen whole on the patch."""
    found, lost = images.found[pieces.nodes], pieces.lost
    all_found = found[0] & found[1] & found[2] & ~(lost[0] | lost[1] | lost[2])
    chosen = np.flatnonzero(all_found)
    spots = images.pixel[:, pieces.nodes[:, chosen]]
    low, high = box(spots)
    # with a corner on the patch, what touches no border lies on it whole
    all_found[chosen] = (patch.border.holds(low - NEAR, high + NEAR) & (doubled_areas(spots.T) != 0.0)
                         & ~patch.border.touched(low - NEAR, high + NEAR))
    return all_found
