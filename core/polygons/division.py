"""Division of cameras, or of the polygons that they see, into pieces along straight lines."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import ColumnArrays, columns, dot, first_of, in_order, ranges, shares
from .convex_polygons import ConvexPolygons, Kind

CORNERS_AT_ONCE = 1 << 15  # fit the cache
PASSES = 256  # lines that cut one piece, at most
SHORTEST = 1e-6  # share of a line's length that must lie in a piece to cut it


@dataclass(frozen=True)
class Lines(ColumnArrays):
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


def divide(pieces: Kind, lines: Lines, line: np.ndarray, piece: np.ndarray, most: int) -> tuple[Kind, np.ndarray]:
    """Cut each polygon `piece` (k,) of `pieces` along its `line` (k,); stop at about `most` pieces.

    Returns
    -------
    pieces : polygons, all parts on both sides of the lines
    open_ : (o,) int64, owners of the polygons that were not cut along all of their lines
    """
    whole: list[Kind] = []
    for number in range(PASSES + 1):
        crossing = _crosses(pieces, lines, line, piece)
        line, piece = line[crossing], piece[crossing]
        if not len(line) or len(pieces) + sum(map(len, whole)) > most or number == PASSES:
            break
        order = in_order(piece)
        line, (chosen, first, piece) = line[order], first_of(piece[order])
        whole.append(pieces.select(np.delete(np.arange(len(pieces)), chosen)))
        pieces = pieces.select(chosen).halved(np.arange(len(chosen)), lines.values[:, line[first]])
        line, piece = np.delete(line, first), np.delete(piece, first)
        line, piece = np.tile(line, 2), np.concatenate((piece, piece + len(chosen)))
    return pieces.joined([*whole, pieces]), np.unique(pieces.owner[piece])


def _crosses(pieces: ConvexPolygons, lines: Lines, line: np.ndarray, piece: np.ndarray) -> np.ndarray:
    """Return True (k,) where the bounding part of a `line` (k,) runs through the inside of its `piece` (k,)."""
    size, after = pieces.size, pieces.following
    found = [np.zeros(0, dtype=bool)]
    for part in shares(size[piece], CORNERS_AT_ONCE):
        corner, asked = ranges(pieces.start[piece[part]], size[piece[part]])
        found.append(_cross(pieces.weights, (corner, after[corner]), lines, line[part], asked))
    return np.concatenate(found)


def _cross(weights: np.ndarray, corners: tuple[np.ndarray, np.ndarray], lines: Lines, line: np.ndarray,
           asked: np.ndarray) -> np.ndarray:
    """Return True for each `line` (n,) that crosses its piece.

    Parameters
    ----------
    weights : (3, c) float64, of all corners
    corners : two (k,) int64, corners of the pieces, and the corner after each
    line : (n,) int64, into `lines`
    asked : (k,) int64, entry of `line` that each corner is tested for
    """
    corner, after = corners
    value = dot(columns(weights, corner), columns(lines.values, line[asked]))
    # a corner and its successor are as far apart in `value` as in `weights`
    value_after = value[np.arange(len(corner)) + after - corner]
    crossing = np.flatnonzero((value >= 0.0) != (value_after >= 0.0))
    share = value[crossing] / (value[crossing] - value_after[crossing])
    start, end = columns(weights, corner[crossing]), columns(weights, after[crossing])
    asked = asked[crossing]
    first = columns(lines.start, line[asked])
    way = columns(lines.stop, line[asked]) - first
    at = dot(start + share * (end - start) - first, way) / np.maximum(dot(way, way), 1e-300)
    low, high = np.full(len(line), np.inf), np.full(len(line), -np.inf)
    np.minimum.at(low, asked, at)
    np.maximum.at(high, asked, at)
    return np.minimum(high, 1.0) - np.maximum(low, 0.0) > SHORTEST
