"""Shafts round cameras: between four planes, two and two across, closer than cones where rays part more one way than
the other, as behind slivers and where a mirror is bent one way.

E. Haines, J. Wallace, "Shaft Culling for Efficient Ray-Traced Radiosity", 1991.
"""
from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..cameras import Cameras
from ..geometry import across, columns, dot, mask, norm, unit
from .cones import Cones

ROUNDING = 1e-12  # share of the lengths that planes are computed from
UPRIGHT = 1e-6  # component of a unit ray along the axis: a shaft with a smaller one contains everything


@dataclass(frozen=True)
class Shafts:
    """One shaft round the cone of each of n cameras, or of each run of cameras, on k corners.

    Attributes
    ----------
    cones : Cones
    places, rays : (3, k) float64, origins and unit directions of the rays at the corners, shaft after shaft
    start : (n,) int64, index of the first ray of each shaft
    reach : float, distance up to which the shafts fit their rays closely, in scene units
    """

    cones: Cones
    places: np.ndarray
    rays: np.ndarray
    start: np.ndarray
    reach: float

    @classmethod
    def around(cls, cameras: Cameras, reach: float) -> Shafts:
        corner = cameras.corners.ravel()
        return cls(Cones.around(cameras), columns(cameras.origins, corner), unit(columns(cameras.rays, corner)),
                   3 * np.arange(len(cameras)), reach)

    def __len__(self) -> int:
        return len(self.cones)

    def together(self, start: np.ndarray) -> Shafts:
        """Return bounding shafts (f) of runs of shafts; each run begins at an entry of `start` (f,)."""
        return replace(self, cones=self.cones.together(start), start=self.start[start])

    def touch(self, shaft: np.ndarray, centre: np.ndarray, radius: np.ndarray) -> np.ndarray:
        """Return True (n,) if the cone of each `shaft` (n,) may touch the sphere with `centre` (3, n) and `radius`."""
        return self.cones.touch(shaft, centre, radius)

    def hold(self, shaft: np.ndarray, positions: np.ndarray, corners: np.ndarray) -> np.ndarray:
        """Return True (p,) if each triangle may reach into its `shaft` (p,). The test is conservative.

        Parameters
        ----------
        positions : (v, 3) float64
        corners : (p, 3) int64, vertices of the triangles
        """
        left = np.arange(len(shaft))
        for plane in self.planes:
            own, beyond = columns(plane, shaft[left]), np.ones(len(left), dtype=bool)
            for corner in corners[left].T:
                beyond &= dot(own, positions.take(corner, axis=0).T) > own[3]
            left = left[~beyond]
        return mask(len(shaft), left)

    @cached_property
    def planes(self) -> list[np.ndarray]:
        """Four (4, n): outward normals, and how high the planes lie along them; first the two that lie closer together.

        Let W be barycentric weights in a camera, and heights be above the centre of the cone: q(W) along the axis and
        x(W) across of the camera's places, h and x of a point in the shaft. Then x = x(W) + slope(W) (h - q(W)), where
        slope(W) lies between those of the corners and h >= q(W): beside the mean slope, x strays by half the range of
        slopes for each unit of h - q(W) at the most.
        """
        centre, axis, start = self.cones.centre, self.cones.axis, self.start
        run = np.repeat(np.arange(len(start)), np.diff(np.append(start, self.rays.shape[1])))
        own, away = columns(axis, run), self.places - columns(centre, run)
        height, rising = dot(away, own), dot(self.rays, own)
        everything = np.minimum.reduceat(rising, start) < UPRIGHT
        rising = np.maximum(rising, UPRIGHT)
        size = norm(centre) + self.reach + np.maximum.reduceat(norm(away), start)
        lowest = np.minimum.reduceat(height, start)
        planes = []
        for way in _directions(axis, away + self.reach * self.rays, run, start):
            own = columns(way, run)
            slope = dot(self.rays, own) / rising
            least, most = np.minimum.reduceat(slope, start), np.maximum.reduceat(slope, start)
            mean, widening = 0.5 * (least + most), 0.5 * (most - least)
            beside = dot(away, own) - mean[run] * height
            room = ROUNDING * size * (1.0 + np.abs(mean) + widening) - widening * lowest
            for side, end in ((1.0, np.maximum.reduceat(beside, start)), (-1.0, -np.minimum.reduceat(beside, start))):
                normal = side * (way - mean * axis) - widening * axis
                high = np.where(everything, np.inf, end + room + dot(normal, centre))
                planes.append(np.concatenate((normal, high[None])))
        return planes


def _directions(axis: np.ndarray, ends: np.ndarray, run: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return two unit vectors (3, n) at right angles to each `axis` (3, n) and to one another.

    Along the first the `ends` (3, k) of the axis's rays are spread least, along the second most. Ray k belongs to axis
    `run[k]`; the rays of each axis begin at `start` (n,).
    """
    first, second = across(axis)
    count = np.diff(np.append(start, len(run)))
    x, y = ((end := dot(ends, columns(way, run))) - (np.add.reduceat(end, start) / count)[run]
            for way in (first, second))
    angle = 0.5 * np.arctan2(2.0 * np.add.reduceat(x * y, start), np.add.reduceat(x * x - y * y, start))
    return second * np.cos(angle) - first * np.sin(angle), first * np.cos(angle) + second * np.sin(angle)
