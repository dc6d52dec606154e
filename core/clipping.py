"""Clipping: the part of each camera that sees a given diffuse triangle, as a convex polygon in the camera's weights.

I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", CACM 1974, on all pairs at once: the camera's triangle is
cut by the triangle's three edges and, where the mirror crosses the triangle's plane, by that plane. Every corner of a
polygon is the meeting of two lines, and which two tells what it is: a scene vertex in the camera, a scene edge over a
mirror edge, or a mirror corner's ray on the triangle (S. Vallance, P. Calder, ACSC 2006).
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .candidates import Candidates

# Lines: 0 1 2 the camera's edges opposite its corners, 3 4 5 the triangle's edges opposite its vertices, 6 its plane;
# 7 no line at all, round cells that rays filled.
SCENE_EDGE, CONTACT, FILLED = 3, 6, 7


@dataclass(frozen=True)
class Polygons:
    """Convex polygons, corner after corner.

    Attributes
    ----------
    pair : (q,) int64, the candidate pair of each polygon
    start : (q + 1,) int64, the corners of polygon i are the columns start[i]:start[i + 1] below
    weights : (3, k) float64, of the corners in their cameras
    before, after : (k,) int8, the lines that meet in the corner: the one that ends and the one that starts there
    """

    pair: np.ndarray
    start: np.ndarray
    weights: np.ndarray
    before: np.ndarray
    after: np.ndarray

    def select(self, chosen: np.ndarray) -> Polygons:
        """The polygons `chosen` by a mask (q,)."""
        size = np.diff(self.start)
        corner = np.repeat(chosen, size)
        return Polygons(self.pair[chosen], np.append(0, np.cumsum(size[chosen])), self.weights[:, corner],
                        self.before[corner], self.after[corner])

    def joined(self, more: Polygons) -> Polygons:
        """These polygons and behind them `more`, of the same list of pairs."""
        return Polygons(np.concatenate((self.pair, more.pair)),
                        np.concatenate((self.start, more.start[1:] + self.start[-1])),
                        np.concatenate((self.weights, more.weights), axis=1),
                        np.concatenate((self.before, more.before)), np.concatenate((self.after, more.after)))


def clip(candidates: Candidates) -> Polygons:
    """Polygons of the candidates that really overlap."""
    count = len(candidates)
    weights = np.tile(np.eye(3), (1, count))
    after = np.tile(np.array([2, 0, 1], dtype=np.int8), count)
    polygon = np.repeat(np.arange(count), 3)
    planes = [(SCENE_EDGE + j, candidates.sides[j]) for j in range(3)]
    if (candidates.ahead < 0.0).any():
        planes.append((CONTACT, candidates.ahead))
    for label, corner_values in planes:
        weights, after, polygon = cut(weights, after, polygon, corner_values, label)
    size = np.bincount(polygon, minlength=count)
    kept = size[polygon] >= 3
    weights, after, polygon = weights[:, kept], after[kept], polygon[kept]
    pair, start = np.unique(polygon, return_index=True)
    start = np.append(start, len(polygon))
    last = np.arange(len(polygon)) - 1
    last[start[:-1]] = start[1:] - 1
    return Polygons(pair, start, weights, after[last], after)


def whole_triangles(polygons: Polygons) -> int:
    """How many polygons hold their triangle whole: three corners, all of them scene vertices."""
    vertex = (polygons.before >= SCENE_EDGE) & (polygons.after >= SCENE_EDGE) & (polygons.before < CONTACT) & (
        polygons.after < CONTACT)
    size = np.diff(polygons.start)
    vertices = np.bincount(np.repeat(np.arange(len(size)), size), weights=vertex, minlength=len(size))
    return int(((size == 3) & (vertices == 3)).sum())


def cut(weights: np.ndarray, after: np.ndarray, polygon: np.ndarray, corner_values: np.ndarray,
        label: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """What is left of convex polygons where a function, linear in the weights, is not negative.

    Parameters
    ----------
    weights : (3, k) float64, of the polygons' corners, polygon after polygon
    after : (k,) int8, the line that starts at each corner
    polygon : (k,) int64, rising
    corner_values : (3, p) float64, the function at the corners of each polygon's camera
    label : the name of the new line

    Returns
    -------
    weights, after, polygon : of the corners that are left; polygons may be left with fewer than three
    """
    if not len(polygon):
        return weights, after, polygon
    value = (weights * np.take(corner_values, polygon, axis=1)).sum(axis=0)
    inside = value >= 0.0
    if inside.all():
        return weights, after, polygon
    following = np.arange(1, len(polygon) + 1)
    ends = np.flatnonzero(np.append(polygon[1:] != polygon[:-1], True))
    following[ends] = np.append(0, ends[:-1] + 1)
    crossing = inside != inside[following]
    part = np.flatnonzero(crossing)
    share = value[part] / (value[part] - value[following[part]])
    crossed = weights[:, part] + share * (weights[:, following[part]] - weights[:, part])
    # a leaving polygon goes on along the cut, an entering one along the edge that it was on
    crossed_after = np.where(inside[part], np.int8(label), after[part])
    stay = np.flatnonzero(inside)
    order = np.argsort(np.concatenate((2 * stay, 2 * part + 1)), kind="stable")
    return (np.concatenate((weights[:, stay], crossed), axis=1)[:, order],
            np.concatenate((after[stay], crossed_after))[order],
            np.concatenate((polygon[stay], polygon[part]))[order])
