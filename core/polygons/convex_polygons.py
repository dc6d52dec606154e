"""Convex polygons in the weights of cameras: cut, halved, measured, and taken apart into triangles.

Cutting is I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", CACM 1974, on all polygons at once.
"""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from typing import TypeVar

import numpy as np

from ..geometry import ColumnArrays, columns, cross, dot, ranges

Kind = TypeVar("Kind", bound="ConvexPolygons")
SMALLEST = 1e-9  # share of a camera's area: smaller triangles are dropped


class Line(IntEnum):
    """Labels of the lines that bound a polygon. The first two are bases: add the edge's number, 0 to 2."""

    CAMERA_EDGE = 0  # opposite to one of the camera's corners
    SCENE_EDGE = 3  # opposite to one of the triangle's vertices
    CONTACT = 6  # the triangle's plane, where the mirror crosses it
    HIDDEN = 7  # a line along which a nearer mirror begins


def scene_edges(lines: np.ndarray) -> np.ndarray:
    """Return True for `lines`, labels as in `Line`, that are edges of the scene triangle."""
    return (lines >= Line.SCENE_EDGE) & (lines < Line.CONTACT)


@dataclass(frozen=True)
class ConvexPolygons(ColumnArrays):
    """Convex polygons (q), corner after corner; some may have lost all their corners.

    Attributes
    ----------
    owner : (q,) int64, index of the camera, or of the candidate pair, that each polygon is a part of
    start : (q + 1,) int64, the corners of polygon i are the columns start[i]:start[i + 1] below
    weights : (3, k) float64, of the corners in their cameras
    after : (k,) int8, the label of the line that starts at each corner, as in `cut`
    """

    owner: np.ndarray
    start: np.ndarray
    weights: np.ndarray
    after: np.ndarray

    @staticmethod
    def whole(count: int) -> ConvexPolygons:
        """Whole cameras, each its own owner."""
        return ConvexPolygons(np.arange(count), np.arange(0, 3 * count + 1, 3), np.tile(np.eye(3), (1, count)),
                              np.tile(np.array([2, 0, 1], dtype=np.int8), count))

    def __len__(self) -> int:
        return len(self.owner)

    @property
    def size(self) -> np.ndarray:
        """Number of corners (q,) of each polygon."""
        return np.diff(self.start)

    @property
    def polygon(self) -> np.ndarray:
        """(k,): the polygon of each corner."""
        return np.repeat(np.arange(len(self)), self.size)

    @property
    def following(self) -> np.ndarray:
        """(k,): the corner after each corner."""
        following, some = np.arange(1, self.start[-1] + 1), np.flatnonzero(self.size)
        following[self.start[1:][some] - 1] = self.start[:-1][some]
        return following

    @property
    def before(self) -> np.ndarray:
        """(k,): the label of the line that ends at each corner."""
        before = np.empty_like(self.after)
        before[self.following] = self.after
        return before

    @property
    def areas(self) -> np.ndarray:
        """Share (q,) of its camera's area that each polygon covers."""
        (x, y), after = self.weights[:2], self.following
        return np.abs(np.bincount(self.polygon, x * y[after] - x[after] * y, minlength=len(self)))

    @property
    def middles(self) -> np.ndarray:
        """(3, q): the mean of each polygon's corners."""
        polygon = self.polygon
        total = np.stack([np.bincount(polygon, weight, minlength=len(self)) for weight in self.weights])
        return total / np.maximum(self.size, 1)

    def extents(self, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the minimum and the maximum (..., q) over each polygon of the `values` (..., k) at its corners."""
        start = self.start[:-1]
        return np.minimum.reduceat(values, start, axis=-1), np.maximum.reduceat(values, start, axis=-1)

    def select(self: Kind, chosen: np.ndarray | slice) -> Kind:
        """The polygons `chosen`, as indices, as a mask or as a slice."""
        size = self.size[chosen]
        corner, _ = ranges(self.start[:-1][chosen], size)
        return replace(self, owner=self.owner[chosen], start=np.append(0, np.cumsum(size)),
                       weights=columns(self.weights, corner), after=columns(self.after, corner))

    @classmethod
    def joined(cls: type[Kind], parts: Sequence[Kind]) -> Kind:
        """All polygons of the parts, at least one, one part behind another."""
        size = np.concatenate([part.size for part in parts])
        return replace(parts[0], owner=np.concatenate([part.owner for part in parts]),
                       start=np.append(0, np.cumsum(size)),
                       weights=np.concatenate([part.weights for part in parts], axis=1),
                       after=np.concatenate([part.after for part in parts]))

    def cut(self: Kind, values: np.ndarray, label: int) -> Kind:
        """Cut away the part of each polygon where a function is negative. Polygons may be left without corners.

        Parameters
        ----------
        values : (3, q) float64
            The function at the corners of each polygon's camera; it is linear in the weights.
        label : int, label of the new edges, as in `Line`
        """
        weights, after, polygon = cut(self.weights, self.after, self.polygon, values, label)
        size = np.bincount(polygon, minlength=len(self))
        return replace(self, start=np.append(0, np.cumsum(size)), weights=weights, after=after)

    def halved(self: Kind, chosen: np.ndarray, values: np.ndarray) -> Kind:
        """Cut the polygons `chosen` in two where a function is zero that is linear in the weights.

        Parameters
        ----------
        chosen : (m,) int64, increasing
        values : (3, m) float64, the function at the corners of their cameras

        Returns
        -------
        (q + m) polygons: all q, those chosen without their negative parts; then the negative parts of the m chosen
        """
        all_values = np.ones((3, len(self)))
        all_values[:, chosen] = values
        return self.joined((self.cut(all_values, Line.HIDDEN), self.select(chosen).cut(-values, Line.HIDDEN)))

    def fans(self, apex: np.ndarray | int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Triangulate the polygons as fans of t triangles from the corner `apex` (q,) of each.

        Returns
        -------
        fan : (t,) int64, polygon of each triangle
        corner : (3, t) int64, its corners, as columns of `weights`
        step : (t,) int64, its number in its fan, from 1
        """
        step, fan = ranges(np.ones(len(self), dtype=np.int64), np.maximum(self.size - 2, 0))
        base, length = self.start[:-1][fan], self.size[fan]
        first = np.broadcast_to(apex, len(self))[fan]
        return fan, np.stack([base + (first + k) % length for k in (np.zeros_like(step), step, step + 1)]), step

    def triangles(self, smallest: float = SMALLEST) -> tuple[np.ndarray, np.ndarray]:
        """Triangulate the polygons as n triangles; those up to the `smallest` share of a camera's area are left out.

        Returns
        -------
        owner : (n,) int64
            The `owner` of the polygon that each triangle is a part of: a camera, or a candidate pair.
        weights : (3, 3, n) float64
            Barycentric coordinates of the triangles' corners in the triangle of their camera. Entry [i, k] is weight i
            of corner k.
        """
        fan, corner, _ = self.fans(0)
        weights = self.weights[:, corner]
        areal = np.abs(dot(weights[:, 0], cross(weights[:, 1], weights[:, 2]))) > smallest
        return self.owner[fan[areal]], weights[:, :, areal]


def cut(weights: np.ndarray, after: np.ndarray, polygon: np.ndarray, corner_values: np.ndarray,
        label: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cut away the parts of convex polygons where a function, linear in the weights, is negative.

    Parameters
    ----------
    weights : (3, k) float64, of the polygons' corners, polygon after polygon
    after : (k,) int8, label of the line that starts at each corner
    polygon : (k,) int64, polygon of each corner, increasing
    corner_values : (3, p) float64, the function at the corners of each polygon's camera
    label : int, label of the new line

    Returns
    -------
    weights, after, polygon : the same of the corners that remain; polygons may be left with fewer than three
    """
    if not len(polygon):
        return weights, after, polygon
    values = columns(corner_values, polygon)
    values *= weights
    value = np.add(values[0], values[1], out=values[0])
    value += values[2]
    inside = value >= 0.0
    if inside.all():
        return weights, after, polygon
    end = np.ones(len(polygon), dtype=bool)
    np.not_equal(polygon[1:], polygon[:-1], out=end[:-1])
    ends = np.flatnonzero(end)
    starts = np.append(0, ends[:-1] + 1)
    crossing = np.empty(len(inside), dtype=bool)
    np.not_equal(inside[1:], inside[:-1], out=crossing[:-1])
    crossing[ends] = inside[ends] != inside[starts]
    stay, part = np.flatnonzero(inside), np.flatnonzero(crossing)
    beyond = part + 1
    last = np.flatnonzero(end[part])
    beyond[last] = starts[np.searchsorted(ends, part[last])]
    start, share = columns(weights, part), value[part]
    share /= share - value[beyond]
    way = columns(weights, beyond)
    way -= start
    way *= share
    way += start
    # order the corners: each one that stays is followed by the crossing on the edge to the next
    place = np.cumsum(inside.view(np.int8) + crossing.view(np.int8), dtype=np.int64)
    source = np.empty(place[-1], dtype=np.int64)
    source[place[stay] - 1 - crossing[stay]] = stay
    source[place[part] - 1] = np.arange(len(polygon), len(polygon) + len(part))
    # label the new corners: an outline that leaves continues along the cut, one that enters along its old edge
    after = np.concatenate((after, np.where(inside[part], np.int8(label), after[part])))
    return (columns(np.concatenate((weights, way), axis=1), source), columns(after, source),
            columns(np.concatenate((polygon, polygon[part])), source))
