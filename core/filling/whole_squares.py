"""Squares of the picture that crowded cameras cover completely: a few faces each, instead of all parts of mirror faces.

Crowded cameras cover nine sample places of each such square, and the mirror is continuous between these. The corners of
a square lie on the mirror triangles that the eye sees there, and have true rays. A ray through the centre finds the
triangle that the square shows. Two faces show the square if they show its centre in the right place, else four faces
meet near its centre. No corner or side of the faces lies exactly at the centre, because engines sample pixel centres:
the vertex that four faces share is moved a little, and so are corners with whole squares all around.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras, cells_before, cells_between, places_at, true_rays
from ..culling import SceneAndMirrors
from ..geometry import SceneFrames, columns, distinct, dot, mask, norm, rows, unit
from ..result import GAP
from ..support import breathe
from ..views import Covered, View, planes
from .picture_squares import ASIDE, TOUCHING, SquareGrid
from .shown_triangles import shown_triangles

HALF = 0.5  # safety factor on the smallest offset of layers towards the eye
SINKING = 4.0  # multiple of that offset for layers with paths up to nine times as long as the eye's distance
STRAYING = 0.25  # pixels: largest deviation of the centre in squares of two faces
# lattice places of a square, as columns and rows; pairs of neighbours among them; the three places along each side
NINE = np.indices((3, 3)).reshape(2, 9)[::-1]
BESIDE = np.array([(one, one + step) for one in range(9) for step, ends in ((1, one % 3 < 2), (3, one < 6)) if ends]).T
SIDES = np.array([(0, 1, 2), (0, 3, 6), (2, 5, 8), (6, 7, 8)]).T
TWO, FOUR = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


@dataclass(frozen=True)
class WholeSquares:
    """Cameras (m) of whole squares, on c corners of their own.

    Attributes
    ----------
    grid : SquareGrid
    before : (height + 1, width + 1) int64
        Summed-area table of the finished squares.
    corners : (m, 3) int64
    face : (m,) int64, the mirror triangle that the square's centre lies on
    triangle : (m,) int64, the diffuse triangle that each camera shows
    places, origins, rays : (3, c) float64, of the corners, as in `Cameras`
    corner_face : (c,) int64, the mirror triangles that the corners lie on
    traced : int, number of rays traced
    """

    grid: SquareGrid
    before: np.ndarray
    corners: np.ndarray
    face: np.ndarray
    triangle: np.ndarray
    places: np.ndarray
    origins: np.ndarray
    rays: np.ndarray
    corner_face: np.ndarray
    traced: int

    @classmethod
    def of(cls, cameras: Cameras, met: SceneAndMirrors, grid: SquareGrid, last: bool) -> WholeSquares:
        """Find the whole squares of a grid in crowded cameras, and build their faces.

        Before the `last` bounce, squares that show a mirror are left out.
        """
        holders = Holders(cameras, grid, met.slide)
        square = holders.inner
        row, column = np.divmod(square, max(grid.size[0], 1))
        owner = holders.in_middles[row, column]
        middles = places_at(cameras.select(owner), grid.pixels(column + 0.5, row + 0.5))[0]
        place, triangle = shown_triangles(met, cameras.select(owner), middles)
        whole = np.zeros(grid.size[::-1], dtype=bool)
        whole[row, column] = last | ~mask(len(square), place[triangle >= met.diffuse])
        shown = np.flatnonzero((triangle >= 0) & (triangle < met.diffuse) & whole[row, column][place])
        place, triangle = place[shown], triangle[shown]
        row, column, owner = row[place], column[place], owner[place]
        point, corner = distinct(((row[:, None] + (0, 0, 1, 1)) * (grid.size[0] + 1)
                                  + column[:, None] + (0, 1, 1, 0)).ravel())
        holder, spots, moved = holders.corners(whole, point)
        holder = np.concatenate((holder, owner))
        spots = np.concatenate((spots, np.stack((column, row), axis=1) + 0.5 + ASIDE))
        places, face = places_at(cameras.select(holder), grid.pixels(*spots.T))[0], cameras.face[holder]
        breathe()
        origins, rays = true_rays(cameras.mirror_map, face, places)
        corner, middle = corner.reshape(-1, 4), len(point) + np.arange(len(row))
        five = np.column_stack((corner, middle))
        straying = np.sqrt(2.0) * grid.side * _straying(met, triangle, (places[:, five], rays[:, five]), cameras.view)
        straying[_sunk(places[:, five], cameras, met.slide) | ~(moved[corner[:, :2]] | moved[corner[:, 2:]]).T] = np.inf
        corners, of_square = _faces(five, straying)
        return cls(grid, cells_before(whole), corners, face[middle][of_square], triangle[of_square], places, origins,
                   rays, face, len(square))

    def holds(self, low: np.ndarray, high: np.ndarray) -> np.ndarray:
        """Return True (n,) for boxes from `low` to `high` (2, n), in pixels, that lie in finished squares."""
        width, height = self.grid.size
        first = np.floor(self.grid.spots(low) + TOUCHING)
        end = np.maximum(np.ceil(self.grid.spots(high) - TOUCHING), first + 1.0)
        inside = ((first >= 0.0) & (end <= np.array([[width], [height]]))).all(axis=0)
        first, end = (np.where(inside, bound, 0.0).astype(np.int64) for bound in (first, end))
        return inside & (cells_between(self.before, first, end) == np.prod(end - first, axis=0))


class Holders:
    """Lookup of the camera at each corner and centre of a grid's squares.

    Attributes
    ----------
    at_corners : (height + 1, width + 1) int32, the camera at each corner, -1 for none
    in_middles : (height, width) int32, the camera at each centre, -1 for none
    inner : (n,) int64
        Squares, numbered row by row, that the cameras cover with one continuous part of the mirror. All nine places lie
        in cameras, depth does not jump between neighbours, and no side bulges towards the eye.
    """

    def __init__(self, cameras: Cameras, grid: SquareGrid, slide: float) -> None:
        self.cameras, self.size, self.slide = cameras, grid.size, slide
        self._spots = grid.spots(rows(cameras.view.pixels(cameras.places.T)))[:, cameras.corners.T]
        lattice = self._at(2, np.zeros(2))
        self.inner = self._inner(lattice)
        # copy, to free the lattice, which is four times as large
        self.at_corners, self.in_middles = lattice[::2, ::2].copy(), lattice[1::2, 1::2].copy()

    def _at(self, finer: int, shift: np.ndarray) -> np.ndarray:
        """Return the camera (rows, columns) at the points of a grid `finer` times as fine, moved by `shift` (2,)."""
        width, height = finer * np.array(self.size) + 1
        spots = finer * (self._spots - shift.reshape(2, 1, 1)) + 0.5
        covered = Covered.of(spots, np.zeros(spots.shape[1:]), (width, height), False)
        owner = np.full(width * height, -1, dtype=np.int32)  # int32 to save memory: it has the picture's size
        owner[covered.pixel] = covered.face
        breathe()
        return owner.reshape(height, width)

    def _inner(self, lattice: np.ndarray) -> np.ndarray:
        held = lattice >= 0
        held = held[:, :-2:2] & held[:, 1::2] & held[:, 2::2]
        square = np.flatnonzero(held[:-2:2] & held[1::2] & held[2::2])
        row, column = np.divmod(square, max(self.size[0], 1))
        spots = np.stack((2 * column[:, None] + NINE[0], 2 * row[:, None] + NINE[1]))
        holder = lattice[spots[1], spots[0]]
        several = np.flatnonzero((holder != holder[:, :1]).any(axis=1))
        return np.delete(square, several[self._uneven(holder[several], spots[:, several])])

    def _uneven(self, holder: np.ndarray, spots: np.ndarray) -> np.ndarray:
        """Return True (n,) for squares with a depth jump or a side that bulges towards the eye.

        Depth jumps between two neighbouring places if neither camera's plane leads to the other place. Differences
        smaller than the offset of layers from the mirror do not count.

        Parameters
        ----------
        holder : (n, 9) int, camera at each place
        spots : (2, n, 9) int, column and row of each place on the lattice
        """
        view = self.cameras.view
        depth = view.depths(self.cameras.places.T)[self.cameras.corners.T]
        slope, base = planes(2.0 * self._spots, -depth if view.orthographic else 1.0 / depth)  # linear in the picture

        def near(camera: np.ndarray, spot: np.ndarray) -> np.ndarray:
            return ((columns(slope, camera.ravel()) * spot.reshape(2, -1)).sum(axis=0)
                    + columns(base, camera.ravel())).reshape(camera.shape)
        own = near(holder, spots)
        size = np.ptp(self.cameras.places, axis=1).max() if view.orthographic else own
        room = np.broadcast_to(self.slide * HALF * GAP * size, own.shape)
        first, middle, last = SIDES
        uneven = (own[:, middle] - 0.5 * (own[:, first] + own[:, last]) > SINKING * room[:, middle]).any(axis=1)
        square, pair = np.nonzero(holder[:, BESIDE[0]] != holder[:, BESIDE[1]])
        one, other = ((square, ends[pair]) for ends in BESIDE)
        here = own[one] - near(holder[other], spots[:, square, one[1]])
        there = own[other] - near(holder[one], spots[:, square, other[1]])
        leaps = (here * there < 0.0) & (np.minimum(np.abs(here), np.abs(there)) > room[one])
        uneven[square[leaps]] = True
        return uneven

    def corners(self, whole: np.ndarray, point: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Find the cameras at corners of squares.

        Parameters
        ----------
        whole : (height, width) bool, whole squares
        point : (n,) int64, corners, numbered row by row

        Returns
        -------
        holder : (n,) int, the camera at each corner
        spots : (n, 2) float64, column and row of the corner in the grid
        moved : (n,) bool, True for corners moved aside, because all squares around them are whole
        """
        aside = self._at(1, ASIDE)
        padded = np.pad(whole, 1)
        moved = padded[:-1, :-1] & padded[1:, :-1] & padded[:-1, 1:] & padded[1:, 1:] & (aside >= 0)
        holder, moved = np.where(moved, aside, self.at_corners).ravel()[point], moved.ravel()[point]
        row, column = np.divmod(point, self.size[0] + 1)
        return holder, np.stack((column, row), axis=1) + moved[:, None] * ASIDE, moved


