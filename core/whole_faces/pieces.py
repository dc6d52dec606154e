"""Pieces of the diffuse triangles, and the test whether a piece can be drawn unclipped.

A piece can be, if its three corners have images and it lies on the patch away from the patch's border.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import (
    ColumnArrays,
    columns,
    cross,
    dot,
    doubled_areas,
    following,
    largest,
    next_corner,
    norm,
    parent_side,
    rows,
    split,
)
from ..patches import Patch
from ..support import portions
from ..views import box
from .images import Images

AT_ONCE = 16384  # pieces whose arrays fit the cache
NEAR = 0.5  # pixels from the box of a face: where its bent edges may lie


@dataclass(frozen=True)
class Pieces(ColumnArrays):
    """Pieces (f) of scene triangles.

    Attributes
    ----------
    nodes : (3, f) int64
    source : (f,) int64, the triangle that each is a piece of
    lost : (3, f) bool, edges 01, 12, 20 whose middle has no image on the patch
    done : (3, f) bool, edges that are not to be examined again
    """

    nodes: np.ndarray
    source: np.ndarray
    lost: np.ndarray
    done: np.ndarray

    @classmethod
    def of(cls, triangles: np.ndarray, source: np.ndarray) -> Pieces:
        """Make one piece of each triangle (f, 3)."""
        nodes = rows(triangles)
        return cls(nodes, source, np.zeros(nodes.shape, dtype=bool), np.zeros(nodes.shape, dtype=bool))

    def split(self, middle: np.ndarray) -> Pieces:
        """Pieces split at the nodes `middle` (3, f) of their edges, -1 for none."""
        parent, local = split((middle >= 0).T)
        side, local = rows(parent_side(local)), rows(local)
        unsplit = (local < 3) & (following(local, axis=0) < 3) & (side < 3)
        own = np.minimum(side, 2)
        return Pieces(np.concatenate((self.nodes, middle))[local, parent], self.source[parent],
                      unsplit & self.lost[own, parent], unsplit & self.done[own, parent])


def turned_away(images: Images, pieces: Pieces, outward: np.ndarray) -> np.ndarray:
    """Return True for pieces (f,) that are seen from behind everywhere on the patch.

    `outward` (f,) is 1 for pieces that are visible from the front only, 0 for others, which are never turned away.
    """
    found = np.zeros(len(pieces), dtype=bool)
    asked = np.flatnonzero(outward != 0.0)
    for part in portions(len(asked), AT_ONCE):
        some = asked[part]
        nodes = columns(pieces.nodes, some)
        a, b, c = (columns(images.point, node) for node in nodes)
        places = [columns(images.place, node) for node in nodes]
        normal = cross(b - a, c - a)
        # the mirror between three places bulges by less than their largest distance
        bulge = largest(np.stack([norm(places[k] - places[next_corner(k)]) for k in range(3)]))
        away = np.ones(len(some), dtype=bool)
        for node, place in zip(nodes, places):
            away &= columns(images.found, node) & (dot(normal, place - a) < -bulge * norm(normal))
        found[some] = away
    return found


def whole(patch: Patch, images: Images, pieces: Pieces) -> np.ndarray:
    """Return True for pieces (f,) whose whole image lies on the patch."""
    every = np.empty(len(pieces), dtype=bool)
    for part in portions(len(every), AT_ONCE):
        found, lost = columns(images.found, pieces.nodes[:, part]), pieces.lost[:, part]
        all_found = found[0] & found[1] & found[2] & ~(lost[0] | lost[1] | lost[2])
        chosen = np.flatnonzero(all_found)
        spots = columns(images.pixel, pieces.nodes[:, part.start + chosen])
        low, high = box(spots)
        # a piece with a corner on the patch that touches no border lies entirely on it
        all_found[chosen] = (patch.border.holds(low - NEAR, high + NEAR) & (doubled_areas(spots.T) != 0.0)
                             & ~patch.border.touched(low - NEAR, high + NEAR))
        every[part] = all_found
    return every
