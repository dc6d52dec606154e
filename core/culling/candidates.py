"""Pairs of a camera and a diffuse triangle whose images may overlap, and the triangle as the camera's corners see it.

On a camera the ray Q(W) + s R(W) meets the plane of a triangle at s = a / b with a(W) = -height(Q), b(W) = the rate at
which R crosses the plane. The point, in the triangle's barycentric coordinates times b, is quadratic in W; its values
at the camera's corners are interpolated linearly, which is exact for a flat mirror. What the quadratic part adds
halfway along the camera's edges bounds the error of that.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..cameras import Cameras
from ..geometry import ColumnArrays, SceneFrames, between, columns, in_order, largest, ranges
from ..support import INSIDE


@dataclass(frozen=True)
class Candidates(ColumnArrays):
    """Pairs (p) of a camera and a triangle that the camera may see.

    The ray Q + s R of a camera's corner meets the plane of the triangle at s = a / b. Here a is minus the height of Q
    above the plane, and b is the change of height along R. Heights are perpendicular to the plane, in units of the
    scaled normals of `SceneFrames`. The sign g of a pair is +1 for rays that cross the plane in the direction of its
    normal, else -1. A camera that crosses the plane may have two pairs with the triangle, one for each sign.

    `overlapping` leaves out a pair if all rays of the camera pass outside of one side of the triangle.

    Attributes
    ----------
    cameras : Cameras
    frames : SceneFrames, of all triangles that some camera may see
    camera : (p,) int64, index of the camera
    column : (p,) int64, the triangle's column in the frames
    sides : (3, 3, p) float64
        Entry [j, i]: barycentric coordinate j of the point at which the ray of camera corner i meets the plane, times
        g b. Positive inside of the triangle's side j, which is opposite to its vertex j.
    ahead : (3, p) float64
        g a: the distance of the ray's origin at corner i from the plane, as a height. Positive if the origin lies on
        the side from which the rays of the pair cross the plane.
    bend : (3, 3, p) float64
        Entry [j, k]: what `sides` j would be for the interpolated ray halfway along the camera's edge from corner k to
        the next, minus the mean of its values at both corners.
    outlines : (3, p) bool
        True for sides of the triangle that may bound its visible part. False for sides outside of the camera, and for
        sides across which a mirror continues.
    """

    cameras: Cameras
    frames: SceneFrames
    camera: np.ndarray
    column: np.ndarray
    sides: np.ndarray
    ahead: np.ndarray
    bend: np.ndarray
    outlines: np.ndarray

    @staticmethod
    def unknown(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> Candidates:
        """Return pairs (n,) without clipping data: the camera sees the triangle, and clipping leaves it whole."""
        count = len(camera)
        return Candidates(cameras, frames, camera, column, np.zeros((3, 3, count)), np.ones((3, count)),
                          np.zeros((3, 3, count)), np.ones((3, count), dtype=bool))

    def on(self, cameras: Cameras, now: np.ndarray) -> Candidates:
        """Return the pairs on other `cameras`; `now` (n,) is the new index of each old camera, -1 if it was dropped."""
        kept = self.select(now[self.camera] >= 0)
        return replace(kept, cameras=cameras, camera=now[kept.camera])

    @cached_property
    def rate(self) -> np.ndarray:
        """b at the cameras' corners, (3, p)."""
        return self.sides.sum(axis=0)

    @cached_property
    def room(self) -> np.ndarray:
        """Bound (3, p) on the quadratic part of `sides` j anywhere in the camera."""
        return _room(self.bend)


def overlapping(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> Candidates:
    """Return the pairs among (camera, column), (p,) each, that may overlap; all their sides count as outlines.

    A pair whose camera crosses the triangle's plane is returned twice, once for each side of the plane.
    """
    corners = cameras.corners[camera].T
    x, y, z = frames.coordinates(column, columns(cameras.origins, corners))
    u, v, w = frames.directions(column, columns(cameras.rays, corners))
    sides, bend = np.empty((3, *z.shape)), np.empty((3, *z.shape))
    np.subtract(w * x, z * u, out=sides[0])
    np.subtract(w * y, z * v, out=sides[1])
    np.subtract(w - sides[0], sides[1], out=sides[2])
    dx, dy, dz, du, dv, dw = (row - row[[1, 2, 0]] for row in (x, y, z, u, v, w))
    np.subtract(dz * du, dw * dx, out=bend[0])
    np.subtract(dz * dv, dw * dy, out=bend[1])
    np.negative(bend[0] + bend[1], out=bend[2])
    bend *= 0.25
    room = _room(bend)
    kept = []
    for sign in (1.0, -1.0):
        seen = (largest(-sign * z) > 0.0) & (largest(sign * w) > 0.0)
        for j in range(3):
            seen &= largest(sign * sides[j]) + room[j] > 0.0
        chosen = np.flatnonzero(seen)
        kept.append((camera[chosen], column[chosen], sign * columns(sides, chosen), -sign * columns(z, chosen),
                     sign * columns(bend, chosen), np.ones((3, len(chosen)), dtype=bool)))
    return Candidates(cameras, frames, *(np.concatenate(side, axis=-1) for side in zip(*kept)))


def inherited(camera: np.ndarray, column: np.ndarray, parent: np.ndarray,
              child: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Pair the cameras `child` (k,) with the triangles of their `parent` cameras (k,).

    `camera` and `column` (p,) are the pairs of the parents. Return cameras and columns of the new pairs without
    duplicates: a camera that crosses a triangle's plane is listed twice.
    """
    order = in_order(camera)
    entry, run = ranges(*between(camera[order], parent, parent))
    count = max(int(column.max(initial=0)) + 1, 1)
    pairs = np.unique(child[run] * count + column[order[entry]])
    return pairs // count, pairs % count


def _room(bend: np.ndarray) -> np.ndarray:
    return INSIDE * np.stack([largest(row) for row in np.abs(bend)])
