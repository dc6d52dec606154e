"""Canonical order of a mesh, so that results do not depend on the input order of vertices and triangles.

Floating-point sums, splits into equal halves and choices among equal values depend on the order of the data. So the
method works on meshes whose vertices and triangles are sorted by their places only. Results refer to the indices of the
input mesh.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..support import breathe
from .subdivision import following
from .triangle_mesh import TriangleMesh

TURNS = np.array([[0, 1, 2], [1, 2, 0], [2, 0, 1]])


@dataclass(frozen=True)
class Order:
    """Mapping from an ordered mesh to the input mesh.

    Attributes
    ----------
    vertex : (n,) int64, input index of each ordered vertex
    triangle : (m,) int64, input index of each ordered triangle
    first : (m,) int64, corner of the input triangle, 0 to 2, that is the first corner of the ordered one
    """

    vertex: np.ndarray
    triangle: np.ndarray
    first: np.ndarray

    @classmethod
    def unchanged(cls, mesh: TriangleMesh) -> Order:
        """Return the identity mapping for a mesh that stays in its input order."""
        count = len(mesh.triangles)
        return cls(np.arange(len(mesh.positions)), np.arange(count), np.zeros(count, dtype=np.int64))


def ordered(mesh: TriangleMesh, *, shading: bool) -> tuple[TriangleMesh, Order]:
    """Sort a mesh: vertices by x, y, z, each triangle's corners from its lowest one on, and triangles by corners.

    Parameters
    ----------
    mesh : TriangleMesh
    shading : bool
        True to keep shading normals, as for a mirror. Duplicate triangles are then sorted by their normals. If False,
        the ordered mesh has no normals.

    Returns
    -------
    mesh : TriangleMesh
    order : Order
    """
    positions = mesh.positions + 0.0  # turn -0.0 into 0.0
    count = len(positions)
    by_place, new = _sorted_rows(list(positions.T))
    breathe()
    rank = np.empty(count, dtype=np.int64)
    rank[by_place] = np.cumsum(new)
    breathe()

    corner = rank[mesh.triangles]
    # if two corners share the lowest place, start at the one before the other
    first = np.argmin(corner * count + following(corner), axis=1)
    corner = np.take_along_axis(corner, TURNS[first], axis=1)
    breathe()
    keys = [corner[:, 0] * count + corner[:, 1], corner[:, 2]]
    normals = None
    if shading:
        normals = np.take_along_axis(mesh.corner_normals, TURNS[first][:, :, None], axis=1) + 0.0
        keys += list(normals.reshape(-1, 9).T)
    triangle, _ = _sorted_rows(keys)
    breathe()
    first = first[triangle]
    named = np.take_along_axis(mesh.triangles[triangle], TURNS[first], axis=1)
    breathe()

    # sort vertices at the same place by their first use in the triangles
    vertex, number = by_place, np.full(count, named.size)
    if not new[1:].all():
        np.minimum.at(number, named.ravel(), np.arange(named.size))
        vertex = np.lexsort((number, rank))
    number[vertex] = np.arange(count)
    breathe()
    mesh = mesh.like(positions[vertex], number[named], None if normals is None else normals[triangle])
    return mesh, Order(vertex, triangle, first)


def _sorted_rows(keys: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Sort rows by the first key (n,), equal ones by the second, and so on.

    Later keys are read only where all earlier ones are equal.

    Returns
    -------
    order : (n,) int64, indices of the sorted rows
    new : (n,) bool, True for sorted rows that differ from the previous one; False for the first
    """
    order = np.argsort(keys[0], kind="stable")
    breathe()
    values = keys[0][order]
    new = np.empty(len(order), dtype=bool)
    new[:1] = False
    np.not_equal(values[1:], values[:-1], out=new[1:])
    for key in keys[1:]:
        again = ~new
        again[:1] = False
        again[:-1] |= again[1:]
        at = np.flatnonzero(again)
        breathe()
        if not len(at):
            break
        run, values = np.cumsum(new)[at], key[order[at]]
        turned = np.lexsort((values, run))
        order[at], values = order[at[turned]], values[turned]
        new[at[1:]] |= values[1:] != values[:-1]
    return order, new
