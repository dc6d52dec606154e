"""Wide triangles as parts, each of which may be asked for by itself, and what one picture of them tells of another."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ....core import breathe
from ....core.geometry import ranges, shares

ACROSS = 8.0    # texels along a part's legs at the most
MOST_ALONG = 256  # parts along a triangle's side
STEPS = 2.0     # places along what is seen, to one part of what it is seen of
MOST_STEPS = 64
PLACES = 1 << 18  # on faces, or in the boxes of parts, at once
SLACK = 1e-4    # of a part's sides: what lies on its border is in it


@dataclass(frozen=True)
class Division:
    """Triangles, each divided into as many parts of its own shape as the square of a number, in the triangles' order.

    Attributes
    ----------
    count : (m,) int64
        Parts along a triangle's side.
    owner : (p,) int64
        The triangle of each part.
    weights : (p, 3, 3) float64
        Of the triangle's corners at the part's.
    lattice : (p, 3) int64
        Which places of all triangles' lattices its corners are.
    """

    count: np.ndarray
    owner: np.ndarray
    weights: np.ndarray
    lattice: np.ndarray

    def values(self, corners: np.ndarray) -> np.ndarray:
        """What is linear on triangles, from their corners (m, 3, c) to those of the parts (p, 3, c)."""
        if len(self.owner) == len(self.count):
            return corners
        return np.matmul(self.weights, corners[self.owner]).astype(corners.dtype)

    def greatest(self, triangle: np.ndarray, weights: np.ndarray, values: np.ndarray) -> np.ndarray:
        """The greatest of `values` (n,) that is asked for in or beside each part, (p,), 0 where none is: asked for on
        faces (n,) with corners `weights` (n, 3, 3) in triangles."""
        size = (self.count + 1)**2
        starts = np.cumsum(size) - size
        found = np.zeros(int(size.sum()))
        for some, places in _strewn(weights, self.count[triangle]):
            breathe()
            count = self.count[triangle[some]][:, None]
            at = np.matmul(places, weights[some])[..., 1:] * count[..., None]
            low = np.clip(np.floor(at), 0, count[..., None] - 1).astype(np.int64)
            beyond = (at - low).sum(axis=2) > 1.0
            first = starts[triangle[some]][:, None] + low[..., 0] * (count + 1) + low[..., 1]
            asked = np.broadcast_to(values[some][:, None], first.shape)
            for place in (first + count + 1, first + 1, np.where(beyond, first + count + 2, first)):
                np.maximum.at(found, place, asked)
        return found[self.lattice].max(axis=1)


def divided(count: np.ndarray) -> Division:
    """Triangles with `count` (m,) parts along each side."""
    parts = count**2
    starts, places = np.cumsum(parts) - parts, np.cumsum((count + 1)**2) - (count + 1)**2
    weights, lattice = np.empty((int(parts.sum()), 3, 3)), np.empty((int(parts.sum()), 3), dtype=np.int64)
    for number in np.unique(count).tolist():
        own = np.flatnonzero(count == number)
        corners = _parts_of_one(number)
        rows = starts[own][:, None] + np.arange(number**2)
        weights[rows] = np.concatenate((number - corners.sum(axis=2, keepdims=True), corners), axis=2) / number
        lattice[rows] = places[own][:, None, None] + corners[..., 0] * (number + 1) + corners[..., 1]
    return Division(count, np.repeat(np.arange(len(count)), parts), weights, lattice)


def parts_along(spots: np.ndarray, widest: float) -> np.ndarray:
    """Into how many parts (m,) a side of triangles with corners `spots` (m, 3, 2), in texels, is to be divided: those
    that are `widest` texels across and more."""
    sides = np.linalg.norm(spots[:, (1, 2, 0)] - spots, axis=2)
    legs = np.sort(sides, axis=1)
    many = 2.0 ** np.ceil(np.log2(np.maximum(legs[:, 1] / ACROSS, 1.0)))
    return np.where(legs[:, 0] >= widest, np.minimum(many, MOST_ALONG), 1).astype(np.int64)


def enlarged(small: np.ndarray, large: np.ndarray, known: np.ndarray, start: np.ndarray, end: np.ndarray) -> None:
    """Write into a picture `large`, where nothing is `known` (height, width), what `small` tells, linearly between its
    texels, of parts that have their corners (p, 3, 2) in it at `start`, and in `large` at `end`, counted in texels."""
    low = np.maximum(np.floor(end.min(axis=1) - 0.5).astype(np.int64), 0)
    wide, high = np.maximum(np.minimum(np.ceil(end.max(axis=1)).astype(np.int64) + 1, known.shape[::-1]) - low, 0).T
    along, up = end[:, 1] - end[:, 0], end[:, 2] - end[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        # to the places along both sides
        back = np.stack((up[:, 1], -up[:, 0], -along[:, 1], along[:, 0])) / (along[:, 0] * up[:, 1] - along[:, 1]
                                                                            * up[:, 0])
    # a strip may be thousands of texels long, and few wide
    for some in shares(wide * high, PLACES):
        breathe()
        step, part = ranges(np.zeros(some.stop - some.start, dtype=np.int64), (wide * high)[some])
        part += some.start
        column, row = low[part, 0] + step % wide[part], low[part, 1] + step // wide[part]
        away, above = column + 0.5 - end[part, 0, 0], row + 0.5 - end[part, 0, 1]
        second = back[0, part] * away + back[1, part] * above
        third = back[2, part] * away + back[3, part] * above
        open_ = (second >= -SLACK) & (third >= -SLACK) & (second + third <= 1.0 + SLACK) & ~known[row, column]
        column, row, part, second, third = (of[open_] for of in (column, row, part, second, third))
        weights = np.column_stack((1.0 - second - third, second, third))
        large[row, column] = _between(small, np.einsum("nk,nkc->nc", weights, start[part]))
        known[row, column] = True


def _between(picture: np.ndarray, at: np.ndarray) -> np.ndarray:
    """A picture at places (n, 2), counted in texels, linearly between their middles."""
    low = np.floor(at - 0.5).astype(np.int64)
    column, row = (at - 0.5 - low).astype(np.float32).T[:, :, None]
    (left, below), (right, above) = (np.clip(side, 0, np.array(picture.shape[1::-1]) - 1).T for side in (low, low + 1))
    return ((1.0 - row) * ((1.0 - column) * picture[below, left] + column * picture[below, right])
            + row * ((1.0 - column) * picture[above, left] + column * picture[above, right]))


def _parts_of_one(number: int) -> np.ndarray:
    """Corners (n, 3, 2) of a triangle's parts, `number` along a side, in steps from its first corner to the second and
    to the third."""
    across, up = (side.ravel() for side in np.meshgrid(np.arange(number), np.arange(number), indexing="ij"))
    first = np.stack((across, up), axis=1)
    standing, turned = first[across + up < number], first[across + up < number - 1]
    return np.concatenate([base[:, None] + np.array(shape) for base, shape in (
        (standing, ((0, 0), (1, 0), (0, 1))), (turned, ((1, 0), (1, 1), (0, 1))))])


def _strewn(weights: np.ndarray, count: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Faces (n, 3, 3), some after some as indices (k,), with places (j, 3) on them by the weights of their corners, as
    near one another as parts are wide."""
    wide = np.ptp(weights, axis=1).max(axis=1) * count
    steps = 2 ** np.ceil(np.log2(np.clip(STEPS * wide, 1.0, MOST_STEPS))).astype(np.int64)
    for number in np.unique(steps).tolist():
        corners = np.unique(_parts_of_one(number).reshape(-1, 2), axis=0)
        places = np.column_stack((number - corners.sum(axis=1), corners)) / number
        chosen = np.flatnonzero(steps == number)
        count = max(PLACES // len(places), 1)
        for first in range(0, len(chosen), count):
            yield chosen[first:first + count], places
