"""Upper bound on the size in pixels of a small object's image, from a camera's own rays: what is smaller than a bound
need not be cut exactly.

At the parameter s of the rays a camera's triangle has moved to corners V_i + s R_i. Per pixel of the picture a point of
it moves by A(s) = A0 + s A1 across the rays, both constant in a camera, so that a sphere of radius r has an image of at
most 2 r / sigma(s) pixels, with sigma the least singular value of A. Over an interval of s, sigma decreases by at most
|A1| times the interval; in a cone of half angle t, where rays lean against the axis, by tan(t) times the part of A
along the axis.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..cameras import Cameras
from ..geometry import dot, norm, unit
from .cones import Cones


@dataclass(frozen=True)
class Magnification:
    """Motion per pixel of cameras (n).

    Attributes
    ----------
    still, mixed, moving : (3, n) float64, entries 00, 01, 11 of A0'A0, A0'A1 + A1'A0 and A1'A1
    along : (2, n) float64, lengths of the parts of A0 and A1 along the axis
    speed : (n,) float64, the least |R| of the camera's rays
    """

    still: np.ndarray
    mixed: np.ndarray
    moving: np.ndarray
    along: np.ndarray
    speed: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras) -> Magnification:
        view = cameras.view
        places = np.take(cameras.places, cameras.corners.T, axis=1)
        rays = np.take(cameras.rays, cameras.corners.T, axis=1)
        axis = unit(unit(rays).sum(axis=1))
        pixels = np.take(view.pixels(cameras.places.T).T, cameras.corners.T, axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            p, q = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
            area = p[0] * q[1] - p[1] * q[0]
            columns, along = [], []
            for corners in (places, rays):
                e, f = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
                right, up = (e * q[1] - f * p[1]) / area, (f * p[0] - e * q[0]) / area
                along.append(np.hypot(dot(right, axis), dot(up, axis)))
                columns.append([move - dot(move, axis) * axis for move in (right, up)])
            (a, b), (c, d) = columns
            return cls(np.stack((dot(a, a), dot(a, b), dot(b, b))),
                       np.stack((2.0 * dot(a, c), dot(a, d) + dot(b, c), 2.0 * dot(b, d))),
                       np.stack((dot(c, c), dot(c, d), dot(d, d))), np.stack(along), norm(rays).min(axis=0))

    def pixels(self, cones: Cones, camera: np.ndarray, sphere: np.ndarray) -> np.ndarray:
        """Bound the diameter (n,), in pixels, of the image of each `sphere` (4, n) in its `camera` (n,).

        It is infinite if there is no bound. `cones` are those around the cameras.
        """
        moving, speed = np.take(self.moving, camera, axis=1), np.maximum(self.speed[camera], 1e-300)
        offset = sphere[:3] - np.take(cones.centre, camera, axis=1)
        s = np.maximum(dot(offset, np.take(cones.axis, camera, axis=1)), 0.0) / speed
        room = (np.abs(sphere[3]) + cones.radius[camera]) / speed
        gram = np.take(self.still, camera, axis=1) + s * (np.take(self.mixed, camera, axis=1) + s * moving)
        least = np.sqrt(np.maximum(_least(gram), 0.0)) - room * np.sqrt(moving[0] + moving[2])
        with np.errstate(divide="ignore", invalid="ignore"):
            lean = np.where(cones.cosine[camera] > 0.0, cones.sine[camera] / cones.cosine[camera], np.inf)
            along = np.take(self.along, camera, axis=1)
            least -= lean * (along[0] + (s + room) * along[1])
            return np.where(least > 0.0, 2.0 * (1.0 + lean) * np.abs(sphere[3]) / least, np.inf)


def _least(gram: np.ndarray) -> np.ndarray:
    """Return the smaller eigenvalues (n,) of symmetric 2 x 2 matrices with entries 00, 01, 11 `gram` (3, n)."""
    middle, half = 0.5 * (gram[0] + gram[2]), 0.5 * (gram[0] - gram[2])
    return middle - np.hypot(half, gram[1])
