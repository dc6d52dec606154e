"""Nodes of the whole faces: points of the scene with their images on the patch."""
from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np

from ..geometry import ColumnArrays, mask
from ..patches import Patch, changes, find
from ..support import portions

AT_ONCE = 16384  # points whose arrays fit the cache


@dataclass(frozen=True)
class Images(ColumnArrays):
    """Source points P (n) and their images on a patch, at most one image for each point.

    The image is the place Q on the mirror at which the eye sees P: P = Q + s R, where R is the reflected ray at Q.
    Coordinates are relative to `Patch.eye`: the eye, or the world origin in an orthographic view.

    Attributes
    ----------
    point : (3, n) float64, P
    member : (n,) int64, triangle of the patch in which the image lies
    uv : (2, n) float64, place of the image in that triangle with corners A, B, C: Q = A + u (B - A) + v (C - A)
    distance : (n,) float64
        s, along the ray from Q to P: a multiple of the distance from the eye to Q, or a length in orthographic views.
    found : (n,) bool
        True if there is an image. Otherwise the entries below are meaningless, and `member`, `uv` and `distance` are at
        most a guess.
    place : (3, n) float64, Q
    pixel : (2, n) float64, Q in the picture, in pixels to the right and up
    moving : (2, 3, n) float64
        Derivatives of `pixel` by `point`, in pixels per scene unit, as [right or up, component, image]. NaN until
        `moved` computes them.
    """

    point: np.ndarray
    member: np.ndarray
    uv: np.ndarray
    distance: np.ndarray
    found: np.ndarray
    place: np.ndarray
    pixel: np.ndarray
    moving: np.ndarray

    @classmethod
    def near(cls, patch: Patch, points: np.ndarray, member: np.ndarray, uv: np.ndarray, s: np.ndarray) -> Images:
        """Find images of `points` (3, n), relative to the eye, from first guesses `member`, `uv` and `s`."""
        return cls.at(patch, points, *find(patch, member, uv, s, points))

    @classmethod
    def at(cls, patch: Patch, points: np.ndarray, member: np.ndarray, uv: np.ndarray, s: np.ndarray,
           found: np.ndarray) -> Images:
        """Make images of `points` (3, n), relative to the eye, with known places `uv` in triangles `member`."""
        count = len(s)
        place, pixel = np.empty((3, count)), np.empty((2, count))
        for part in portions(count, AT_ONCE):
            place[:, part] = patch.places(member[part], uv[:, part])
            pixel[:, part] = patch.pixels(place[:, part])
        found = found & np.isfinite(pixel).all(axis=0)
        return cls(points, member, uv, s, found, place, pixel, np.full((2, 3, count), np.nan))

    def put(self, node: np.ndarray, others: Images) -> None:
        """Replace the images of nodes `node` (k,) by those of `others` (k), in place."""
        for field in fields(self):
            getattr(self, field.name)[..., node] = getattr(others, field.name)

    def several(self, nodes: np.ndarray) -> np.ndarray:
        """Return True for faces with corners `nodes` (3, f) that lie over several triangles of the mirror."""
        one, other, third = self.member[nodes]
        return (one != other) | (other != third)

    def moved(self, patch: Patch, *nodes: np.ndarray) -> Images:
        """Compute the derivatives `moving` of the images of `nodes` that lack them, in place, and return the images."""
        asked = np.logical_or.reduce([mask(len(self), some) for some in nodes])
        chosen = np.flatnonzero(asked & self.found & np.isnan(self.moving[0, 0]))
        _, self.moving[:, :, chosen] = changes(patch, self.member[chosen], self.uv[:, chosen], self.distance[chosen])
        return self

    def between(self, patch: Patch, a: np.ndarray, b: np.ndarray) -> Images:
        """Find the images of the midpoints between points `a` and `b` (e,), starting midway between their images."""
        member = self.member[a]
        start = patch.coordinates(member, 0.5 * (self.place[:, a] + self.place[:, b]))
        lone = ~self.found[b]
        start = np.where(lone, self.uv[:, a], np.clip(start, -1.0, 2.0))
        s = np.where(lone, self.distance[a], 0.5 * (self.distance[a] + self.distance[b]))
        return Images.near(patch, 0.5 * (self.point[:, a] + self.point[:, b]), member, start, s)

    def around(self, patch: Patch, nodes: np.ndarray) -> Images:
        """Find the images of the centres of faces with corners `nodes` (3, f), starting at their images' centres."""
        member = self.member[nodes[0]]
        start = np.clip(patch.coordinates(member, self.place[:, nodes].mean(axis=1)), -1.0, 2.0)
        return Images.near(patch, self.point[:, nodes].mean(axis=1), member, start, self.distance[nodes].mean(axis=0))
