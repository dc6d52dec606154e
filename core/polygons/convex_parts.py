"""Convex parts of cameras: polygons in the cameras' weights, and cutting them along straight lines."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import cross, dot, ranges
from ..support import breathe
from .clipping import cut

PASSES = 256  # lines that cut one camera
SMALLEST = 1e-9  # of a camera: smaller parts are nothing
SHORTEST = 1e-6  # of a line: what must lie in a part to cut it


@dataclass(frozen=True)
class ConvexParts:
    """Convex polygons in the weights of cameras.

    Attributes
    ----------
    weights : (3, k) float64, of all their corners, polygon after polygon
    after : (k,) int8, the label of the line that starts at each corner, as in `clipping.cut`
    polygon : (k,) int64, rising
    """

    weights: np.ndarray
    after: np.ndarray
    polygon: np.ndarray

    @classmethod
    def whole(cls, count: int) -> ConvexParts:
        return cls(np.tile(np.eye(3), (1, count)), np.zeros(3 * count, dtype=np.int8), np.repeat(np.arange(count), 3))

    def cut(self, values: np.ndarray, label: int) -> ConvexParts:
        return ConvexParts(*cut(self.weights, self.after, self.polygon, values, label))

    def following(self) -> np.ndarray:
        """The corner after each corner."""
        following = np.arange(1, len(self.polygon) + 1)
        if len(following):
            ends = np.flatnonzero(np.append(self.polygon[1:] != self.polygon[:-1], True))
            following[ends] = np.append(0, ends[:-1] + 1)
        return following

    def areas(self, count: int) -> np.ndarray:
        """(count,): share of the camera that each polygon covers."""
        (x, y), after = self.weights[:2], self.following()
        return np.abs(np.bincount(self.polygon, x * y[after] - x[after] * y, minlength=count))

    def select(self, chosen: np.ndarray) -> ConvexParts:
        """Polygons where `chosen` (count,), under new numbers."""
        kept = chosen[self.polygon]
        return ConvexParts(self.weights[:, kept], self.after[kept], (np.cumsum(chosen) - 1)[self.polygon[kept]])

    def halved(self, count: int, chosen: np.ndarray, values: np.ndarray) -> ConvexParts:
        """The `count` polygons, of those `chosen` (m,), rising, only where a function is not negative that is linear in
        the weights and has the `values` (3, m) at the corners of their cameras; and behind all the rest of these m."""
        divided = np.zeros(count, dtype=bool)
        divided[chosen] = True
        far = self.select(divided).cut(-values, 0)
        all_values = np.ones((3, count))
        all_values[:, chosen] = values
        near = self.cut(all_values, 0)
        return ConvexParts(np.concatenate((near.weights, far.weights), axis=1), np.concatenate((near.after, far.after)),
                           np.concatenate((near.polygon, far.polygon + count)))

    def triangles(self, count: int, smallest: float = SMALLEST) -> tuple[np.ndarray, np.ndarray]:
        """Fans over the polygons: the polygon of each triangle and the weights (3, 3, n) of its corners, entry [i, k]:
        weight i of corner k. Triangles up to the `smallest` part of a camera are left out."""
        size = np.bincount(self.polygon, minlength=count)
        first = np.cumsum(size) - size
        step, fan = ranges(np.ones(count, dtype=np.int64), np.maximum(size - 2, 0))
        weights = self.weights[:, np.stack((first[fan], first[fan] + step, first[fan] + step + 1))]
        areal = np.abs(dot(weights[:, 0], cross(weights[:, 1], weights[:, 2]))) > smallest
        return fan[areal], weights[:, :, areal]


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


def divide(cameras: np.ndarray, lines: Lines, most: int) -> tuple[np.ndarray, ConvexParts, int]:
    """The pieces into which the lines cut the cameras, not many more than `most`; for each its camera's place among
    them; and how many cameras are not cut along all of their lines."""
    of_line = np.searchsorted(cameras, lines.camera)
    pieces, owner = ConvexParts.whole(len(cameras)), np.arange(len(cameras))
    line, piece = np.arange(len(of_line)), of_line
    for number in range(PASSES + 1):
        breathe()
        crossing = _crosses(pieces, lines, line, piece)
        line, piece = line[crossing], piece[crossing]
        if not len(line) or len(owner) > most or number == PASSES:
            break
        order = np.argsort(piece, kind="stable")
        line, piece = line[order], piece[order]
        chosen, first = np.unique(piece, return_index=True)
        before, other = len(owner), np.full(len(owner), -1)
        other[chosen] = before + np.arange(len(chosen))
        pieces = pieces.halved(before, chosen, lines.values[:, line[first]])
        owner = np.concatenate((owner, owner[chosen]))
        rest = np.ones(len(line), dtype=bool)
        rest[first] = False
        line, piece = np.tile(line[rest], 2), np.concatenate((piece[rest], other[piece[rest]]))
    return owner, pieces, len(np.unique(owner[piece]))


def _crosses(pieces: ConvexParts, lines: Lines, line: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Whether the lines' bounding parts run through the inside of the pieces."""
    count = np.bincount(pieces.polygon, minlength=int(piece.max(initial=0)) + 1)
    begin = np.cumsum(count) - count
    corner, asked = ranges(begin[piece], count[piece])
    number = line[asked]
    value = (pieces.weights[:, corner] * lines.values[:, number]).sum(axis=0)
    after = pieces.following()[corner]
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
