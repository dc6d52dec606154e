"""Squares of the picture that lie in crowds whole: a few faces each, not all parts of the mirror's triangles there.

The crowds hold nine places of each, and the mirror is even between these. Their corners lie on whatever triangles
of the mirror the eye sees there and have true rays. A ray through the middle tells what such a square shows. Two faces
do where they show the middle in its place, else four lie round it. None of their corners and sides lies in the middle
itself, where pixels are looked at: what four have in common is a little aside, and so are the corners that whole
squares lie round.
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

HALF = 0.5  # of what layers slide at least, to be on the safe side
SINKING = 4.0  # times that, what layers slide whose ways are no longer than nine times the eye's
STRAYING = 0.25  # pixels: what the middle may be shown beside its place by
# places of a square on the lattice, columns and rows; which of them are side by side; and those along a side
NINE = np.indices((3, 3)).reshape(2, 9)[::-1]
BESIDE = np.array([(one, one + step) for one in range(9) for step, ends in ((1, one % 3 < 2), (3, one < 6)) if ends]).T
SIDES = np.array([(0, 1, 2), (0, 3, 6), (2, 5, 8), (6, 7, 8)]).T
TWO, FOUR = np.array([[0, 1, 2], [0, 2, 3]]), np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])


@dataclass(frozen=True)
class WholeSquares:
    """Cameras (m) in squares, on corners (c) of their own.

    Attributes
    ----------
    grid : SquareGrid
    before : (height + 1, width + 1) int64
        How many squares in which nothing more is to be shown lie before each row and column.
    corners : (m, 3) int64
    face : (m,) int64, the mirror's triangle that the square's middle lies on
    triangle : (m,) int64, the diffuse triangle that they show
    places, origins, rays : (3, c) float64
    corner_face : (c,) int64, the mirror's triangles that the corners lie on
    traced : int, rays
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
        """Squares of a grid in crowded cameras. Where light goes on, at no `last` bounce, those that show a mirror are
        left out."""
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
        """Whether boxes from `low` to `high` (2, n) of the picture lie in whole squares."""
        width, height = self.grid.size
        first = np.floor(self.grid.spots(low) + TOUCHING)
        end = np.maximum(np.ceil(self.grid.spots(high) - TOUCHING), first + 1.0)
        inside = ((first >= 0.0) & (end <= np.array([[width], [height]]))).all(axis=0)
        first, end = (np.where(inside, bound, 0.0).astype(np.int64) for bound in (first, end))
        return inside & (cells_between(self.before, first, end) == np.prod(end - first, axis=0))


class Holders:
    """Which cameras hold what of a grid.

    Attributes
    ----------
    at_corners : (height + 1, width + 1) int32, the camera at the corners of the squares, -1 where there is none
    in_middles : (height, width) int32, that in their middles
    inner : (n,) int64
        The squares, row after row, that the cameras cover, all over one part of the mirror: nine places of each lie in
        cameras, between those side by side the mirror does not leap, and it does not rise at the sides.
    """

    def __init__(self, cameras: Cameras, grid: SquareGrid, slide: float) -> None:
        self.cameras, self.size, self.slide = cameras, grid.size, slide
        self._spots = grid.spots(rows(cameras.view.pixels(cameras.places.T)))[:, cameras.corners.T]
        lattice = self._at(2, np.zeros(2))
        self.inner = self._inner(lattice)
        # copies: the lattice is four times as large
        self.at_corners, self.in_middles = lattice[::2, ::2].copy(), lattice[1::2, 1::2].copy()

    def _at(self, finer: int, shift: np.ndarray) -> np.ndarray:
        """The camera at the columns and rows of a grid that is so many times `finer`, and a `shift` (2,) from there."""
        width, height = finer * np.array(self.size) + 1
        spots = finer * (self._spots - shift.reshape(2, 1, 1)) + 0.5
        covered = Covered.of(spots, np.zeros(spots.shape[1:]), (width, height), False)
        owner = np.full(width * height, -1, dtype=np.int32)  # of a picture's size: half of what int64 takes
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
        """Whether of squares with nine `spots` (2, n, 9) of the lattice in the cameras `holder` (n, 9) two side by side
        lie at depths that these cameras' planes do not lead to, or the middle of a side before its ends: by as much as
        faces surely slide before the mirror."""
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
        """The cameras (n,) at corners `point` (n,) of squares, the spots (n, 2) at which they hold them, and which of
        these lie aside, since all squares round them are `whole` (height, width)."""
        aside = self._at(1, ASIDE)
        padded = np.pad(whole, 1)
        moved = padded[:-1, :-1] & padded[1:, :-1] & padded[:-1, 1:] & padded[1:, 1:] & (aside >= 0)
        holder, moved = np.where(moved, aside, self.at_corners).ravel()[point], moved.ravel()[point]
        row, column = np.divmod(point, self.size[0] + 1)
        return holder, np.stack((column, row), axis=1) + moved[:, None] * ASIDE, moved


