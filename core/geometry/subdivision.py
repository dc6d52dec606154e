"""Subdivision of triangles at the midpoints of marked edges, the same way on both sides of an edge."""
from __future__ import annotations

from typing import TypeVar

import numpy as np

from .distinct import first_of

Corner = TypeVar("Corner", int, np.ndarray)

# Children for each set of marked edges (bit k: edge k), with corners 0 1 2 and midpoints 3 4 5 of edges 01, 12, 20.
_TEMPLATES = {
    0b001: [(0, 3, 2), (3, 1, 2)],
    0b010: [(0, 1, 4), (0, 4, 2)],
    0b100: [(0, 1, 5), (5, 1, 2)],
    0b011: [(3, 1, 4), (0, 3, 4), (0, 4, 2)],
    0b110: [(5, 4, 2), (0, 1, 4), (0, 4, 5)],
    0b101: [(0, 3, 5), (3, 1, 2), (3, 2, 5)],
    0b111: [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)],
}


def following(values: np.ndarray, axis: int = 1) -> np.ndarray:
    """Return for each corner of triangles the value of the next corner; `axis` is the corners' axis, of length 3."""
    return np.roll(values, -1, axis=axis)


def next_corner(corner: Corner) -> Corner:
    """Return the next corner, 0 to 2, after a `corner`: the other end of the side that starts there."""
    return (corner + 1) % 3


def others(corner: Corner) -> tuple[Corner, Corner]:
    """Return the other two corners, in cyclic order: the ends of the side opposite to a `corner`, 0 to 2."""
    return next_corner(corner), (corner + 2) % 3


def edge_numbers(one: np.ndarray, other: np.ndarray, count: int) -> np.ndarray:
    """Return a unique number for each edge between two of `count` vertices, the same for both directions.

    It is the lower vertex index times `count`, plus the higher index.
    """
    return np.minimum(one, other) * count + np.maximum(one, other)


def split(marked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Subdivide triangles at the midpoints of marked edges.

    Parameters
    ----------
    marked : (n, 3) bool, True for the edges 01, 12 and 20 of each triangle that are split

    Returns
    -------
    parent : (m,) int64, the triangle that each child lies in; an unmarked triangle has itself as its only child
    local : (m, 3) int64
        The child's corners: 0, 1, 2 are the parent's corners, 3, 4, 5 the midpoints of its edges 01, 12, 20.
    """
    case = marked[:, 0] + 2 * marked[:, 1] + 4 * marked[:, 2]
    whole = np.flatnonzero(case == 0)
    parents, locals_ = [whole], [np.broadcast_to(np.arange(3), (len(whole), 3))]
    for bits, children in _TEMPLATES.items():
        chosen = np.flatnonzero(case == bits)
        if len(chosen):
            parents.append(np.repeat(chosen, len(children)))
            locals_.append(np.tile(np.array(children), (len(chosen), 1)))
    return np.concatenate(parents), np.concatenate(locals_)


# The parent's edge that a child's edge between two local corners lies on: 0, 1, 2, or 3 for the inside.
_SIDES = np.full((6, 6), 3)
for _edge, _line in enumerate(((0, 3, 1), (1, 4, 2), (2, 5, 0))):
    for _a in _line:
        for _b in _line:
            _SIDES[_a, _b] = _edge


def parent_side(local: np.ndarray) -> np.ndarray:
    """Return the parent's edge (m, 3) that each of the edges 01, 12, 20 of the children lies on, 3 if it is inside."""
    return _SIDES[local, following(local)]


def edge_lengths(corners: np.ndarray) -> np.ndarray:
    """Return the lengths (n, 3) of the edges 01, 12 and 20 of triangles with `corners` (n, 3, d)."""
    return np.linalg.norm(corners - following(corners), axis=2)


def doubled_areas(corners: np.ndarray) -> np.ndarray:
    """Return twice the signed areas (n,) of triangles with `corners` (n, 3, 2), negative if clockwise."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def areas(corners: np.ndarray) -> np.ndarray:
    """Return the areas (n,) of triangles in space with `corners` (n, 3, 3)."""
    a, b, c = np.moveaxis(corners, 1, 0)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def solid_angles(point: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return the signed solid angles (n,) of triangles with `corners` (n, 3, 3), seen from a `point` (3,).

    For a closed surface, their sum divided by 4 pi is the winding number of the point.

    A. van Oosterom, J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 1983.
    """
    ways = corners - point
    ways = ways / np.maximum(np.linalg.norm(ways, axis=2, keepdims=True), 1e-300)
    a, b, c = np.moveaxis(ways, 1, 0)
    # differences of neighbouring directions keep the precision for small triangles
    triple = np.einsum("ij,ij->i", a, np.cross(b - a, c - a))
    return 2.0 * np.arctan2(triple, 1.0 + (a * b).sum(axis=1) + (b * c).sum(axis=1) + (c * a).sum(axis=1))


def shared_edges(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the edges of triangles (n, 3), without duplicates.

    Returns
    -------
    ends : (e, 2) int64, smaller index first
    first : (e,) int64, an entry of the flattened (n, 3) edges 01, 12, 20 where the edge occurs
    edge : (n, 3) int64, index into `ends` of each triangle's edges
    """
    count = int(triangles.max(initial=0)) + 1
    keys, first, edge = first_of(edge_numbers(triangles, following(triangles), count).ravel())
    return np.stack((keys // count, keys % count), axis=1), first, edge.reshape(-1, 3)
