"""Slivers: faces that are too thin to carry light or to be stored.

The outline of a mirror and the outline of a receiver may fall on the same line, for instance if both are squares with
the same diagonal. Rotation in single precision then leaves a strip between them whose width is rounding. Stored in
single precision again, its faces overlap, and engines draw them as a line. So such strips are left out, and the faces
on both sides are stitched together.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import (
    ColumnArrays,
    areas,
    between,
    connected,
    distinct,
    edge_lengths,
    edge_numbers,
    following,
    ranges,
    shares,
)
from ..result import ReflectionMesh
from .energy import SINGLE

THINNEST = 8.0 * SINGLE  # width of a sliver, as share of the picture's and of the lit region's size
ODD = np.array((0.6180, 0.7071, 0.3437))  # sort direction that is parallel to no typical edge
AT_ONCE = 1 << 20  # pairs of an edge and a vertex per chunk


@dataclass(frozen=True)
class Stitched(ColumnArrays):
    """Faces of a lamp's reflection without slivers.

    Attributes
    ----------
    triangles : (m, 3) int64, between the vertices of the reflection
    origin : (m,) int64, the face of the reflection that each is a part of
    on_side : (m, 3) bool, True for the sides 01, 12, 20 that lie on a side of their receiver's triangle
    """

    counting_axis = 0
    triangles: np.ndarray
    origin: np.ndarray
    on_side: np.ndarray


def without_slivers(seen: ReflectionMesh) -> Stitched:
    """Drop faces that are thin both in the lamp's picture and on the receivers, and stitch their neighbours.

    Faces that are thin in only one of them are kept: near a focus they carry all light, and at grazing angles they
    cover the receiver.
    """
    view = seen.maps[0].view
    # scale both, so that the picture and the lit region have the size 1
    picture = np.pad(view.pixels(seen.mirror_position) / max(view.resolution), ((0, 0), (0, 1)))
    points = seen.reflected_position / max(np.ptp(seen.reflected_position, axis=0).max(initial=0.0), 1e-300)
    thin = _are_thin(picture[seen.triangles]) & _are_thin(points[seen.triangles])
    kept, slivers = np.flatnonzero(~thin), seen.triangles[thin]
    vertex = _one_vertex(len(points), _near(np.concatenate((picture, points), axis=1), np.unique(slivers)))
    triangles = vertex[seen.triangles[kept]]
    whole = (triangles != following(triangles)).all(axis=1)
    faces = Stitched(triangles[whole], kept[whole], (seen.source_sides[kept] >= 0)[whole])
    inserted = _inserted(picture, points, faces.triangles, vertex[np.unique(slivers)])
    # a round splits one side of each face
    for _ in range(3):
        faces = _split(faces, *inserted, len(vertex))
    # a face may be split at its own third vertex
    return faces.select(_without_twins(faces.triangles))


def merged(positions: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Merge the ends of edges that single precision cannot tell apart.

    Returns
    -------
    vertices : (k,) int64, those of the `positions` (n, 3) that are left
    triangles : (m, 3) int64, between these
    faces : (m,) int64, those of the `triangles` that still have three vertices
    """
    short = edge_lengths(positions[triangles]) <= SINGLE * np.ptp(positions, axis=0).max(initial=0.0)
    ends = np.stack((triangles[short], following(triangles)[short]), axis=1)
    triangles = _one_vertex(len(positions), ends)[triangles]
    faces = _without_twins(triangles)
    vertices, corner = distinct(triangles[faces].ravel())
    return vertices, corner.reshape(-1, 3), faces


def _without_twins(triangles: np.ndarray) -> np.ndarray:
    """Return the indices (k,) of triangles (m, 3) with three different vertices, without duplicates.

    A Blender mesh must not hold other faces. Of duplicates the first is kept.
    """
    whole = np.flatnonzero((triangles != following(triangles)).all(axis=1))
    _, first = np.unique(np.sort(triangles[whole], axis=1), axis=0, return_index=True)
    return whole[np.sort(first)]


def _are_thin(corners: np.ndarray) -> np.ndarray:
    """Return True (m,) for triangles with `corners` (m, 3, 3) whose height is negligible relative to a length of 1."""
    return 2.0 * areas(corners) <= THINNEST * edge_lengths(corners).max(axis=1, initial=0.0)


def _one_vertex(count: int, pairs: np.ndarray) -> np.ndarray:
    """Return the first vertex (count,) of the connected component of each vertex, for edges `pairs` (p, 2)."""
    every = np.arange(count)
    part = connected(np.concatenate((np.stack((every, every), axis=1), pairs)))[:count]
    _, first = np.unique(part, return_index=True)
    return first[part]


