"""Clipping: the part of each camera that sees a given diffuse triangle, as a convex polygon in the camera's weights.

I. E. Sutherland, G. W. Hodgman, "Reentrant polygon clipping", CACM 1974, on all pairs at once: the camera's triangle is
cut by the triangle's three edges and, where the mirror crosses the triangle's plane, by that plane. Every corner of a
polygon is the meeting of two lines, and which two tells what it is: a scene vertex in the camera, a scene edge over a
mirror edge, or a mirror corner's ray on the triangle (S. Vallance, P. Calder, ACSC 2006).
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..culling import Candidates
from ..support import portions
from .convex_polygons import ConvexPolygons, Line, cut, scene_edges

PAIRS_AT_ONCE = 32768
SMALLEST = 1e-12  # share of a camera's area: cutting drops pieces that are smaller


@dataclass(frozen=True)
class Polygons(ConvexPolygons):
    """Visible parts of scene triangles in cameras, as convex polygons with an area.

    Attributes
    ----------
    owner : (q,) int64, the candidate pair of each polygon
    candidates : Candidates
    """

    candidates: Candidates

    @property
    def pair(self) -> np.ndarray:
        return self.owner

    @property
    def camera(self) -> np.ndarray:
        """(q,): the camera of each polygon."""
        return self.candidates.camera[self.pair]

    @property
    def column(self) -> np.ndarray:
        """(q,): the triangle's column in the frames of the candidates."""
        return self.candidates.column[self.pair]

    def left(self, values: np.ndarray) -> tuple[Polygons, np.ndarray]:
        """Cut away what a nearer mirror hides: the parts where a function is negative.

        The function is linear in the weights and has the `values` (3, q) at the corners of each polygon's camera.

        Returns
        -------
        polygons : Polygons, the parts that remain and have an area
        chosen : (r,) int64, index of the polygon that each of them is a part of
        """
        rest = self.cut(values, Line.HIDDEN)
        some = rest.real
        return rest.select(some), some

    @property
    def real(self) -> np.ndarray:
        """Return indices (n,) of the polygons that have an area; cutting may leave empty ones."""
        return np.flatnonzero((self.size >= 3) & (self.areas > SMALLEST))


def clip(candidates: Candidates) -> Polygons:
    """Clip the camera of each candidate pair to its scene triangle; pairs that do not overlap are dropped."""
    parts = []
    for portion in portions(max(len(candidates), 1), PAIRS_AT_ONCE):
        part = _clip(candidates.select(portion))
        parts.append(replace(part, candidates=candidates, owner=part.owner + portion.start))
    return Polygons.joined(parts)


def _clip(candidates: Candidates) -> Polygons:
    whole = ConvexPolygons.whole(len(candidates))
    corners = whole.weights, whole.after, whole.polygon
    planes = [(Line.SCENE_EDGE + j, candidates.sides[j]) for j in range(3)]
    if (candidates.ahead < 0.0).any():
        planes.append((Line.CONTACT, candidates.ahead))
    for label, values in planes:
        corners = cut(*corners, values, label)
    weights, after, polygon = corners
    size = np.bincount(polygon, minlength=len(candidates))
    polygons = Polygons(whole.owner, np.append(0, np.cumsum(size)), weights, after, candidates)
    return polygons.select(size >= 3)


def whole_triangles(polygons: Polygons) -> int:
    """Count the polygons that contain their entire scene triangle: three corners, all of them scene vertices."""
    vertex = scene_edges(polygons.before) & scene_edges(polygons.after)
    vertices = np.bincount(polygons.polygon, weights=vertex, minlength=len(polygons))
    return int(((polygons.size == 3) & (vertices == 3)).sum())
