"""Clipping: the part of each camera that sees a given diffuse triangle, as a convex polygon in the camera's weights.

I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", CACM 1974, on all pairs at once: the camera's triangle is
cut by the triangle's three edges and, where the mirror crosses the triangle's plane, by that plane. Every corner of a
polygon is the meeting of two lines, and which two tells what it is: a scene vertex in the camera, a scene edge over a
mirror edge, or a mirror corner's ray on the triangle (S. Vallance, P. Calder, ACSC 2006).
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..culling import Candidates
from ..geometry import ranges
from ..support import breathe

# Lines: 0 1 2 the camera's edges opposite its corners, 3 4 5 the triangle's edges opposite its vertices, 6 its plane.
# 7 any line along which a nearer mirror begins.
SCENE_EDGE, CONTACT, HIDDEN = 3, 6, 7
PAIRS_AT_ONCE = 32768
SMALLEST = 1e-12  # of a camera: a smaller piece that cutting leaves is nothing


@dataclass(frozen=True)
class Polygons:
    """Convex polygons, corner after corner.

    Attributes
    ----------
    candidates : Candidates
    pair : (q,) int64, the candidate pair of each polygon
    start : (q + 1,) int64, the corners of polygon i are the columns start[i]:start[i + 1] below
    weights : (3, k) float64, of the corners in their cameras
    before, after : (k,) int8, the lines that meet in the corner: the one that ends and the one that starts there
    """

    candidates: Candidates
    pair: np.ndarray
    start: np.ndarray
    weights: np.ndarray
    before: np.ndarray
    after: np.ndarray

    @staticmethod
    def of(candidates: Candidates, pairs: np.ndarray, weights: np.ndarray, after: np.ndarray,
           polygon: np.ndarray) -> Polygons:
        """Polygons of corners (k) that lie one behind another, `polygon` (k,) rising; those with fewer than three are
        left out. `pairs` are the candidate pairs of all."""
        size = np.bincount(polygon, minlength=len(pairs))
        kept = size[polygon] >= 3
        weights, after, polygon = weights[:, kept], after[kept], polygon[kept]
        found, start = np.unique(polygon, return_index=True)
        start = np.append(start, len(polygon))
        last = np.arange(len(polygon)) - 1
        last[start[:-1]] = start[1:] - 1
        return Polygons(candidates, pairs[found], start, weights, after[last], after)

    def select(self, chosen: np.ndarray | slice) -> Polygons:
        """The polygons `chosen`, as indices, as a mask or as a slice."""
        size = np.diff(self.start)
        corner, _ = ranges(self.start[:-1][chosen], size[chosen])
        return Polygons(self.candidates, self.pair[chosen], np.append(0, np.cumsum(size[chosen])),
                        self.weights[:, corner], self.before[corner], self.after[corner])

    @staticmethod
    def joined(parts: Sequence[Polygons]) -> Polygons:
        """All polygons of the parts, at least one, of the same candidates, one part behind another."""
        size = np.concatenate([np.diff(part.start) for part in parts])
        return Polygons(parts[0].candidates, np.concatenate([part.pair for part in parts]),
                        np.append(0, np.cumsum(size)),
                        np.concatenate([part.weights for part in parts], axis=1),
                        np.concatenate([part.before for part in parts]), np.concatenate([part.after for part in parts]))

    def cut(self, corner_values: np.ndarray, label: int) -> Polygons:
        """What is left of each polygon where a function is not negative that is linear in the weights and has the
        values (3, q) at the corners of its camera."""
        return self.cut_with(corner_values, label)[0]

    def cut_with(self, corner_values: np.ndarray, label: int) -> tuple[Polygons, np.ndarray]:
        """The same, and which polygon each is left of."""
        polygon = np.repeat(np.arange(len(self.pair)), np.diff(self.start))
        left = Polygons.of(self.candidates, np.arange(len(self.pair)),
                           *cut(self.weights, self.after, polygon, corner_values, label))
        left = left.select(left.areas() > SMALLEST)
        return replace(left, pair=self.pair[left.pair]), left.pair

    def middles(self) -> np.ndarray:
        """(3, q): weights of the mean of each polygon's corners."""
        total = np.add.reduceat(self.weights, self.start[:-1], axis=1) if len(self.pair) else np.zeros((3, 0))
        return total / np.diff(self.start)

    @property
    def camera(self) -> np.ndarray:
        """(q,): the camera of each polygon."""
        return self.candidates.camera[self.pair]

    @property
    def column(self) -> np.ndarray:
        """(q,): the triangle's column in the frames of the candidates."""
        return self.candidates.column[self.pair]

    def areas(self) -> np.ndarray:
        """(q,): the part of its camera that each polygon covers."""
        following = np.arange(1, len(self.before) + 1)
        following[self.start[1:] - 1] = self.start[:-1]
        x, y = self.weights[0], self.weights[1]
        terms = np.append(x * y[following] - x[following] * y, 0.0)
        return np.abs(np.add.reduceat(terms, self.start[:-1])) if len(self.pair) else np.zeros(0)


def clip(candidates: Candidates) -> Polygons:
    """Polygons of the candidates that really overlap."""
    parts = []
    for start in range(0, max(len(candidates), 1), PAIRS_AT_ONCE):
        breathe()
        part = _clip(candidates.select(slice(start, start + PAIRS_AT_ONCE)))
        parts.append(replace(part, candidates=candidates, pair=part.pair + start))
    return Polygons.joined(parts)


def _clip(candidates: Candidates) -> Polygons:
    count = len(candidates)
    weights = np.tile(np.eye(3), (1, count))
    after = np.tile(np.array([2, 0, 1], dtype=np.int8), count)
    polygon = np.repeat(np.arange(count), 3)
    planes = [(SCENE_EDGE + j, candidates.sides[j]) for j in range(3)]
    if (candidates.ahead < 0.0).any():
        planes.append((CONTACT, candidates.ahead))
    for label, corner_values in planes:
        weights, after, polygon = cut(weights, after, polygon, corner_values, label)
    return Polygons.of(candidates, np.arange(count), weights, after, polygon)


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
    values = np.take(corner_values, polygon, axis=1)
    values *= weights
    value = values.sum(axis=0)
    inside = value >= 0.0
    if inside.all():
        return weights, after, polygon
    following = np.arange(1, len(polygon) + 1)
    ends = np.flatnonzero(np.append(polygon[1:] != polygon[:-1], True))
    following[ends] = np.append(0, ends[:-1] + 1)
    crossing = inside != inside[following]
    stay, part = np.flatnonzero(inside), np.flatnonzero(crossing)
    share = value[part] / (value[part] - value[following[part]])
    start = np.take(weights, part, axis=1)
    # each corner that stays is followed by the crossing on the way to the next
    place = np.cumsum(inside.view(np.int8) + crossing, dtype=np.int64)
    new_weights, new_after = np.empty((3, place[-1])), np.empty(place[-1], dtype=np.int8)
    new_polygon = np.empty(place[-1], dtype=np.int64)
    old, new = place[stay] - 1 - crossing[stay], place[part] - 1
    new_weights[:, old], new_after[old], new_polygon[old] = np.take(weights, stay, axis=1), after[stay], polygon[stay]
    new_weights[:, new] = start + share * (np.take(weights, following[part], axis=1) - start)
    # a leaving polygon goes on along the cut, an entering one along the edge that it was on
    new_after[new] = np.where(inside[part], np.int8(label), after[part])
    new_polygon[new] = polygon[part]
    return new_weights, new_after, new_polygon