def _near(places: np.ndarray, chosen: np.ndarray) -> np.ndarray:
    """Find pairs (p, 2) of `chosen` vertices (k,) that lie no farther apart than the width of a sliver."""
    along = places[:, -3:] @ ODD
    chosen = chosen[np.argsort(along[chosen])]
    start, number = between(along[chosen], along[chosen], along[chosen] + THINNEST)
    pairs = [np.zeros((0, 2), dtype=np.int64)]
    for part in shares(number, AT_ONCE):
        index, one = ranges(start[part], number[part])
        both = np.stack((chosen[part][one], chosen[index]), axis=1)
        apart = np.linalg.norm(places[both[:, 0]] - places[both[:, 1]], axis=1)
        pairs.append(both[(apart <= THINNEST) & (both[:, 0] != both[:, 1])])
    return np.concatenate(pairs)


def _inserted(picture: np.ndarray, points: np.ndarray, triangles: np.ndarray,
              loose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find the vertices among `loose` (k,) that lie within edges of triangles between such vertices.

    Returns
    -------
    key : (p,) int64, numbers of the edges, rising, as `edge_numbers` gives them
    vertex : (p,) int64, the vertices of each edge from its lower end on
    """
    count = len(points)
    used = np.zeros(count, dtype=bool)
    used[loose] = True
    ends = np.stack((triangles, following(triangles)), axis=2)[used[triangles] & used[following(triangles)]]
    ends = np.unique(np.sort(ends, axis=1), axis=0)
    # sort along a direction in which few vertices lie between the ends of an edge without being near it
    along = points @ ODD
    loose = loose[np.argsort(along[loose])]
    start, number = between(along[loose], along[ends].min(axis=1) - THINNEST, along[ends].max(axis=1) + THINNEST)
    found = [(np.zeros(0, dtype=np.int64), loose[:0], along[:0])]
    for part in shares(number, AT_ONCE):
        index, edge = ranges(start[part], number[part])
        (low, high), vertex = ends[part][edge].T, loose[index]
        inside, share = _within(points, low, high, vertex)
        inside &= _within(picture, low, high, vertex)[0]
        found.append((edge_numbers(low, high, count)[inside], vertex[inside], share[inside]))
    key, vertex, share = map(np.concatenate, zip(*found))
    order = np.lexsort((share, key))
    return key[order], vertex[order]


def _within(places: np.ndarray, low: np.ndarray, high: np.ndarray, vertex: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return True (p,) for vertices that lie within edges from `low` to `high`, and their share (p,) of the way."""
    way, to = places[high] - places[low], places[vertex] - places[low]
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    share = (way * to).sum(axis=1) / square
    beside = np.linalg.norm(to - share[:, None] * way, axis=1) <= 2.0 * THINNEST
    return beside & (np.minimum(share, 1.0 - share) * np.sqrt(square) > THINNEST), share


def _split(faces: Stitched, key: np.ndarray, vertex: np.ndarray, count: int) -> Stitched:
    """Split one side of each face at the vertices (p,) within the edges with the numbers `key` (p,), of `count`
    vertices."""
    numbers = edge_numbers(faces.triangles, following(faces.triangles), count)
    start, number = (found.reshape(-1, 3) for found in between(key, numbers.ravel(), numbers.ravel()))
    parent = np.flatnonzero(number.any(axis=1))
    if not len(parent):
        return faces
    side = np.argmax(number[parent] > 0, axis=1)
    start, number = start[parent, side], number[parent, side]
    a, b, c = (faces.triangles[parent, (side + k) % 3] for k in range(3))
    own = [faces.on_side[parent, (side + k) % 3] for k in range(3)]
    step, face = ranges(np.zeros_like(number), number + 1)

    def corner(step: np.ndarray) -> np.ndarray:
        """Return the vertices at position `step` along side ab, counted from end a."""
        inner = start[face] + np.where(a < b, 0, number - 1)[face] + np.where(a < b, 1, -1)[face] * (step - 1)
        within = vertex[np.clip(inner, 0, len(vertex) - 1)]
        return np.where(step == 0, a[face], np.where(step > number[face], b[face], within))

    triangles = np.stack((corner(step), corner(step + 1), c[face]), axis=1)
    on_side = np.stack((own[0][face], own[1][face] & (step == number[face]), own[2][face] & (step == 0)), axis=1)
    rest = faces.select(np.setdiff1d(np.arange(len(faces)), parent))
    return Stitched.joined((rest, Stitched(triangles, faces.origin[parent[face]], on_side)))
