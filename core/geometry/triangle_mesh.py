"""Triangle meshes with shading normals, for mirrors and for diffuse scenes."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..support import LARGEST, numbers, portions, whole_numbers
from .adjacency import corners_beyond
from .marked import mask
from .subdivision import next_corner
from .vectors import cross, largest, norm, rows

_UNIT_LENGTH = 2.0 ** -50
"""A vector that was divided by its length is as long as 1 to within 6 roundings: dividing once more would only move it,
and a mesh made of another one's normals would not be the same."""
_CHUNK = 8192
"""Triangles whose normals are worked out at once: their arrays stay in the caches."""
_NO_AREA = 1e-14
"""Of the square of its size: what the area of a triangle must be more than."""
_STRANGE = 1e100
"""Normals longer than this, or shorter than its inverse, have squares that are no numbers or have lost digits."""


@dataclass(frozen=True)
class TriangleMesh:
    """Triangles in world space, in scene units.

    Parameters
    ----------
    positions : (n, 3) float64
        No coordinate of a used vertex may be larger than 1e40.
    triangles : (m, 3) int64
        Indices into `positions`.
    corner_normals : (m, 3, 3) float64, optional
        Unit shading normal of each corner; equal normals at a shared vertex make the surface smooth there. If omitted
        or zero, the flat normals of the triangles are used. Only a mirror's normals matter.

    Raises
    ------
    ValueError
        If shapes or number types do not fit, an index is out of range, or a coordinate of a used vertex or a normal is
        not finite or is too large.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh
    >>> mesh = TriangleMesh(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    >>> mesh.corner_normals.shape, mesh.corner_normals[0, :, 2].tolist()
    ((1, 3, 3), [1.0, 1.0, 1.0])
    """

    positions: np.ndarray
    triangles: np.ndarray

    def __init__(self, positions: np.ndarray, triangles: np.ndarray, corner_normals: np.ndarray | None = None) -> None:
        positions = np.ascontiguousarray(numbers(
            positions, (None, 3), "The positions must be an (n, 3) array of numbers; give each vertex its x, y "
            "and z."))
        triangles = np.ascontiguousarray(whole_numbers(
            triangles, (None, 3), "The triangles must be an (m, 3) array of whole numbers; give each triangle "
            "three indices into the positions and cut larger faces into triangles."))
        if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(positions)):
            raise ValueError("A triangle names a vertex that the mesh does not have; rebuild the mesh.")
        _check_places(positions, triangles)
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "triangles", triangles)
        if corner_normals is None:
            return  # flat normals are computed on first use
        normals = numbers(corner_normals, (len(triangles), 3, 3), "The corner_normals must be an (m, 3, 3) "
                          "array of numbers; give three normals for each triangle, or none at all.")
        object.__setattr__(self, "corner_normals", _unit_normals(normals, positions, triangles))

    @staticmethod
    def joined(meshes: Iterable[TriangleMesh]) -> TriangleMesh:
        """Concatenate meshes into one; return an empty mesh if there are none."""
        meshes = list(meshes) if isinstance(meshes, Iterable) else [meshes]
        if not all(isinstance(mesh, TriangleMesh) for mesh in meshes):
            raise ValueError("The meshes to join must be a list of TriangleMesh; make one of each part first.")
        if len(meshes) == 1:
            return meshes[0]
        starts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
        return TriangleMesh(np.concatenate([np.zeros((0, 3)), *(mesh.positions for mesh in meshes)]),
                            np.concatenate([np.zeros((0, 3), dtype=np.int64),
                                            *(mesh.triangles + start for mesh, start in zip(meshes, starts))]),
                            np.concatenate([np.zeros((0, 3, 3)), *(mesh.corner_normals for mesh in meshes)]))

    def like(self, positions: np.ndarray, triangles: np.ndarray, corner_normals: np.ndarray | None) -> TriangleMesh:
        """Return a mesh of this one's parts in another order, without new checks.

        If `corner_normals` is None, the mesh has no normals, (0, 3, 3); callers must not use them.
        """
        mesh = object.__new__(TriangleMesh)
        normals = np.zeros((0, 3, 3)) if corner_normals is None else corner_normals
        for name, value in (("positions", positions), ("triangles", triangles), ("corner_normals", normals)):
            object.__setattr__(mesh, name, value)
        return mesh

    def face_normals(self) -> np.ndarray:
        """Return the unit normals (m, 3) of the flat triangles, zero for a triangle without an area.

        They are the same to the last bit for any first corner of a triangle. Reversing a triangle changes only the
        sign.
        """
        return self._face_normals

    @cached_property
    def _face_normals(self) -> np.ndarray:
        return _flat_normals(self.positions, self.triangles)

    @cached_property
    def corner_normals(self) -> np.ndarray:
        """Unit shading normals (m, 3, 3) of the corners; the flat triangles' normals if none are given."""
        return np.broadcast_to(self.face_normals()[:, None, :], (len(self.triangles), 3, 3))

    @cached_property
    def areal(self) -> np.ndarray:
        """True (m,) for triangles with an area above rounding."""
        found = np.empty(len(self.triangles), dtype=bool)
        for part in portions(len(found), _CHUNK):
            found[part] = areal(rows(self.positions.take(self.triangles[part].T, axis=0, mode="clip")))
        return found

    @cached_property
    def places(self) -> np.ndarray:
        """Index (n,) of the first vertex at the same place as each vertex; only for meshes in canonical order."""
        new = np.ones(len(self.positions), dtype=bool)
        new[1:] = (self.positions[1:] != self.positions[:-1]).any(axis=1)
        return np.flatnonzero(new)[np.cumsum(new) - 1]

    @cached_property
    def used(self) -> np.ndarray:
        """Indices of the vertices that triangles use, rising."""
        return np.flatnonzero(mask(len(self.positions), self.triangles))

    @cached_property
    def place_of(self) -> np.ndarray:
        """Number (n,) of each vertex's place, equal for vertices at one place: flat faces may not share vertices."""
        order = np.lexsort(self.positions.T[::-1])
        sorted_positions, number = self.positions[order], np.zeros(len(order), dtype=np.int64)
        number[order[1:]] = np.cumsum((sorted_positions[1:] != sorted_positions[:-1]).any(axis=1))
        return number

    @cached_property
    def beyond(self) -> np.ndarray:
        """For each corner (m, 3) the opposite corner of the neighbour across its opposite side, see `corners_beyond`.

        Vertices at one place count as one. Entries are indices into the flattened triangles, -1 for no neighbour, or
        more than one.
        """
        return corners_beyond(self.place_of[self.triangles])

    @property
    def neighbours(self) -> np.ndarray:
        """Index (m, 3) of the triangle across the side opposite to each corner; -1 for none, or more than one."""
        return self.beyond // 3

    @property
    def opposite_corners(self) -> np.ndarray:
        """Positions (m, 3, 3) of the opposite corner of the neighbour across each corner's opposite side.

        NaN where there is no neighbour, or more than one.
        """
        return np.where(self.beyond[:, :, None] >= 0, self.positions[self.triangles.ravel()[self.beyond]], np.nan)