def _straying(met: SceneAndMirrors, triangle: np.ndarray, five: tuple[np.ndarray, np.ndarray],
              view: View) -> np.ndarray:
    """Return how far (2, n) the middle of a square in the picture would be shown from its place by two faces.

    The faces have the square's corners, and share the diagonal from corner 0 to 2 (row 0) or from 1 to 3 (row 1). The
    distance is that of the point on the source, as a share of the length that the diagonal has there.

    Parameters
    ----------
    triangle : (n,) int64, triangle that each square shows
    five : tuple, places on the mirror and rays that leave them, (3, n, 5) each, at the four corners and the centre
    """
    places, rays = five
    seen, column = distinct(triangle)
    frames, column = SceneFrames.of(met, seen), np.repeat(column, 5)
    # bound the motion of a point along a diagonal by that in a flat mirror at the centre, because a point may jump from
    # one mirror triangle to the next
    ways = view.directions(places.reshape(3, -1).T).T.reshape(places.shape)
    normal = unit(unit(rays[:, :, 4]) - unit(ways[:, :, 4]))[:, :, None]
    flat = _points(met, frames, column, places, ways - 2.0 * dot(ways, normal) * normal)
    points = _points(met, frames, column, places, rays)
    motion = np.minimum.reduce([norm(some[:, :, one] - some[:, :, one + 2])
                                for some in (flat, points) for one in (0, 1)])
    away = np.stack([norm(0.5 * (points[:, :, one] + points[:, :, one + 2]) - points[:, :, 4]) for one in (0, 1)])
    return np.divide(away, motion, out=np.where(away > 0.0, np.inf, 0.0), where=motion > 0.0)


