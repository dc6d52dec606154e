"""Dividing cameras along straight lines, each into the pieces that lines leave."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import dot, ranges
from ..support import breathe
from .convex_polygons import ConvexPolygons

PASSES = 256  # lines that cut one camera
SHORTEST = 1e-6  # of a line: what must lie in a part to cut it


@dataclass(frozen=True)
class Lines:
    """Straight lines (l) across cameras: where a function, linear in the weights, is zero.

    Attributes
    ----------
    camera : (l,) int64
    values : (3, l) float64, the function at the camera's corners
    start, stop : (3, l) float64, weights of the ends of the part that bounds what is hidden
    """

    camera: np.ndarray
    values: np.ndarray
    start: np.ndarray
    stop: np.ndarray

    def select(self, chosen: np.ndarray) -> Lines:
        return Lines(self.camera[chosen], self.values[:, chosen], self.start[:, chosen], self.stop[:, chosen])


def divide(cameras: np.ndarray, lines: Lines, most: int) -> tuple[ConvexPolygons, int]:
    """The pieces into which the lines cut the cameras, not many more than `most`, owned by their places among them; and
    how many cameras are not cut along all of their lines."""
    pieces = ConvexPolygons.whole(len(cameras))
    line, piece = np.arange(len(lines.camera)), np.searchsorted(cameras, lines.camera)
    for number in range(PASSES + 1):
        breathe()
        crossing = _crosses(pieces, lines, line, piece)
        line, piece = line[crossing], piece[crossing]
        if not len(line) or len(pieces) > most or number == PASSES:
            break
        order = np.argsort(piece, kind="stable")
        line, piece = line[order], piece[order]
        chosen, first = np.unique(piece, return_index=True)
        other = np.full(len(pieces), -1)
        other[chosen] = len(pieces) + np.arange(len(chosen))
        pieces = pieces.halved(chosen, lines.values[:, line[first]])
        rest = np.ones(len(line), dtype=bool)
        rest[first] = False
        line, piece = np.tile(line[rest], 2), np.concatenate((piece[rest], other[piece[rest]]))
    return pieces, len(np.unique(pieces.owner[piece]))


def _crosses(pieces: ConvexPolygons, lines: Lines, line: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Whether the lines' bounding parts run through the inside of the pieces."""
    corner, asked = ranges(pieces.start[piece], pieces.size[piece])
    number = line[asked]
    value = (pieces.weights[:, corner] * lines.values[:, number]).sum(axis=0)
    after = pieces.following[corner]
    value_after = (pieces.weights[:, after] * lines.values[:, number]).sum(axis=0)
    crossing = np.flatnonzero((value >= 0.0) != (value_after >= 0.0))
    share = value[crossing] / (value[crossing] - value_after[crossing])
    start, end = pieces.weights[:, corner[crossing]], pieces.weights[:, after[crossing]]
    number, asked = number[crossing], asked[crossing]
    way = lines.stop[:, number] - lines.start[:, number]
    at = dot(start + share * (end - start) - lines.start[:, number], way) / np.maximum(dot(way, way), 1e-300)
    low, high = np.full(len(line), np.inf), np.full(len(line), -np.inf)
    np.minimum.at(low, asked, at)
    np.maximum.at(high, asked, at)
    return np.minimum(high, 1.0) - np.maximum(low, 0.0) > SHORTEST
