"""One order for every listing of the same mesh: what comes out does not depend on how vertices and triangles came in.

Floating-point sums, splits of equal halves and choices among equals depend on the order in which things are met. So the
method works on meshes whose vertices and triangles lie in an order that only their places decide, and tells its
results in the numbers of the mesh that was given.
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
    """Where the parts of an ordered mesh come from.

    Attributes
    ----------
    vertex : (n,) int64, the given vertex that each ordered one is
    triangle : (m,) int64, the given triangle that each ordered one is
    first : (m,) int64, the corner of the given triangle that the ordered one begins with
    """

    vertex: np.ndarray
    triangle: np.ndarray
    first: np.ndarray

    @classmethod
    def unchanged(cls, mesh: TriangleMesh) -> Order:
        """That of a mesh which is taken as it is."""
        count = len(mesh.triangles)
        return cls(np.arange(len(mesh.positions)), np.arange(count), np.zeros(count, dtype=np.int64))


def ordered(mesh: TriangleMesh, *, shading: bool) -> tuple[TriangleMesh, Order]:
    """The mesh with its vertices sorted by x, y, z, each triangle begun at its lowest corner, and the triangles sorted
    by their corners.

    Parameters
    ----------
    mesh : TriangleMesh
    shading : bool
        Whether the normals matter, as a mirror's do. They tell doubled triangles apart then; the ordered mesh has none
        otherwise.

    Returns
    -------
    mesh : TriangleMesh
    order : Order
    """
    positions = mesh.positions + 0.0  # there is but one zero
    count = len(positions)
    by_place, new = _sorted_rows(list(positions.T))
    breathe()
    rank = np.empty(count, dtype=np.int64)
    rank[by_place] = np.cumsum(new)
    breathe()

    corner = rank[mesh.triangles]
    # of two corners in one place, that which the other follows
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

    # vertices in one place come in the order in which the triangles name them
    vertex, number = by_place, np.full(count, named.size)
    if not new[1:].all():
        np.minimum.at(number, named.ravel(), np.arange(named.size))
        vertex = np.lexsort((number, rank))
    number[vertex] = np.arange(count)
    breathe()
    mesh = mesh.like(positions[vertex], number[named], None if normals is None else normals[triangle])
    return mesh, Order(vertex, triangle, first)


def _sorted_rows(keys: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Order by the first key, of equals by the second and so on, and which rows in that order differ from the one
    before; a later key is looked at only where all before are equal."""
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
