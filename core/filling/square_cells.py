"""Cells: the parts of crowded cameras in squares of the picture that they do not cover whole.

All cells of a square show the triangle that one ray meets. The cell that holds the square's middle has a corner there,
a little aside, so that what the pixel shows is in its place.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, pixels_of, places_at, true_rays, with_pieces
from ..culling import SceneAndMirrors
from ..geometry import between, groups, mask, ranges
from .picture_squares import ASIDE, first_side, in_squares
from .shown_triangles import shown_triangles
from .whole_squares import WholeSquares

SMALLEST = 1e-9  # square pixels: smaller cells are nothing


def cells_and_triangles(cameras: Cameras, met: SceneAndMirrors, size: float,
                        squares: WholeSquares | None) -> tuple[Cameras, np.ndarray, int]:
    """Cells of crowded cameras, in those squares of `size` pixels that are not whole, that show something, the triangle
    (m,) that each shows, and how many rays were traced for it. A cell comes once for each triangle that it shows."""
    cells, square, places = _cells(cameras, size, squares)
    # a square may begin before the picture, where it has the number -1
    first, group = groups(*(square - square.min(axis=1, keepdims=True, initial=0)))
    place, triangle = shown_triangles(met, cells.select(first), places[:, first])
    middles = first_side(size) + (square[:, first].T + 0.5 + ASIDE) * size
    cells, cell = _round_middles(cells, first, middles)
    pair, shown = ranges(*between(place, group[cell], group[cell]))
    seen = triangle[pair] >= 0
    return cells.select(shown[seen]), triangle[pair[seen]], len(first)


def _round_middles(cells: Cameras, some: np.ndarray, spots: np.ndarray) -> tuple[Cameras, np.ndarray]:
    """The cells, those of `some` (n,) that hold spots (n, 2) of the picture as three round these, which have true rays;
    and the cell that each was. Where rays at a cell's corners miss what the square shows, its corners show the nearest
    of this, and the cell between them another place of it than the ray in its middle."""
    places, holds = places_at(cells.select(some), spots)
    some, places = some[holds], places[:, holds]
    rest = ~mask(len(cells), some)
    cell, own = np.append(np.flatnonzero(rest), np.tile(some, 3)), cells.corners[some]
    middle = cells.places.shape[1] + np.arange(len(some))
    round_it = [np.column_stack((own[:, start], own[:, end], middle)) for start, end in ((0, 1), (1, 2), (2, 0))]
    return cells.replaced(np.concatenate((cells.corners[rest], *round_it)), cells.face[cell], places,
                          *true_rays(cells.mirror_map, cells.face[some], places)), cell


def _cells(cameras: Cameras, size: float,
           squares: WholeSquares | None) -> tuple[Cameras, np.ndarray, np.ndarray]:
    """The parts of the cameras in squares of `size` pixels of the picture, in which square (2, n) each lies, and places
    (3, n) to look at: where the middle of the square is seen, and those first, the nearest ahead; else their own
    middles."""
    view = cameras.view
    parent, weights = in_squares(cameras, size, None if squares is None else squares.holds).triangles(0.0)
    cells = with_pieces(cameras, np.zeros(len(cameras), dtype=bool), parent, weights)
    cells = cells.select(pixels_of(cells) > SMALLEST)
    square = np.floor((view.pixels(cells.places.T)[cells.corners].mean(axis=1) - first_side(size)) / size)
    places, holds = places_at(cells, first_side(size) + (square + 0.5) * size)
    places = np.where(holds, places, cells.places[:, cells.corners].mean(axis=2))
    order = np.lexsort((view.depths(places.T), ~holds))
    return cells.select(order), square[order].T.astype(np.int64), places[:, order]
