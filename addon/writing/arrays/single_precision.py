"""Round the positions of a result to single precision, as Blender stores them, without flipped or empty faces.

Vertices that become equal are merged, since a face between them has no area. Slivers that rounding flips are flipped
back. Line Art and Freestyle would otherwise see flipped faces and draw lines there.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ....core import ReflectionMesh, View, breathe
from ....core.geometry import distinct

SPACING = 2.0 ** -22  # relative to a coordinate; closer numbers are (next) neighbours in single precision
SLIVER = 8.0 * SPACING  # relative to a coordinate; narrower triangles count as lines
THIN = np.float32(64.0 * SPACING)  # relative to a coordinate; wider triangles are never flipped by rounding


def in_single_precision(result: ReflectionMesh, origin: np.ndarray, view: View) -> ReflectionMesh:
    """Return a result with faces whose positions will be rounded relative to `origin` (3,), seen from `view`."""
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
    """Return True (m,) for triangles that face away from the eye, by their normals as Blender computes them, in the
    precision of `places` (n, 3). `ahead` (n, 3) are the view directions at the vertices.
    """
    a, b, c = np.moveaxis(places[triangles], 1, 0)
    return (np.cross(a - b, b - c) * ahead[triangles].sum(axis=1)).sum(axis=1) > 0.0


def _thin(places: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return the sorted indices of triangles that are so thin that rounding may flip them."""
    places = np.ascontiguousarray(places.T)
    a, b, c = (places[:, corner] for corner in triangles.T)
    one, other = b - a, c - a
    normal = np.stack([one[i - 2] * other[i - 1] - one[i - 1] * other[i - 2] for i in range(3)])
    length = np.maximum(_largest(np.abs(one)), _largest(np.abs(other)))
    return np.flatnonzero(_largest(np.abs(normal)) < THIN * length * _largest(np.abs(a)))


def _largest(rows: np.ndarray) -> np.ndarray:
    """Return the largest of three rows (3, n), as (n,)."""
    return np.maximum(np.maximum(rows[0], rows[1]), rows[2])


def _together(places: np.ndarray, triangles: np.ndarray) -> np.ndarray | None:
    """Return for each vertex (n,) at `places` (n, 3) the vertex into which it is merged because they are too close.
    Return None if no vertices are merged.
    """
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
    """Return the indices of `triangles` that still have three distinct vertices after merging by `vertex` (n,).

    Of several triangles on the same vertices, keep the first, e.g. the front of a leaf whose back is too close. Keep
    none if they are slivers: these filled a gap that is closed without them.
    """
    named = np.sort(triangles, axis=1)
    kept = (named[:, 1:] != named[:, :-1]).all(axis=1)
    # only triangles with merged vertices may coincide
    near = np.flatnonzero(kept & (np.bincount(vertex, minlength=len(vertex)) > 1)[named].any(axis=1))
    _, first, count = np.unique(named[near], axis=0, return_index=True, return_counts=True)
    a, b, c = np.moveaxis(places[triangles[near[first]]].astype(np.float64), 1, 0)
    length = np.linalg.norm([a - b, b - c, c - a], axis=2).max(axis=0)
    sliver = np.linalg.norm(np.cross(a - b, b - c), axis=1) < SLIVER * length * np.abs(a).max(axis=1, initial=0.0)
    kept[near] = False
    kept[near[first[(count == 1) | ~sliver]]] = True
    return np.flatnonzero(kept)
