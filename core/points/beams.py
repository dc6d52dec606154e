"""Beams of cameras: a close test of points against the three rays, before the cubic is solved.

Across a plane at a point's height above the camera the corner rays mark a triangle. With all rays rising, a point
Q(W) + s R(W) at that height has s between the s_i at which the corner rays reach it, and lies no farther from the
place sum W_i (V_i + s_i R_i) in the triangle than the spread of the s_i times the largest part of a ray across: a
point farther outside is not in the beam.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import across, dot, norm
from ..trees import Cones

ROUNDING = 1e-9  # of what a point's distance is measured in


@dataclass(frozen=True)
class Beams:
    """Beams (n) in frames of their own: two directions across, and the cone's axis.

    Attributes
    ----------
    frame : (4, 3, n) float64, the middle of the camera, and the frame's three directions
    places, rays : (3, 3, n) float64, entry [k, i]: component k of corner i in the frame
    across : (n,) float64, the largest part of a ray across the axis
    size : (n,) float64, radius of the camera
    """

    frame: np.ndarray
    places: np.ndarray
    rays: np.ndarray
    across: np.ndarray
    size: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, cones: Cones) -> Beams:
        axis = cones.axis
        frame = np.stack((cones.centre, *across(axis), axis))
        corners = cameras.corners.T
        places = np.take(cameras.places, corners, axis=1) - cones.centre[:, None]
        rays = np.take(cameras.rays, corners, axis=1)
        places, rays = (np.stack([dot(way[:, None], part) for way in frame[1:]]) for part in (places, rays))
        return cls(frame, places, rays, np.hypot(rays[0], rays[1]).max(axis=0), cones.radius)

    def hold(self, camera: np.ndarray, points: np.ndarray) -> np.ndarray:
        """Whether the beams `camera` (n,) may hold `points` (3, n); never a false no."""
        middle, *ways = (np.take(part, camera, axis=1) for part in self.frame)
        offset = points - middle
        x, y, z = (dot(way, offset) for way in ways)
        places, rays = np.take(self.places, camera, axis=2), np.take(self.rays, camera, axis=2)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            s = (z - places[2]) / rays[2]
            room = (s.max(axis=0) - s.min(axis=0)) * self.across[camera]
            room += ROUNDING * (norm(offset) + self.size[camera])
            dx, dy = places[0] + s * rays[0] - x, places[1] + s * rays[1] - y
            inside = np.ones(len(camera), dtype=bool)
            sides = [(dx[i] * dy[j] - dx[j] * dy[i], np.hypot(dx[j] - dx[i], dy[j] - dy[i]))
                     for i, j in ((0, 1), (1, 2), (2, 0))]
            turn = np.sign(sides[0][0] + sides[1][0] + sides[2][0])
            for side, length in sides:
                inside &= ~(turn * side < -room * length)
        return inside | ~(rays[2] > 0.0).all(axis=0)
