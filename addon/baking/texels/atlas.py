"""Room for every triangle of an object in a square picture, and for the pictures of several objects in one."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from .halves import halves

RIM = 0.49         # texels between a triangle and the border of its cell: the outermost have their middles inside
DIAGONAL = 2.0     # texels along either leg to another triangle that shares its cell
NARROW = 1.0       # the same in the smallest cells
SMALLEST = 2       # a cell's side is at least 2 to this power
WIDER = (1.0, 1.1, 1.2)  # than the side of a square of all the area: one of these holds all best


@dataclass(frozen=True)
class Atlas:
    """Where the corners of triangles lie in a picture.

    Attributes
    ----------
    size : int
        Of the picture, in texels along a side, a power of two.
    uv : (n, 3, 2) float32
        Of the triangles' corners, from 0 to 1 across the picture.
    """

    size: int
    uv: np.ndarray

    @property
    def spots(self) -> np.ndarray:
        """The same, (n, 3, 2) float64, in texels."""
        return self.uv.astype(np.float64) * self.size


def arranged(sizes: np.ndarray) -> tuple[np.ndarray, int]:
    """Where pictures of `sizes` (n, 2), width and height, lie in one, (n, 2) int64 columns and rows, and how long the
    longer side of all together is."""
    least = max(int(sizes[:, 0].max(initial=1)), math.ceil(math.sqrt(int(sizes.prod(axis=1).sum()))))
    tried = [_below_a_skyline(sizes, int(wider * least)) for wider in WIDER]
    sides = [int((at + sizes).max(initial=1)) for at in tried]
    return tried[int(np.argmin(sides))], min(sides)


def _below_a_skyline(sizes: np.ndarray, width: int) -> np.ndarray:
    """Where pictures lie, the highest first, each where the skyline of those before lets it lie lowest (J. Jylänki, "A
    thousand ways to pack the bin", 2010)."""
    at, skyline = np.zeros((len(sizes), 2), dtype=np.int64), [(0, 0, width)]  # column, row, width
    for number in np.argsort(-sizes[:, 1], kind="stable").tolist():
        wide, high = sizes[number].tolist()
        row, column, first = min((_row_above(skyline, index, wide), part[0], index)
                                 for index, part in enumerate(skyline) if part[0] + wide <= width)
        at[number] = column, row
        last, rest = first, wide
        while rest > 0 and skyline[last][2] <= rest:
            rest, last = rest - skyline[last][2], last + 1
        raised = [(column, row + high, wide)]
        if rest > 0:
            start, own, long = skyline[last]
            raised, last = [*raised, (start + rest, own, long - rest)], last + 1
        if first and skyline[first - 1][1] == row + high:
            first, raised[0] = first - 1, (skyline[first - 1][0], row + high, skyline[first - 1][2] + wide)
        skyline[first:last] = raised
    return at


def _row_above(skyline: list[tuple[int, int, int]], index: int, wide: int) -> int:
    """The lowest row that is free above so much of a skyline from a part on."""
    row = 0
    while wide > 0:
        row, wide, index = max(row, skyline[index][1]), wide - skyline[index][2], index + 1
    return row


def packed(corners: np.ndarray, density: float | np.ndarray) -> Atlas:
    """Pack triangles into a picture, two and two into rectangles with sides of powers of two: the halves of a
    parallelogram side by side as they are, others with a gap.

    Rectangles of one shape are stacked to squares, and squares, from large to small along a Z curve, lie without a gap
    (the order of G. M. Morton, "A Computer Oriented Geodetic Data Base", 1966).

    Parameters
    ----------
    corners : (n, 3, 3) float64
        In space.
    density : float or (n,) float64
        Texels per unit of length; two halves have the greater of theirs.
    """
    legs, first = _legs(corners)
    second, alike = halves(np.take_along_axis(corners, first[:, :, None], axis=1))
    first[alike] = first[alike][:, (0, 2, 1)]
    later = np.flatnonzero(second)
    legs[second] = legs[later - 1]
    whole = second | np.r_[second[1:], np.zeros(min(len(second), 1), bool)]
    fine = np.array(np.broadcast_to(density, len(legs)), dtype=np.float64)
    fine[later] = fine[later - 1] = np.maximum(fine[later], fine[later - 1])
    texels = legs * fine[:, None]
    exponents = _exponents(texels, whole)
    size = _side(int((4 ** _squares(exponents, whole)[2]).sum()))
    # no more than is asked for is baked, but for the smallest, which need the room
    texels = np.where(exponents == SMALLEST, np.inf, texels)
    uv = np.empty((len(first), 3, 2), dtype=np.float32)
    np.put_along_axis(uv, first[:, :, None], _placed(exponents, texels, whole) / size, axis=1)
    return Atlas(size, uv)


def _legs(corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (n, 2) of the two shorter sides of triangles, the longer of them first, and the corners (n, 3) between
    them, at the end of the first and at the end of the second."""
    sides = np.linalg.norm(corners[:, (1, 2, 0)] - corners, axis=2)
    longest = sides.argmax(axis=1)
    # side k goes from corner k to k + 1; the corner k + 2 lies opposite
    apex = (longest + 2) % 3
    ends = np.stack(((apex + 1) % 3, (apex + 2) % 3), axis=1)
    rows = np.arange(len(corners))
    lengths = np.stack((sides[rows, apex], sides[rows, ends[:, 1]]), axis=1)
    order = np.argsort(-lengths, axis=1, kind="stable")
    return (np.take_along_axis(lengths, order, axis=1),
            np.column_stack((apex, np.take_along_axis(ends, order, axis=1))))


def _exponents(texels: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Sides (n, 2), as powers of two, of the cells in which legs of so many texels have room, and the gap to the other
    triangle in it where both are not halves of a `whole`."""
    gap = np.where(texels < 2.0 ** SMALLEST - 2.0 * RIM - NARROW, NARROW, DIAGONAL)
    around = texels + 2.0 * RIM + np.where(whole[:, None], 0.0, gap)
    return np.maximum(np.ceil(np.log2(around)), SMALLEST).astype(np.int64)


def _side(area: int) -> int:
    """The least power of two whose square holds so many texels."""
    side = 1
    while side * side < area:
        side *= 2
    return side


def _squares(exponents: np.ndarray, whole: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The square (n,) in which each triangle's cell lies, its place (n,) in it, two a rectangle, and the squares' sides
    as powers of two, from large to small."""
    # the longer leg comes first, and so does the longer side; before single triangles what keeps even places together
    order = np.lexsort((~whole, -exponents[:, 1], -exponents[:, 0]))
    ranked = exponents[order]
    new = np.r_[True, (ranked[1:] != ranked[:-1]).any(axis=1)] if len(ranked) else np.zeros(0, bool)
    group = np.cumsum(new) - 1
    shapes = ranked[new]
    counts = np.bincount(group, minlength=len(shapes))
    starts = np.concatenate(([0], np.cumsum(counts)))[:-1]
    held = 2 * 2 ** (shapes[:, 0] - shapes[:, 1])
    squares = -(-counts // held)
    before = np.concatenate(([0], np.cumsum(squares)))[:-1]
    index = np.arange(len(ranked)) - starts[group]
    square, place = np.empty(len(ranked), np.int64), np.empty(len(ranked), np.int64)
    square[order] = before[group] + index // held[group]
    place[order] = index % held[group]
    return square, place, np.repeat(shapes[:, 0], squares)


def _placed(exponents: np.ndarray, texels: np.ndarray, whole: np.ndarray) -> np.ndarray:
    """Where the triangles' corners lie, (n, 3, 2), in texels, first that between the legs, which are as long as
    `texels` (n, 2) where there is room."""
    square, place, sides = _squares(exponents, whole)
    area = 4 ** sides
    # each square starts where the curve has gone over the larger ones
    at = _along_z_curve(np.concatenate(([0], np.cumsum(area)))[:-1])[square].astype(np.float64)
    cell = 2.0 ** exponents
    at[:, 1] += (place // 2) * cell[:, 1]
    low = np.full((len(cell), 2), RIM)
    across, up = low.copy(), low.copy()
    gap = np.where(whole[:, None], 0.0, np.where(exponents == SMALLEST, NARROW, DIAGONAL))
    length = np.minimum(cell - 2.0 * RIM - gap, texels)
    across[:, 0] += length[:, 0]
    up[:, 1] += length[:, 1]
    spots = np.stack((low, across, up), axis=1)
    turned = (place % 2 == 1)[:, None, None]
    # half a turn about the middle of the cell, or about that of the diagonal
    ends = np.where(whole[:, None], 2.0 * RIM + length, cell)
    return np.where(turned, ends[:, None] - spots, spots) + at[:, None]


def _along_z_curve(index: np.ndarray) -> np.ndarray:
    """Column and row (n, 2) of the places that a Z curve reaches after so many steps: every other bit is one's."""
    place = np.stack((index, index >> 1), axis=1)
    for shift, mask in ((0, 0x5555555555555555), (1, 0x3333333333333333), (2, 0x0F0F0F0F0F0F0F0F),
                        (4, 0x00FF00FF00FF00FF), (8, 0x0000FFFF0000FFFF), (16, 0x00000000FFFFFFFF)):
        place = (place | (place >> shift)) & mask if shift else place & mask
    return place
