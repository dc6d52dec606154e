"""What single precision, in which Blender stores places, makes of a result.

Vertices that it cannot tell apart are one, since a face between them has no area and no side; and slivers, which the
rounding of their corners turns over, are turned back. Wherever one of these lay, Line Art and Freestyle would see the
surface turn over, and draw a line.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core import ReflectionMesh, View, breathe
from ....core.geometry import distinct

SPACING = 2.0 ** -22  # of a coordinate: numbers that differ by less are next to each other, or next but one
SLIVER = 8.0 * SPACING  # of a coordinate: what is no wider has been a line
THIN = np.float32(64.0 * SPACING)  # of a coordinate: what is wider keeps its side


def in_single_precision(result: ReflectionMesh, origin: np.ndarray, view: View) -> ReflectionMesh:
    """A result with faces whose places will be rounded relative to `origin` (3,), as the `view` is to see it."""
    exact = result.positions - origin
    rounded = exact.astype(np.float32)
    vertex = _together(rounded, result.triangles)
    triangles = result.triangles if vertex is None else vertex[result.triangles]
    breathe()
    face = np.arange(len(triangles)) if vertex is None else _with_area(triangles, vertex, rounded)
    if not len(face):
        return result
    triangles, weights = triangles[face], result.source_weights[face]
    breathe()
    thin = _thin(rounded, triangles)
    breathe()
    ahead = view.directions(result.positions)
    turned = thin[_away(rounded, ahead, triangles[thin]) != _away(exact, ahead, result.triangles[face[thin]])]
    triangles[turned], weights[turned] = triangles[turned][:, [0, 2, 1]], weights[turned][:, [0, 2, 1]]
    if vertex is None:
        return replace(result, triangles=triangles, source_weights=weights)
    kept, corners = distinct(triangles.ravel())
    breathe()
    return replace(result, triangles=corners.reshape(-1, 3),
                   **{**result.of_faces(face), "source_weights": weights}, **result.of_vertices(kept))


def _away(places: np.ndarray, ahead: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Which triangles show their backs, by their normals as Blender works them out, in the precision of `places`."""
    a, b, c = np.moveaxis(places[triangles], 1, 0)
    return (np.cross(a - b, b - c) * ahead[triangles].sum(axis=1)).sum(axis=1) > 0.0


def _thin(places: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Triangles, in order, so thin that rounding may turn them over."""
    places = np.ascontiguousarray(places.T)
    a, b, c = (places[:, corner] for corner in triangles.T)
    one, other = b - a, c - a
    normal = np.stack([one[i - 2] * other[i - 1] - one[i - 1] * other[i - 2] for i in range(3)])
    length = np.maximum(_largest(np.abs(one)), _largest(np.abs(other)))
    return np.flatnonzero(_largest(np.abs(normal)) < THIN * length * _largest(np.abs(a)))


def _largest(rows: np.ndarray) -> np.ndarray:
    """The largest of three rows (3, n)."""
    return np.maximum(np.maximum(rows[0], rows[1]), rows[2])


def _together(places: np.ndarray, triangles: np.ndarray) -> np.ndarray | None:
    """Of each vertex (n,) at `places` (n, 3), the one that stands for it and for all that lie too near to it; None
    where all stand for themselves."""
    places = np.ascontiguousarray(places.T)
    room = np.float32(SPACING) * _largest(np.abs(places))
    pairs = []
    for one, other in zip(triangles.T, np.roll(triangles, -1, axis=1).T):
        short = _largest(np.abs(places[:, one] - places[:, other])) <= np.maximum(room[one], room[other])
        pairs.append((one[short], other[short]))
    one, other = np.concatenate(pairs, axis=1)
    if not len(one):
        return None
    vertex = np.arange(places.shape[1])
    while (vertex[one] != vertex[other]).any():
        low = np.minimum(vertex[one], vertex[other])
        for end in (one, other):
            np.minimum.at(vertex, vertex[end], low)
        vertex = vertex[vertex]
    return vertex


def _with_area(triangles: np.ndarray, vertex: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Which triangles, on vertices that may stand for others, have three of them.

    Of two on the same vertices the first is one, as the front of a leaf is whose back is too near, but none of two
    slivers, which closed a gap that is closed without them.
    """
    named = np.sort(triangles, axis=1)
    kept = (named[:, 1:] != named[:, :-1]).all(axis=1)
    # only where vertices became one, triangles may have
    near = np.flatnonzero(kept & (np.bincount(vertex, minlength=len(vertex)) > 1)[named].any(axis=1))
    _, first, count = np.unique(named[near], axis=0, return_index=True, return_counts=True)
    a, b, c = np.moveaxis(places[triangles[near[first]]].astype(np.float64), 1, 0)
    length = np.linalg.norm([a - b, b - c, c - a], axis=2).max(axis=0)
    sliver = np.linalg.norm(np.cross(a - b, b - c), axis=1) < SLIVER * length * np.abs(a).max(axis=1, initial=0.0)
    kept[near] = False
    kept[near[first[(count == 1) | ~sliver]]] = True
    return np.flatnonzero(kept)
