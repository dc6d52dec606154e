"""Filling: cameras that are not cut are shown by rays, the talk's holes.

Two kinds are not: those in which more lies over one another than the picture can show or the memory holds, and those
of a pixel in which outlines are bent still, as where rays cross on a caustic. They are cut along squares of less than a
pixel, and in each of them a face of the mirror shows the one triangle that the ray through the square's middle meets
first, or that through the middle of its first cell where other faces lie there. So the work is bounded by the picture:
where too many lie in the squares, these are the pixels, and all faces that lie in one share its ray.
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

LOOK = 1.0 / 8.0  # of the work for a candidate: that of looking at a pair that may become one
TESTS = 2.0  # of a cone and a triangle, to a pair
# of the work for a candidate: that of asking whether a mirror hides it, at the most and as a rule
HIDING, USUALLY = 1.0 / 4.0, 1.0 / 16.0
OVERLAPPING = 24  # of the mirrors in a camera: more hardly lie over one and the same polygon
CROSSED = 2.0 / np.pi  # half as many lines of a square grid as a line of any direction crosses in its side's length
CELLS = 4  # for each ray, where faces of the mirror may share one


class Crowds:
    """Cameras that are too crowded to be cut, collected until rays fill them.

    Parameters
    ----------
    met : SceneAndMirrors
    limits : Limits
    last : bool
        Light which meets a mirror goes no further.

    Attributes
    ----------
    dense : int, cameras in pixels in which rays are less work
    given_up : int, cameras beyond the limits
    """

    def __init__(self, met: SceneAndMirrors, limits: Limits, last: bool) -> None:
        self.met, self.limits, self.last = met, limits, last
        self._cameras: list[Cameras] = []
        self.dense = self.given_up = 0

    def __len__(self) -> int:
        return sum(map(len, self._cameras))

    def without_most(self, cameras: Cameras) -> Cameras:
        """The cameras within the limits."""
        crowd = crowded(np.ones(len(cameras)), picture_areas(cameras), self.limits.cameras)
        self._cameras.append(cameras.select(crowd))
        return cameras.select(~crowd)

    def bound(self, cameras: Cameras) -> Bound:
        """What may be looked for in the cameras; where no square is whole, rays show many cells, and all is looked
        at."""
        enough = TESTS * self.limits.dense / (LOOK * self.limits.square**2) * pixels_crossed(cameras)
        return Bound(self.limits.pairs, picture_areas(cameras), enough if _may_be_whole(cameras) else None)

    def full(self, cameras: Cameras, found: Touching) -> np.ndarray:
        """Which cameras (n,) have too much to look at in what was found."""
        self.dense += int(found.full.sum())
        looked = LOOK * np.bincount(found.cone, minlength=len(cameras))
        return found.given_up | found.full | self.dense_in(cameras, looked)

    def thinned(self, candidates: Candidates, crowd: np.ndarray) -> Candidates:
        """Candidates within the limits, without those of the cameras that `crowd` (n,) names. Each mirror among them
        may hide a part of all others in its camera."""
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
        """Which cameras (n,), of so much work each, lie in pixels in which that is more than rays would be."""
        pixel = pixels_held(cameras)
        work = np.bincount(pixel, load / pixels_crossed(cameras))
        dense = (load > 1.0) & (work[pixel] * self.limits.square**2 > self.limits.dense)
        self.dense += int(dense.sum())
        return dense

    def filled(self, candidates: Candidates) -> Filled:
        """The candidates, and behind their cameras the cells of the crowds, each with the one triangle that it shows as
        its candidate."""
        if not len(self):
            return Filled(candidates, np.zeros((0, 3), dtype=np.int64), 0, 0, False)
        # all lie on corners that the cameras have too: whoever splits cameras adds corners behind those there are
        cameras, frames = candidates.cameras, candidates.frames
        corners, face = (np.concatenate([getattr(crowd, name) for crowd in self._cameras])
                         for name in ("corners", "face"))
        crowds = replace(cameras, corners=corners, face=face)
        size = _side(crowds, self.limits)
        squares = WholeSquares.of(crowds, self.met, SquareGrid.over(crowds, size), self.last) \
            if _may_be_whole(crowds) else None
        cells, triangle, rays, corner_face = _shown(crowds, self.met, size, squares)
        if self.last:  # what shows a mirror shows nothing
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
    """Candidates behind which stand cells that rays have filled.

    Attributes
    ----------
    candidates : Candidates
    corner_face : (k, 3) int64
        Of the last k cameras, which lie in whole squares: the mirror's triangle that each of their corners lies on.
    rays : int, that were traced
    pixels : int, that they have filled with the diffuse scene
    less : bool
        Whether that is less than was asked for: more coarsely than the tolerance, or instead of all of the geometry.
    """

    candidates: Candidates
    corner_face: np.ndarray
    rays: int
    pixels: int
    less: bool


def _shown(crowds: Cameras, met: SceneAndMirrors, size: float,
           squares: WholeSquares | None) -> tuple[Cameras, np.ndarray, int, np.ndarray]:
    """Cells of crowded cameras in squares of `size` pixels, those in whole squares last, the triangle (m,) that each
    shows, how many rays were traced, and the mirror's triangles (k, 3) of the corners of the last k."""
    cells, triangle, rays = cells_and_triangles(crowds, met, size, squares)
    if squares is None:
        return cells, triangle, rays, np.zeros((0, 3), dtype=np.int64)
    cells = cells.replaced(np.concatenate((cells.corners, squares.corners + cells.places.shape[1])),
                           np.concatenate((cells.face, squares.face)), squares.places, squares.origins, squares.rays)
    return (cells, np.concatenate((triangle, squares.triangle)), rays + squares.traced,
            squares.corner_face[squares.corners])


def _may_be_whole(cameras: Cameras) -> bool:
    """Whether a few faces may show a square, whatever number of the mirror's faces lies in it."""
    return cameras.mirror_map.bounce == 1 and not isinstance(cameras.view, LampView)


def _side(cameras: Cameras, limits: Limits) -> float:
    """Of the squares through which rays fill the cameras, as many as the limits allow or a little more, in pixels."""
    most, size = limits.rays, limits.square
    # a face of the mirror lies in about as many squares as its area holds, its edges cross more, and one
    area, crossed = pixels_of(cameras).sum(), CROSSED * pixels_around_faces(cameras)
    faces = len(distinct(cameras.face)[0])
    if area / size**2 + crossed / size + faces <= most:
        return size
    # an odd number of pixels, so that the ray through a pixel's middle is one of them; faces may share them
    room, crossed = (most, 0.0) if _may_be_whole(cameras) else (max(CELLS * most - faces, most / 2), crossed)
    needed = 2.0 * area / max(np.sqrt(crossed**2 + 4.0 * area * room) - crossed, 1e-300)
    return 1.0 + 2.0 * max(0.0, np.ceil(0.5 * (needed - 1.0)))
