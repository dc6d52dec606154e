"""Search for the reflected ray that passes nearest to a point.

A pyramid of bounding cones over a grid of rays is searched from the top for all points at once, by branch and bound.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...geometry import norm, unit

POINTS_AT_ONCE = 8192
SLACK = 1e-9  # radians


@dataclass(frozen=True)
class RayPyramid:
    """Rays on a grid whose sides are one power of two, and cones around blocks of them.

    Attributes
    ----------
    places, rays : (3, n) float64
        Unit directions.
    levels : list of (10, 4**level) float64
        Cones of each level from the top, along the rows: centre, radius, axis, half angle, 1 if the block has rays,
        and the index of its representative ray; the last level holds the grid's own rays.
    """

    places: np.ndarray
    rays: np.ndarray
    levels: list

    @classmethod
    def build(cls, grid: np.ndarray, places: np.ndarray, rays: np.ndarray) -> RayPyramid:
        """Build the pyramid; `grid` (height, width) holds the index of each cell's ray, -1 if there is none."""
        depth = int(np.ceil(np.log2(max(*grid.shape, 1))))
        side = 2**depth
        full = np.full((side, side), -1)
        full[:grid.shape[0], :grid.shape[1]] = grid
        levels = []
        for level in range(depth + 1):
            width = side // 2**level
            blocks = full.reshape(2**level, width, 2**level, width).swapaxes(1, 2).reshape(4**level, width * width)
            levels.append(_cones(blocks, places, rays))
        return cls(places, rays, levels)

    def nearest(self, points: np.ndarray) -> tuple[np.ndarray, int]:
        """Find the ray that passes nearest to each of `points` (3, v), by the angle at the ray's origin.

        Returns
        -------
        ray : (v,) int64
        visited : int, number of cones tested
        """
        found, visited = np.full(points.shape[1], -1), 0
        for start in range(0, points.shape[1], POINTS_AT_ONCE):
            part = slice(start, start + POINTS_AT_ONCE)
            found[part], more = self._nearest(points[:, part])
            visited += more
        return found, visited

    def _nearest(self, points: np.ndarray) -> tuple[np.ndarray, int]:
        count, visited = points.shape[1], 0
        best = np.full(count, np.inf)
        point, node = np.arange(count), np.zeros(count, dtype=np.int64)
        for level, cones in enumerate(self.levels):
            if level:
                side = 2**(level - 1)
                line, column = node // side, node % side
                node = ((2 * line[:, None] + (0, 0, 1, 1)) * 2 * side + 2 * column[:, None] + (0, 1, 0, 1)).ravel()
                point = np.repeat(point, 4)
            held = np.flatnonzero(cones[8, node] > 0.0)
            point, node = point[held], node[held]
            visited += len(point)
            at = np.take(points, point, axis=1)
            stands = cones[9, node].astype(np.int64)
            angle = _angle(at - np.take(self.places, stands, axis=1), np.take(self.rays, stands, axis=1))
            np.minimum.at(best, point, angle)
            if level + 1 == len(self.levels):
                order = np.flatnonzero(angle == best[point])
                found = np.full(count, -1)
                found[point[order]] = stands[order]
                return found, visited
            cone = np.take(cones, node, axis=1)
            offset = at - cone[:3]
            with np.errstate(divide="ignore", invalid="ignore"):
                blur = np.arcsin(np.minimum(cone[3] / norm(offset), 1.0))
            least = _angle(offset, cone[4:7]) - cone[7] - blur
            open_ = np.flatnonzero((least <= best[point] + SLACK) | ~(norm(offset) > cone[3]))
            point, node = point[open_], node[open_]
        raise AssertionError("a pyramid has a level")


def _cones(blocks: np.ndarray, places: np.ndarray, rays: np.ndarray) -> np.ndarray:
    filled = blocks >= 0
    weight = filled / np.maximum(filled.sum(axis=1), 1)[:, None]
    place, ray = np.where(filled, places[:, blocks], 0.0), np.where(filled, rays[:, blocks], 0.0)
    centre, axis = (place * weight).sum(axis=2), unit(ray.sum(axis=2))
    radius = np.where(filled, norm(place - centre[:, :, None]), 0.0).max(axis=1)
    half = np.where(filled, _angle(ray, axis[:, :, None]), 0.0).max(axis=1)
    # the ray in the middle of the block, or the next one that there is
    middle = np.argmax(np.where(filled, 1.0 - np.abs(np.linspace(-0.5, 0.5, filled.shape[1])), 0.0), axis=1)
    stands = blocks[np.arange(len(blocks)), middle]
    return np.concatenate((centre, radius[None], axis, half[None], np.any(filled, axis=1)[None], stands[None]))


def _angle(a: np.ndarray, unit_b: np.ndarray) -> np.ndarray:
    """Angles between vectors and unit vectors, exact for small ones too."""
    return 2.0 * np.arcsin(np.minimum(0.5 * norm(unit(a) - unit_b), 1.0))