def _straying(met: SceneAndMirrors, triangle: np.ndarray, five: tuple[np.ndarray, np.ndarray],
              view: View) -> np.ndarray:
    """(2, n): by what part of a diagonal the middle of a square is shown beside its place by faces on either side of
    the first diagonal, and of the second; of squares with places and rays (3, n, 5) at corners and in the middle."""
    places, rays = five
    seen, column = distinct(triangle)
    frames, column = SceneFrames.of(met, seen), np.repeat(column, 5)
    # a diagonal moves a point by as much as in a flat mirror at the middle, or less: from one triangle of the mirror to
    # the next a point may leap
    ways = view.directions(places.reshape(3, -1).T).T.reshape(places.shape)
    normal = unit(unit(rays[:, :, 4]) - unit(ways[:, :, 4]))[:, :, None]
    flat = _points(met, frames, column, places, ways - 2.0 * dot(ways, normal) * normal)
    points = _points(met, frames, column, places, rays)
    motion = np.minimum.reduce([norm(some[:, :, one] - some[:, :, one + 2])
                                for some in (flat, points) for one in (0, 1)])
    away = np.stack([norm(0.5 * (points[:, :, one] + points[:, :, one + 2]) - points[:, :, 4]) for one in (0, 1)])
    return np.divide(away, motion, out=np.where(away > 0.0, np.inf, 0.0), where=motion > 0.0)


def _sunk(places: np.ndarray, cameras: Cameras, slide: float) -> np.ndarray:
    """(2, n): whether the middle of a diagonal of squares, with corners and a middle at (3, n, 5) places, lies deeper
    behind the mirror than layers surely slide before it."""
    view, middle = cameras.view, places[:, :, 4]
    ahead = view.directions(middle.T).T
    room = slide * HALF * GAP * (np.ptp(cameras.places, axis=1).max() if view.orthographic else dot(ahead, ahead))
    return np.stack([dot(0.5 * (places[:, :, one] + places[:, :, one + 2]) - middle, ahead) > room for one in (0, 1)])


def _points(met: SceneAndMirrors, frames: SceneFrames, column: np.ndarray, places: np.ndarray,
            rays: np.ndarray) -> np.ndarray:
    """The points (3, n, k) at which rays (3, n, k) meet triangles; what lies beside one is drawn onto it, as corners of
    faces are."""
    origins, ways = places.reshape(3, -1), rays.reshape(3, -1)
    met_at = origins + np.maximum(frames.distance(column, origins, ways), 0.0) * ways
    weights = np.maximum(np.nan_to_num(frames.weights(column, met_at)), 0.0)
    weights /= np.maximum(weights.sum(axis=0), 1e-300)
    return (rows(met.positions[frames.vertices[:, column]]) * weights).sum(axis=1).reshape(places.shape)


def _faces(five: np.ndarray, straying: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Corners (m, 3) of the faces of squares with so many corners and a middle, `five` (n, 5), and the square of
    each."""
    turned = straying[1] < straying[0]
    five[turned, :4] = five[turned][:, [1, 2, 3, 0]]
    exact = straying.min(axis=0, initial=np.inf) <= STRAYING
    parts = [(np.flatnonzero(chosen), pattern) for chosen, pattern in ((exact, TWO), (~exact, FOUR))]
    return (np.concatenate([five[square][:, pattern].reshape(-1, 3) for square, pattern in parts]),
            np.concatenate([np.repeat(square, len(pattern)) for square, pattern in parts]))