def area_normals(corners: np.ndarray) -> np.ndarray:
    """Return normals (3, m) of triangles, with a length of twice their area.

    `corners` (3, 3, m) are [component, corner, triangle]. Because of rounding, the cross product of two edges depends
    on the corner at which they meet. This is always the lowest corner by x, y, z, whichever corner is first.
    """
    edge = np.stack([corners[:, next_corner(k)] - corners[:, k] for k in range(3)])
    # the sign of the first non-zero difference says which of two corners is lower
    way = [np.where(x != 0.0, x, np.where(y != 0.0, y, z)) for x, y, z in edge]
    first = (way[0] >= 0.0) & (way[2] <= 0.0)
    second = way[1] >= 0.0
    before = np.where(first, edge[2], np.where(second, edge[0], edge[1]))
    after = np.where(first, edge[0], np.where(second, edge[1], edge[2]))
    return cross(before, after)


def areal(corners: np.ndarray) -> np.ndarray:
    """Return True (m,) for triangles with `corners` (3, 3, m), [component, corner, triangle], with area above rounding.
    """
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return has_area(norm(cross(u, v)), largest(np.maximum(np.abs(u), np.abs(v))))


def has_area(area: np.ndarray, size: np.ndarray) -> np.ndarray:
    """Return True for triangles whose `area` is above rounding, relative to their `size` (largest edge component)."""
    return area > _NO_AREA * size**2


def _flat_normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    normals = np.empty((len(triangles), 3))
    for part in portions(len(triangles), _CHUNK):
        # the indices are valid: `take` without bounds errors is faster
        normal = area_normals(rows(positions.take(triangles[part].T, axis=0, mode="clip")))
        length = norm(normal)
        normals[part] = (normal / np.where(length > 0.0, length, 1.0)).T
    return normals


def _check_places(positions: np.ndarray, triangles: np.ndarray) -> None:
    with np.errstate(invalid="ignore"):
        if -LARGEST <= positions.min(initial=0.0) and positions.max(initial=0.0) <= LARGEST:
            return
    # unused vertices are not checked; a mesh without triangles is checked except for non-finite vertices
    used = positions[triangles] if len(triangles) else positions[np.isfinite(positions).all(axis=1)]
    if not np.isfinite(used).all():
        raise ValueError("A vertex has a coordinate that is not a finite number; remove or repair it.")
    if np.abs(used).max(initial=0.0) > LARGEST:
        raise ValueError("A vertex has a coordinate larger than 1e40; move it nearer or make the scene smaller.")


def _unit_normals(normals: np.ndarray, positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Normalise `normals` (m, 3, 3); normals of length zero are replaced by the flat triangle's."""
    if not np.isfinite(normals).all():
        raise ValueError("A shading normal is not a finite number; recalculate the normals.")
    with np.errstate(over="ignore"):
        length = np.linalg.norm(normals, axis=2, keepdims=True)
    strange = (length > _STRANGE) | (length < 1.0 / _STRANGE)
    if strange.any():
        # scaling by a power of two is exact
        power = np.frexp(np.abs(normals).max(axis=2, keepdims=True))[1]
        normals = np.where(strange, np.ldexp(normals, -power), normals)
        length = np.where(strange, np.linalg.norm(normals, axis=2, keepdims=True), length)
    length[np.abs(length - 1.0) <= _UNIT_LENGTH] = 1.0
    none = length[:, :, 0] == 0.0
    normals = normals / np.where(none[:, :, None], 1.0, length)
    flat = np.flatnonzero(none.any(axis=1))
    normals[none] = np.repeat(_flat_normals(positions, triangles[flat]), none[flat].sum(axis=1), axis=0)
    return normals