def _sunk(places: np.ndarray, cameras: Cameras, slide: float) -> np.ndarray:
    """Return True (2, n) for diagonals of squares whose chord sag behind the mirror exceeds the offset of layers.

    `places` (3, n, 5) are the four corners and the centre of each square.
    """
    view, middle = cameras.view, places[:, :, 4]
    ahead = view.directions(middle.T).T
    room = slide * HALF * GAP * (np.ptp(cameras.places, axis=1).max() if view.orthographic else dot(ahead, ahead))
    return np.stack([dot(0.5 * (places[:, :, one] + places[:, :, one + 2]) - middle, ahead) > room for one in (0, 1)])


def _points(met: SceneAndMirrors, frames: SceneFrames, column: np.ndarray, places: np.ndarray,
            rays: np.ndarray) -> np.ndarray:
    """Return the points (3, n, k) at which rays hit triangles; points outside of a triangle are moved onto it.

    `places` and `rays` (3, n, k) are starts and directions; `column` (n k,) is the frame of each.
    """
    origins, ways = places.reshape(3, -1), rays.reshape(3, -1)
    met_at = origins + np.maximum(frames.distance(column, origins, ways), 0.0) * ways
    weights = np.maximum(np.nan_to_num(frames.weights(column, met_at)), 0.0)
    weights /= np.maximum(weights.sum(axis=0), 1e-300)
    return (rows(met.positions[frames.vertices[:, column]]) * weights).sum(axis=1).reshape(places.shape)


def _faces(five: np.ndarray, straying: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Build two or four faces for each square.

    Parameters
    ----------
    five : (n, 5) int64, the four corners and the centre of each square; corners may be rotated in place
    straying : (2, n) float64, deviation for each diagonal, in pixels

    Returns
    -------
    corners : (m, 3) int64
    square : (m,) int64, the square of each face
    """
    turned = straying[1] < straying[0]
    five[turned, :4] = five[turned][:, [1, 2, 3, 0]]
    exact = straying.min(axis=0, initial=np.inf) <= STRAYING
    parts = [(np.flatnonzero(chosen), pattern) for chosen, pattern in ((exact, TWO), (~exact, FOUR))]
    return (np.concatenate([five[square][:, pattern].reshape(-1, 3) for square, pattern in parts]),
            np.concatenate([np.repeat(square, len(pattern)) for square, pattern in parts]))
