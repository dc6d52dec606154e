"""Beams of cameras: a tight test of points against the three corner rays, before the cubic is solved.

In the plane at a point's height above the camera, the corner rays mark a triangle. If all rays rise, a point
Q(W) + s R(W) at that height has s between the values s_i at which the corner rays reach the plane. Its distance from
the place sum W_i (V_i + s_i R_i) in the triangle is at most the range of the s_i times the largest component of a ray
in the plane. A point farther outside of the triangle is not in the beam.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import across, dot, norm
from ..trees import Cones

ROUNDING = 1e-9  # tolerance for rounding, relative to a point's distance plus the camera's radius


@dataclass(frozen=True)
class Beams:
    """Beams (n) of cameras in local frames: two directions perpendicular to the cone's axis, and the axis.

    Attributes
    ----------
    frame : (4, 3, n) float64, the centre of the camera in world space, and the frame's three unit vectors
    places, rays : (3, 3, n) float64, corners and their rays in the frame, as [component, corner, beam]
    across : (n,) float64, largest component of a ray perpendicular to the axis
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
        """Return True (n,) if beam `camera` (n,) may hold the point (3, n); the test is never wrongly False."""
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
