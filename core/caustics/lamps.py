"""Lamps as eyes: one view from the lamp that sees all of a mirror, or six views around the lamp."""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..geometry import TriangleMesh, following
from ..support import LARGEST, ReflectionError, numbers
from ..views import LampView, View

WIDEST = 0.9  # radians from the view's axis; a mirror that spans more is seen by six views around the lamp
MARGIN = 1.01  # picture size in multiples of the mirror's size, so that the mirror lies within the borders


@dataclass(frozen=True)
class Lamp:
    """A point light, or a sun with parallel light.

    Parameters
    ----------
    place : (3,) float64
        World position; for a sun the direction in which its light travels.
    sun : bool
    pattern : callable, optional
        Takes places (..., 3) in world space and returns the relative intensity (...) towards them. Default: 1.
    narrow : float
        Angular width of the pattern's smallest details, in radians.
    cone : (3,) float64 and float, optional
        Axis, a unit vector in world space, and half angle in radians of a cone outside of which the pattern is zero.
    places : int
        Number of point samples of the area lamp that this lamp is one of. Errors average out in the sum of their
        light, so each may be coarser.

    Examples
    --------
    >>> from core import Lamp
    >>> Lamp((0, 0, 3)).sun, Lamp.shining((0, 0, -2)).place.tolist()
    (False, [0.0, 0.0, -1.0])
    """

    place: np.ndarray
    sun: bool = False
    pattern: Callable[[np.ndarray], np.ndarray] | None = None
    narrow: float = np.inf
    cone: tuple[np.ndarray, float] | None = None
    places: int = 1

    def __post_init__(self) -> None:
        wrong = "The lamp's place must be three finite numbers up to 1e40; move the lamp nearer."
        place = numbers(self.place, (3,), wrong).copy()
        if not (np.abs(place) <= LARGEST).all():
            raise ValueError(wrong)
        object.__setattr__(self, "place", place)

    @classmethod
    def shining(cls, direction) -> Lamp:
        """Return a sun whose light travels in a `direction` (3,) of any length."""
        lamp = cls(direction, True)
        length = np.linalg.norm(lamp.place)
        if not length > 0.0:
            raise ValueError("The direction of parallel light must not be zero.")
        return cls(lamp.place / length, True)

    def moved(self, offset: np.ndarray) -> Lamp:
        """Return the lamp translated by `offset` (3,) with its pattern; a sun keeps its direction."""
        pattern = self.pattern
        return replace(self, place=self.place if self.sun else self.place + offset,
                       pattern=None if pattern is None else lambda places: pattern(places - offset))

    def share(self, places: np.ndarray) -> np.ndarray:
        """Return the relative intensity (...) towards `places` (..., 3) in world space."""
        return np.ones(places.shape[:-1]) if self.pattern is None else self.pattern(places)

    def mean_share(self, corners: np.ndarray) -> np.ndarray:
        """Return the mean of `share` (m,) over triangles with `corners` (m, 3, 3)."""
        middles, middle = 0.5 * (corners + following(corners)), corners.mean(axis=1)
        return mean_of_seven(self.share(corners).T, self.share(middles).T, self.share(middle))

    def directions(self, places: np.ndarray) -> np.ndarray:
        """Return vectors (n, 3) from the lamp to `places` (n, 3); for a sun, unit vectors along its light."""
        return np.broadcast_to(self.place, places.shape) if self.sun else places - self.place

    def views(self, mirror: TriangleMesh, shades: TriangleMesh | None, screens: TriangleMesh | None,
              detail: int) -> list[LampView]:
        """Return views that together see all of the mirror from the lamp, `detail` pixels wide.

        `shades` are the occluders between the lamp and the mirror, `screens` those after the mirror.
        """
        corners = mirror.positions[np.unique(mirror.triangles)]
        low, high = corners.min(axis=0), corners.max(axis=0)
        middle = 0.5 * (low + high)
        size = (detail, detail)
        if self.sun:
            standing = corners if shades is None or not len(shades.triangles) else np.concatenate(
                (corners, shades.positions[np.unique(shades.triangles)]))
            back = ((standing - middle) @ self.place).min() - np.linalg.norm(high - low) - 1e-6 * np.abs(middle).max()
            view = View.looking_at(middle + back * self.place, middle, size, orthographic_scale=1.0)
            across = (corners - middle) @ view.camera_to_world[:3, :2]
            width = 2.0 * MARGIN * np.abs(across).max()
            view = View.looking_at(middle + back * self.place, middle, size, orthographic_scale=max(width, 1e-30))
            return [self._view(view, shades, screens)]
        ways = corners - self.place
        length = np.linalg.norm(ways, axis=1)
        if not (length > 0.0).all():
            raise ReflectionError("The lamp lies on the mirror; move it away from the mirror's surface.")
        ways /= length[:, None]
        ahead = ways.sum(axis=0)
        if np.linalg.norm(ahead) > 0.0 and not _round(self.place, mirror):
            ahead /= np.linalg.norm(ahead)
            view = View.looking_at(self.place, self.place + ahead * length.max(), size, field_of_view=1.0)
            local = ways @ view.camera_to_world[:3, :3]
            if (local[:, 2] < -np.cos(WIDEST)).all():
                width = 2.0 * np.arctan(MARGIN * np.abs(local[:, :2] / local[:, 2:]).max())
                view = View.looking_at(self.place, self.place + ahead * length.max(), size, field_of_view=width)
                return [self._view(view, shades, screens)]
        return [self._view(_side(self.place, axis, sign, size), shades, screens)
                for axis in range(3) for sign in (1.0, -1.0)]

    def _view(self, view: View, shades: TriangleMesh | None, screens: TriangleMesh | None) -> LampView:
        return LampView(view.camera_to_world, view.projection, view.resolution, shades, screens, self.cone)


def mean_of_seven(corners: np.ndarray, middles: np.ndarray, middle: np.ndarray) -> np.ndarray:
    """Return the mean (m,) over triangles of a function, by a quadrature rule that is exact for cubics.

    The function is given at the corners (3, m), at the midpoints of the sides (3, m), and at the centroids (m,).

    A. Stroud, "Approximate Calculation of Multiple Integrals", 1971.
    """
    return corners.sum(axis=0) / 20.0 + middles.sum(axis=0) * (2.0 / 15.0) + middle * (9.0 / 20.0)


def _round(place: np.ndarray, mirror: TriangleMesh) -> bool:
    """Return True if `place` (3,) lies in the mirror's bounding box: parts of the mirror may lie in any direction."""
    corners = mirror.positions[mirror.triangles].reshape(-1, 3)
    return bool(((place > corners.min(axis=0)) & (place < corners.max(axis=0))).all())


def _side(place: np.ndarray, axis: int, sign: float, size: tuple[int, int]) -> View:
    """Return the view from `place` (3,) along an axis, one of six; its borders lie in planes x = y, x = z or y = z."""
    placement, projection = np.eye(4), np.zeros((4, 4))
    placement[:3, :3] = np.roll(np.eye(3), axis + 1, axis=0) * (1.0, -sign, -sign)
    placement[:3, 3] = place
    projection[0, 0] = projection[1, 1] = 1.0
    projection[2, 2], projection[2, 3], projection[3, 2] = -1.0, -0.02, -1.0
    return View(placement, projection, size)


