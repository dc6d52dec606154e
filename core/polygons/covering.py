"""What cameras see of triangles, told from bounds before anything is cut exactly.

A triangle's sides may lie wherever the bounds on their quadratic parts let them; pairs that do not overlap even then
are dropped. So is what mirrors hide from the whole of a camera. One that sees a mirror and may hold none of its
outlines sees nothing but mirrors: what lies farther than all of them is hidden. So is what lies farther than one
triangle of a mirror that fills the camera.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..cameras import Cameras
from ..culling import Candidates, SceneAndMirrors, overlapping
from ..geometry import ColumnArrays, SceneFrames, dot, largest, mask, smallest
from ..support import portions
from .clipping import clip
from .convex_polygons import Line, scene_edges

PAIRS_AT_ONCE = 16384  # fit the cache
TOUCHING = 1e-5  # of what a camera reaches below a triangle's plane: what rises less above only touches it
FARTHER = 1e-9  # of the distance: what is farther by less is not hidden


@dataclass(frozen=True)
class Overlaps(ColumnArrays):
    """Candidates (p) that overlap when each side moves out by all that its quadratic part may add.

    Attributes
    ----------
    candidates : Candidates, their outlines are those that bound the overlap
    mirror : (p,) bool, triangles of mirrors
    ends : (p,) bool
        Of these, those of which an outline, or the line in which they pass through the camera's own, may lie in it.
    """

    candidates: Candidates
    mirror: np.ndarray
    ends: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, frames: SceneFrames, pairs: tuple[np.ndarray, np.ndarray],
           met: SceneAndMirrors) -> Overlaps:
        """The overlaps among pairs of a camera and a column of the frames."""
        camera, column = pairs
        return cls.joined([_overlaps(overlapping(cameras, frames, camera[part], column[part]), met)
                           for part in portions(max(len(camera), 1), PAIRS_AT_ONCE)])

    def in_sight(self, last: bool) -> Candidates:
        """Those that mirrors do not surely hide from the whole of their camera, and of the mirrors, at the `last`
        bounce, those alone that may hide something."""
        count = len(self.candidates.cameras)
        asked = np.flatnonzero(mask(count, self.candidates.camera[self.mirror])[self.candidates.camera])
        if not len(asked):
            return self.candidates
        seen = self.select(asked)
        camera, mirror, (near, far) = seen.candidates.camera, seen.mirror, _depths(seen.candidates)
        kept = near <= seen._covered(far)[camera] * (1.0 + FARTHER)
        if last:
            shown = kept & ~mirror
            farthest = np.full(count, -np.inf)
            np.maximum.at(farthest, camera[shown], far[shown])
            kept &= ~mirror | (near <= farthest[camera])
        in_sight = np.ones(len(self.mirror), dtype=bool)
        in_sight[asked] = kept
        return self.candidates.select(in_sight)

    def _covered(self, far: np.ndarray) -> np.ndarray:
        """(n,): the distance behind which mirrors hide all of each camera, infinite where they may leave something."""
        mirrors, far, count = self.candidates.select(self.mirror), far[self.mirror], len(self.candidates.cameras)
        fills, middle = smallest(mirrors.ahead) >= 0.0, np.ones(len(mirrors), dtype=bool)
        for side, room in zip(mirrors.sides, mirrors.room):
            fills &= smallest(side) > room
            middle &= side.sum(axis=0) > 0.0
        nearest, farthest = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(nearest, mirrors.camera[fills], far[fills])
        np.maximum.at(farthest, mirrors.camera, far)
        # where no mirror ends, what the middle meets goes on all over the camera
        closed = mask(count, mirrors.camera[middle])
        closed[mirrors.camera[self.ends[self.mirror]]] = False
        return np.where(closed, np.minimum(nearest, farthest), nearest)


def _overlaps(candidates: Candidates, met: SceneAndMirrors) -> Overlaps:
    candidates = candidates.select(_risen(candidates))
    wide = clip(replace(candidates, sides=candidates.sides + candidates.room[:, None]))
    candidates = candidates.select(wide.pair)
    scene = scene_edges(wide.after)
    outlines, ends = np.zeros((3, len(wide)), dtype=bool), np.zeros(len(wide), dtype=bool)
    outlines[wide.after[scene] - Line.SCENE_EDGE, wide.polygon[scene]] = True
    mirror = met.are_mirrors(candidates)
    some = np.flatnonzero(mirror)
    if len(some):
        own, wide = candidates.select(some), wide.select(some)
        inner = met.inner_sides(own)
        outlines[:, some] &= ~inner
        ends[some] = smallest(own.ahead) < 0.0
        for side, room, goes_on in zip(own.sides, own.room, inner):
            value = dot(np.repeat(side, wide.size, axis=1), wide.weights)
            ends[some] |= (np.minimum.reduceat(value, wide.start[:-1]) < room) & ~goes_on
        # where sides are straight, without room, the overlap may end on one to the last bit
        ends[some] |= outlines[:, some].any(axis=0)
    return Overlaps(replace(candidates, outlines=outlines), mirror, ends)


def _risen(candidates: Candidates) -> np.ndarray:
    """Those (k,) whose camera rises above the triangle's plane, and not by rounding alone, as beside the line in which
    a scene cuts through the mirror: what it would see there has no width, but its outline may have another image."""
    return np.flatnonzero(largest(candidates.ahead) > -TOUCHING * smallest(candidates.ahead))


def _depths(candidates: Candidates) -> tuple[np.ndarray, np.ndarray]:
    """The least and the largest s (p,) at which rays of the cameras may meet the triangles: quotients of functions that
    are linear in the weights lie between those at the corners."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        s = np.where(candidates.rate > 0.0, candidates.ahead / candidates.rate, np.inf)
    return np.where(smallest(candidates.ahead) < 0.0, 0.0, smallest(s)), largest(s)
