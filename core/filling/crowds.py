"""Ray-sampled fallback for cameras in which triangles are not clipped (the holes of C. Mei's talk).

Two kinds of cameras are sampled by rays. In the first kind, more triangles overlap than the picture can show or the
memory can hold. The second kind has the size of a pixel and still has curved outlines, as where rays cross on a
caustic. These cameras are cut along squares smaller than a pixel. In each square, a face of the mirror shows the one
triangle that the ray through the square's centre hits first. If other faces lie at the centre, the ray goes through the
centre of the face's first cell. So the picture bounds the work: with too many cells the squares are pixels, and all
faces in a square share one ray.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..cameras import (
    Cameras,
    covered_pixels,
    picture_areas,
    pixels_around_faces,
    pixels_crossed,
    pixels_held,
    pixels_of,
)
from ..culling import Candidates, SceneAndMirrors
from ..geometry import SceneFrames, distinct, numbered
from ..support import crowded
from ..trees import Bound, Touching
from ..views import LampView
from .limits import Limits
from .picture_squares import SquareGrid
from .square_cells import cells_and_triangles
from .whole_squares import WholeSquares

LOOK = 1.0 / 8.0  # cost of testing a pair that may become a candidate, relative to a candidate
TESTS = 2.0  # tests of a cone and a triangle per pair found
# cost of testing if one mirror hides a candidate, relative to a candidate: the largest and the usual one
HIDING, USUALLY = 1.0 / 4.0, 1.0 / 16.0
OVERLAPPING = 24  # largest number of mirrors in a camera that count: more hardly overlap the same polygon
CROSSED = 2.0 / np.pi  # half the mean number of grid lines that a line crosses per side length of the grid
CELLS = 4  # cells per ray, where faces of the mirror may share a ray


class Crowds:
    """Collection of cameras with too many triangles to clip; at the end rays sample them.

    Parameters
    ----------
    met : SceneAndMirrors
    limits : Limits
    last : bool
        True for the last bounce: rays that hit a mirror end there.

    Attributes
    ----------
    dense : int, number of cameras in pixels that cost less with rays
    given_up : int, number of cameras beyond the limits
    """

    def __init__(self, met: SceneAndMirrors, limits: Limits, last: bool) -> None:
        self.met, self.limits, self.last = met, limits, last
        self._cameras: list[Cameras] = []
        self.dense = self.given_up = 0

    def __len__(self) -> int:
        return sum(map(len, self._cameras))

    def without_most(self, cameras: Cameras) -> Cameras:
        """Collect the cameras of least picture area that exceed the limit on cameras, and return the others."""
        crowd = crowded(np.ones(len(cameras)), picture_areas(cameras), self.limits.cameras)
        self._cameras.append(cameras.select(crowd))
        return cameras.select(~crowd)

    def bound(self, cameras: Cameras) -> Bound:
        """Return the limits for the search of triangles in the cameras.

        Without whole squares there is no limit per camera, because rays then have to show many cells.
        """
        enough = TESTS * self.limits.dense / (LOOK * self.limits.square**2) * pixels_crossed(cameras)
        return Bound(self.limits.pairs, picture_areas(cameras), enough if _may_be_whole(cameras) else None)

    def full(self, cameras: Cameras, found: Touching) -> np.ndarray:
        """Return True (n,) for cameras with too many pairs in `found`."""
        self.dense += int(found.full.sum())
        looked = LOOK * np.bincount(found.cone, minlength=len(cameras))
        return found.given_up | found.full | self.dense_in(cameras, looked)

    def thinned(self, candidates: Candidates, crowd: np.ndarray) -> Candidates:
        """Collect the cameras in `crowd` (n,) bool and those beyond the limits; return the candidates of the others.

        The cost of a camera's candidates grows with its number of mirrors, each of which may hide a part of them.
        """
        cameras = candidates.cameras
        count, hiding = (np.bincount(candidates.camera, weights, len(cameras))
                         for weights in (None, self.met.are_mirrors(candidates)))
        most, load = (count * (1.0 + share * np.minimum(hiding, OVERLAPPING)) for share in (HIDING, USUALLY))
        worth = picture_areas(cameras)
        crowd = crowd | crowded(count, worth, self.limits.candidates) | crowded(most, worth, self.limits.work)
        crowd |= self.dense_in(cameras, np.where(crowd, 0.0, load))
        self._cameras.append(cameras.select(crowd))
        if crowd.any():
            candidates = candidates.on(cameras.select(~crowd), numbered(len(crowd), ~crowd))
        return candidates

    def dense_in(self, cameras: Cameras, load: np.ndarray) -> np.ndarray:
        """Return True (n,) for cameras in pixels in which clipping costs more than rays; `load` (n,) is the cost."""
        pixel = pixels_held(cameras)
        work = np.bincount(pixel, load / pixels_crossed(cameras))
        dense = (load > 1.0) & (work[pixel] * self.limits.square**2 > self.limits.dense)
        self.dense += int(dense.sum())
        return dense

    def filled(self, candidates: Candidates) -> Filled:
        """Sample the collected cameras by rays, and append their cells to the candidates.

        Each cell has one candidate: the triangle that it shows.
        """
        if not len(self):
            return Filled(candidates, np.zeros((0, 3), dtype=np.int64), 0, 0, False)
        # all collected cameras use corners of `cameras`, because splitting only appends corners
        cameras, frames = candidates.cameras, candidates.frames
        corners, face = (np.concatenate([getattr(crowd, name) for crowd in self._cameras])
                         for name in ("corners", "face"))
        crowds = replace(cameras, corners=corners, face=face)
        size = _side(crowds, self.limits)
        squares = WholeSquares.of(crowds, self.met, SquareGrid.over(crowds, size), self.last) \
            if _may_be_whole(crowds) else None
        cells, triangle, rays, corner_face = _shown(crowds, self.met, size, squares)
        if self.last:  # drop cells that show a mirror
            scene = np.flatnonzero(triangle < self.met.diffuse)
            cells, triangle = cells.select(scene), triangle[scene]
        seen = np.union1d(frames.triangle, triangle)
        frames, column = SceneFrames.of(self.met, seen), np.searchsorted(seen, frames.triangle)
        whole = replace(cells, corners=np.concatenate((cameras.corners, cells.corners)),
                        face=np.concatenate((cameras.face, cells.face)))
        pairs = Candidates.unknown(whole, frames, np.arange(len(cells)) + len(cameras), np.searchsorted(seen, triangle))
        exact = replace(candidates, cameras=whole, frames=frames, column=column[candidates.column])
        pixels = covered_pixels(cells.select(~self.met.are_mirrors(pairs)))
        less = size > self.limits.square or bool(np.isinf(self.limits.dense))
        return Filled(Candidates.joined((exact, pairs)), corner_face, rays, pixels, less)


@dataclass(frozen=True)
class Filled:
    """Candidates, followed by those of cells sampled by rays.

    Attributes
    ----------
    candidates : Candidates
    corner_face : (k, 3) int64
        For each corner of the last k cameras, which lie in whole squares: the mirror triangle that it lies on.
    rays : int, number of rays traced
    pixels : int, number of pixels that the cells fill with the diffuse scene
    less : bool
        True if this is less than requested: coarser than the tolerance, or without hidden geometry.
    """

    candidates: Candidates
    corner_face: np.ndarray
    rays: int
    pixels: int
    less: bool


def _shown(crowds: Cameras, met: SceneAndMirrors, size: float,
           squares: WholeSquares | None) -> tuple[Cameras, np.ndarray, int, np.ndarray]:
    """Cut crowded cameras into cells along squares of `size` pixels, and trace rays to find the triangle of each cell.

    Returns
    -------
    cells : Cameras, those of whole squares last
    triangle : (m,) int64, the triangle that each cell shows
    rays : int, number of rays traced
    corner_face : (k, 3) int64, mirror triangles of the corners of the last k cells, which lie in whole squares
    """
    cells, triangle, rays = cells_and_triangles(crowds, met, size, squares)
    if squares is None:
        return cells, triangle, rays, np.zeros((0, 3), dtype=np.int64)
    cells = cells.replaced(np.concatenate((cells.corners, squares.corners + cells.places.shape[1])),
                           np.concatenate((cells.face, squares.face)), squares.places, squares.origins, squares.rays)
    return (cells, np.concatenate((triangle, squares.triangle)), rays + squares.traced,
            squares.corner_face[squares.corners])


def _may_be_whole(cameras: Cameras) -> bool:
    """Return True if a square may be shown by a few faces, independent of the number of mirror faces in it."""
    return cameras.mirror_map.bounce == 1 and not isinstance(cameras.view, LampView)


def _side(cameras: Cameras, limits: Limits) -> float:
    """Return the side in pixels of the squares that rays sample, so that about as many rays as allowed are needed."""
    most, size = limits.rays, limits.square
    # a mirror face overlaps about as many squares as its area holds, plus those that its edges cross, plus one
    area, crossed = pixels_of(cameras).sum(), CROSSED * pixels_around_faces(cameras)
    faces = len(distinct(cameras.face)[0])
    if area / size**2 + crossed / size + faces <= most:
        return size
    # use an odd number of pixels, so that the ray of a square goes through a pixel centre; faces may share rays
    room, crossed = (most, 0.0) if _may_be_whole(cameras) else (max(CELLS * most - faces, most / 2), crossed)
    needed = 2.0 * area / max(np.sqrt(crossed**2 + 4.0 * area * room) - crossed, 1e-300)
    return 1.0 + 2.0 * max(0.0, np.ceil(0.5 * (needed - 1.0)))
