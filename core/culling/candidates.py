"""Pairs of a camera and a diffuse triangle whose images may overlap, and the triangle as the camera's corners see it.

On a camera the ray Q(W) + s R(W) meets the plane of a triangle at s = a / b with a(W) = -height(Q), b(W) = the rate at
which R crosses the plane. The point, in the triangle's barycentric coordinates times b, is quadratic in W; its values
at the camera's corners are interpolated linearly, which is exact for a flat mirror. What the quadratic part adds
halfway along the camera's edges bounds the error of that.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..cameras import Cameras
from ..geometry import SceneFrames
from ..support import breathe

PAIRS_AT_ONCE = 65536
PER_PAIR = ("camera", "column", "sides", "ahead", "bend")


@dataclass(frozen=True)
class Candidates:
    """Pairs (p) that survive: at some corner of the camera each edge of the triangle is on the right side.

    Attributes
    ----------
    cameras : Cameras
    frames : SceneFrames
        Of all triangles that some camera may see.
    camera : (p,) int64
    column : (p,) int64, the triangle's column in the frames
    sides : (3, 3, p) float64, entry [j, i]: barycentric coordinate j, times b and the sign of b, at camera corner i
    ahead : (3, p) float64, the distance a from corner i to the plane, positive on the side that the rays leave
    bend : (3, 3, p) float64, entry [j, k]: what the quadratic part adds to `sides` j halfway along the camera's edge
        from corner k to the next
    """

    cameras: Cameras
    frames: SceneFrames
    camera: np.ndarray
    column: np.ndarray
    sides: np.ndarray
    ahead: np.ndarray
    bend: np.ndarray

    def __len__(self) -> int:
        return len(self.camera)

    def select(self, chosen: np.ndarray | slice) -> Candidates:
        return replace(self, **{name: getattr(self, name)[..., chosen] for name in PER_PAIR})

    @staticmethod
    def joined(parts: Sequence[Candidates]) -> Candidates:
        """All pairs of the parts, which have the same cameras and frames."""
        return replace(parts[0], **{name: np.concatenate([getattr(part, name) for part in parts], axis=-1)
                                    for name in PER_PAIR})

    @staticmethod
    def unknown(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> Candidates:
        """Pairs (n,) of which nothing is known but that the camera shows the triangle, and clipping leaves it whole."""
        count = len(camera)
        return Candidates(cameras, frames, camera, column, np.zeros((3, 3, count)), np.ones((3, count)),
                          np.zeros((3, 3, count)))

    def on(self, cameras: Cameras, now: np.ndarray) -> Candidates:
        """The pairs on other `cameras`, of which `now` (n,) tells the numbers of ours, -1 for those that are gone."""
        kept = self.select(now[self.camera] >= 0)
        return replace(kept, cameras=cameras, camera=now[kept.camera])

    @cached_property
    def rate(self) -> np.ndarray:
        """(3, p): b at the cameras' corners."""
        return self.sides.sum(axis=0)

    @property
    def room(self) -> np.ndarray:
        """(3, p): no more than this does the quadratic part add to `sides` j anywhere in the camera."""
        return 4.0 / 3.0 * np.abs(self.bend).max(axis=1)


def overlapping(cameras: Cameras, frames: SceneFrames, camera: np.ndarray, column: np.ndarray) -> Candidates:
    """The pairs among (camera, column) that may overlap.

    A pair whose camera lies across the triangle's plane comes twice, once for each side of it.
    """
    parts = []
    for start in range(0, max(len(camera), 1), PAIRS_AT_ONCE):
        breathe()
        part = slice(start, start + PAIRS_AT_ONCE)
        parts.append(_overlapping(cameras, frames, camera[part], column[part]))
    return Candidates(cameras, frames, *(np.concatenate(side, axis=-1) for side in zip(*parts)))


def _overlapping(cameras, frames, camera, column):
    corners = cameras.corners[camera].T
    x, y, z = frames.coordinates(column, np.take(cameras.origins, corners, axis=1))
    u, v, w = frames.directions(column, np.take(cameras.rays, corners, axis=1))
    first, second = w * x - z * u, w * y - z * v
    sides = np.stack((first, second, w - first - second))
    dx, dy, dz, du, dv, dw = (row - np.roll(row, -1, axis=0) for row in (x, y, z, u, v, w))
    bend = -0.25 * np.stack((dw * dx - dz * du, dw * dy - dz * dv))
    bend = np.concatenate((bend, -bend.sum(axis=0, keepdims=True)))
    room = 4.0 / 3.0 * np.abs(bend).max(axis=1)
    kept = []
    for sign in (1.0, -1.0):
        ahead = ((-sign * z).max(axis=0) > 0.0) & ((sign * w).max(axis=0) > 0.0)
        chosen = np.flatnonzero(((sign * sides).max(axis=1) + room > 0.0).all(axis=0) & ahead)
        kept.append((camera[chosen], column[chosen], sign * sides[:, :, chosen], -sign * z[:, chosen],
                     sign * bend[:, :, chosen]))
    return tuple(np.concatenate(side, axis=-1) for side in zip(*kept))
