"""Bounding cones of cameras, discs at the mirror that widen along an axis, around all of their rays; and balls."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import columns, dot, norm, unit


@dataclass(frozen=True)
class Cones:
    """One cone a camera, around every Q(W) + s R(W) with s >= 0.

    Attributes
    ----------
    centre : (3, n) float64, of the disc in which the camera's corners lie
    radius : (n,) float64, of that disc, in scene units
    axis : (3, n) float64, unit
    sine, cosine : (n,) float64, of the half opening angle; a cone of 90 degrees and more (cosine <= 0) holds everything
    """

    centre: np.ndarray
    radius: np.ndarray
    axis: np.ndarray
    sine: np.ndarray
    cosine: np.ndarray

    def __len__(self) -> int:
        return len(self.radius)

    @classmethod
    def around(cls, cameras: Cameras) -> Cones:
        return cls.round(cameras.origins[:, cameras.corners], cameras.rays[:, cameras.corners])

    @classmethod
    def round(cls, places: np.ndarray, rays: np.ndarray, wider: float = 1.0) -> Cones:
        """Cones round rays (3, n, k) that leave triangles with corners `places` (3, n, 3), `wider` than these."""
        rays = unit(rays)
        centre = places.mean(axis=2)
        radius = np.sqrt(((places - centre[:, :, None]) ** 2).sum(axis=0)).max(axis=1)
        total = rays.sum(axis=2)
        axis = unit(total)
        # |axis - ray| = 2 sin(angle / 2) keeps its digits where the angle is small
        half = wider * 0.5 * np.sqrt(((rays - axis[:, :, None]) ** 2).sum(axis=0)).max(axis=1) + 1e-12
        return cls(centre, radius, axis, *_opening(half, norm(total) < 1e-6))

    def touch(self, cone: np.ndarray, centre: np.ndarray, radius: np.ndarray) -> np.ndarray:
        """Return True (n,) if each `cone` (n,) may touch the sphere with `centre` (3, n) and `radius` (n,).

        The test is conservative: a cone that touches its sphere is never missed.
        """
        offset, axis = centre - columns(self.centre, cone), columns(self.axis, cone)
        height = dot(offset, axis)
        axis *= height
        offset -= axis
        room = columns(self.radius, cone) + radius
        sine, cosine = columns(self.sine, cone), columns(self.cosine, cone)
        return (cosine <= 0.0) | ((norm(offset) * cosine - height * sine <= room) & (height >= -room))

    def together(self, start: np.ndarray) -> Cones:
        """Return bounding cones (f) of runs of cones; each run begins at an entry of `start` (f,)."""
        centre, radius, run = _spheres_round(self.centre, self.radius, start)
        total = np.add.reduceat(self.axis, start, axis=1)
        axis = unit(total)
        # half the sum of two angles has no larger a sine than the halves' sines together
        half = 0.5 * norm(self.axis - columns(axis, run)) + np.sqrt(np.maximum(0.5 * (1.0 - self.cosine), 0.0))
        return Cones(centre, radius, axis, *_opening(np.maximum.reduceat(half, start), norm(total) < 1e-6))


@dataclass(frozen=True)
class Balls:
    """Spheres, which descend a tree as cones do.

    Attributes
    ----------
    centre : (3, n) float64
    radius : (n,) float64
    """

    centre: np.ndarray
    radius: np.ndarray

    def __len__(self) -> int:
        return len(self.radius)

    def touch(self, ball: np.ndarray, centre: np.ndarray, radius: np.ndarray) -> np.ndarray:
        """Return True (n,) if each sphere `ball` (n,) overlaps the one with `centre` (3, n) and `radius` (n,)."""
        return norm(columns(self.centre, ball) - centre) <= self.radius[ball] + radius

    def together(self, start: np.ndarray) -> Balls:
        """Return bounding spheres (f) of runs of spheres; each run begins at an entry of `start` (f,)."""
        return Balls(*_spheres_round(self.centre, self.radius, start)[:2])


def _spheres_round(centre: np.ndarray, radius: np.ndarray, start: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return bounding spheres of runs of spheres that begin at `start` (f,).

    Returns
    -------
    centre : (3, f) float64
    radius : (f,) float64
    run : (n,) int64, the run of each given sphere
    """
    count = np.diff(np.append(start, len(radius)))
    run = np.repeat(np.arange(len(start)), count)
    middle = np.add.reduceat(centre, start, axis=1) / count
    return middle, np.maximum.reduceat(norm(centre - columns(middle, run)) + radius, start), run


def _opening(half: np.ndarray, everywhere: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return sine and cosine of opening angles from the sines of their halves, `half` (n,).

    The cosine of cones that are too wide, or contain `everywhere` (n,), is -1.
    """
    wide = (half >= 0.7) | everywhere
    return 2.0 * half * np.sqrt(np.maximum(1.0 - half**2, 0.0)), np.where(wide, -1.0, 1.0 - 2.0 * half**2)
