"""Conservative overlap and occlusion tests of pairs of a camera and a triangle, by bounds, before exact clipping.

In a camera the image of a triangle's side is a quadratic curve. A bound on its quadratic term limits where the side
may lie; pairs that do not overlap even then are dropped. Triangles that mirrors hide from the whole of a camera are
dropped too. A camera that sees a mirror, and none of its outlines, sees only mirrors: it hides everything farther
than all of them. Everything farther than one mirror triangle that fills the camera is hidden as well.
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
TOUCHING = 1e-5  # share of a camera's depth below a triangle's plane: one that rises less above it only touches it
FARTHER = 1e-9  # share of the distance: a triangle that is farther by less is not hidden


@dataclass(frozen=True)
class Overlaps(ColumnArrays):
    """Candidates (p) that overlap when each side moves out by all that its quadratic part may add.

    Attributes
    ----------
    candidates : Candidates, their outlines are the sides that bound the overlap
    mirror : (p,) bool, True for triangles of mirrors
    ends : (p,) bool
        True for mirror triangles that may end inside the camera: at an outline, or where they cross the camera's own.
    """

    candidates: Candidates
    mirror: np.ndarray
    ends: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, frames: SceneFrames, pairs: tuple[np.ndarray, np.ndarray],
           met: SceneAndMirrors) -> Overlaps:
        """Return the overlaps among `pairs`: cameras (k,) and columns (k,) of the `frames`."""
        camera, column = pairs
        return cls.joined([_overlaps(overlapping(cameras, frames, camera[part], column[part]), met)
                           for part in portions(max(len(camera), 1), PAIRS_AT_ONCE)])

    def in_sight(self, last: bool) -> Candidates:
        """Return the candidates (pairs of a camera and a triangle) but for those that mirrors certainly hide whole.

        At the `last` bounce nothing is seen in mirror triangles, so they are kept only if they may hide other
        candidates of their camera.
        """
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
        """Return the distance (n,) behind which mirrors hide everything from each camera, infinite if they may not.

        `far` (p,) are the largest distances of the candidates.
        """
        mirrors, far, count = self.candidates.select(self.mirror), far[self.mirror], len(self.candidates.cameras)
        fills, middle = smallest(mirrors.ahead) >= 0.0, np.ones(len(mirrors), dtype=bool)
        for side, room in zip(mirrors.sides, mirrors.room):
            fills &= smallest(side) > room
            middle &= side.sum(axis=0) > 0.0
        nearest, farthest = np.full(count, np.inf), np.full(count, -np.inf)
        np.minimum.at(nearest, mirrors.camera[fills], far[fills])
        np.maximum.at(farthest, mirrors.camera, far)
        # if no mirror ends in a camera, a mirror at its middle fills it
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
        # straight sides have no room: the overlap may end exactly on one
        ends[some] |= outlines[:, some].any(axis=0)
    return Overlaps(replace(candidates, outlines=outlines), mirror, ends)


def _risen(candidates: Candidates) -> np.ndarray:
    """Return indices (k,) of candidates whose camera rises above the triangle's plane by more than rounding.

    Beside the line in which the scene cuts through the mirror a camera would see a part without width, whose outline
    may be another image.
    """
    return np.flatnonzero(largest(candidates.ahead) > -TOUCHING * smallest(candidates.ahead))


def _depths(candidates: Candidates) -> tuple[np.ndarray, np.ndarray]:
    """Return the least and the largest s (p,) at which rays of the cameras may meet the triangles' planes.

    A quotient of functions that are linear in the weights lies between its values at the corners.
    """
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        s = np.where(candidates.rate > 0.0, candidates.ahead / candidates.rate, np.inf)
    return np.where(smallest(candidates.ahead) < 0.0, 0.0, smallest(s)), largest(s)
