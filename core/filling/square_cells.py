"""Cells: the parts of crowded cameras in squares of the picture that they cover only partly.

All cells of a square show the triangle that one ray hits. The cell that holds the square's centre gets a corner there,
moved a little, so that the pixel shows the right point.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, pixels_of, places_at, true_rays, with_pieces
from ..culling import SceneAndMirrors
from ..geometry import between, groups, mask, ranges
from .picture_squares import ASIDE, first_side, in_squares
from .shown_triangles import shown_triangles
from .whole_squares import WholeSquares

SMALLEST = 1e-9  # square pixels: smaller cells are dropped


def cells_and_triangles(cameras: Cameras, met: SceneAndMirrors, size: float,
                        squares: WholeSquares | None) -> tuple[Cameras, np.ndarray, int]:
    """Cut crowded cameras into cells along squares of `size` pixels, except in whole squares, and find their triangles.

    A cell is returned once for each triangle that it shows.

    Returns
    -------
    cells : Cameras
    triangle : (m,) int64, the triangle that each cell shows
    rays : int, number of rays traced
    """
    cells, square, places = _cells(cameras, size, squares)
    # squares at the picture's border may have the number -1
    first, group = groups(*(square - square.min(axis=1, keepdims=True, initial=0)))
    place, triangle = shown_triangles(met, cells.select(first), places[:, first])
    middles = first_side(size) + (square[:, first].T + 0.5 + ASIDE) * size
    cells, cell = _round_middles(cells, first, middles)
    pair, shown = ranges(*between(place, group[cell], group[cell]))
    seen = triangle[pair] >= 0
    return cells.select(shown[seen]), triangle[pair[seen]], len(first)


def _round_middles(cells: Cameras, some: np.ndarray, spots: np.ndarray) -> tuple[Cameras, np.ndarray]:
    """Divide cells that hold the centre of their square into three cells around it; the new corners have true rays.

    Without this, a cell whose corner rays miss the triangle would show its centre at a wrong place, because these
    corners are moved to the triangle's border.

    Parameters
    ----------
    some : (n,) int64, cells
    spots : (n, 2) float64, centres of their squares, in pixels

    Returns
    -------
    cells : Cameras
    cell : (m,) int64, the old cell of each new one
    """
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
    """Cut cameras along squares of `size` pixels, except in whole squares.

    Cells that hold the centre of their square come first, the nearest before others.

    Returns
    -------
    cells : Cameras
    square : (2, n) int64, column and row of each cell's square
    places : (3, n) float64
        Place on each cell through which a ray may be traced: the square's centre, or else the cell's own centroid.
    """
    view = cameras.view
    parent, weights = in_squares(cameras, size, None if squares is None else squares.holds).triangles(0.0)
    cells = with_pieces(cameras, np.zeros(len(cameras), dtype=bool), parent, weights)
    cells = cells.select(pixels_of(cells) > SMALLEST)
    square = np.floor((view.pixels(cells.places.T)[cells.corners].mean(axis=1) - first_side(size)) / size)
    places, holds = places_at(cells, first_side(size) + (square + 0.5) * size)
    places = np.where(holds, places, cells.places[:, cells.corners].mean(axis=2))
    order = np.lexsort((view.depths(places.T), ~holds))
    return cells.select(order), square[order].T.astype(np.int64), places[:, order]
