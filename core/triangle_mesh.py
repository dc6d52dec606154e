"""Triangles with shading normals: what both the mirror and the diffuse scene are made of."""
from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_UNIT_LENGTH = 2.0 ** -50
"""A vector that was divided by its length is as long as 1 to within 6 roundings: dividing once more would only move it,
and a mesh made of another one's normals would not be the same."""


@dataclass(frozen=True)
class TriangleMesh:
    """Triangles in world space, in scene units.

    Parameters
    ----------
    positions : (n, 3) float64
    triangles : (m, 3) int64
        Indices into `positions`.
    corner_normals : (m, 3, 3) float64, optional
        Unit shading normal of each corner; equal normals at a shared vertex make the surface smooth there. The flat
        normals of the triangles where omitted. Only a mirror's are used.

    Raises
    ------
    ValueError
        Where shapes do not fit, an index is out of range, or a coordinate of a used vertex or normal is not finite.
    """

    positions: np.ndarray
    triangles: np.ndarray
    corner_normals: np.ndarray | None = None

    def __post_init__(self) -> None:
        positions = np.ascontiguousarray(self.positions, dtype=np.float64).reshape(-1, 3)
        triangles = np.ascontiguousarray(self.triangles, dtype=np.int64).reshape(-1, 3)
        if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(positions)):
            raise ValueError("A triangle names a vertex that the mesh does not have; rebuild the mesh.")
        if not np.isfinite(positions[triangles]).all():
            raise ValueError("A vertex has a coordinate that is not a finite number; remove or repair it.")
        object.__setattr__(self, "positions", positions)
        object.__setattr__(self, "triangles", triangles)
        if self.corner_normals is None:
            normals = np.repeat(self.face_normals()[:, None, :], 3, axis=1)
        else:
            normals = np.array(self.corner_normals, dtype=np.float64).reshape(-1, 3, 3)
            if normals.shape[0] != len(triangles):
                raise ValueError("corner_normals must hold three normals for each triangle.")
            if not np.isfinite(normals).all():
                raise ValueError("A shading normal is not a finite number; recalculate the normals.")
            length = np.linalg.norm(normals, axis=2, keepdims=True)
            length[np.abs(length - 1.0) <= _UNIT_LENGTH] = 1.0
            flat = self.face_normals()[:, None, :]
            normals = np.where(length > 0.0, normals / np.where(length > 0.0, length, 1.0), flat)
        object.__setattr__(self, "corner_normals", normals)

    @staticmethod
    def joined(meshes: Sequence[TriangleMesh]) -> TriangleMesh:
        """One mesh of several, their triangles one behind another."""
        if len(meshes) == 1:
            return meshes[0]
        starts = np.cumsum([0] + [len(mesh.positions) for mesh in meshes])
        return TriangleMesh(np.concatenate([mesh.positions for mesh in meshes]),
                            np.concatenate([mesh.triangles + start for mesh, start in zip(meshes, starts)]),
                            np.concatenate([mesh.corner_normals for mesh in meshes]))

    def like(self, positions: np.ndarray, triangles: np.ndarray, corner_normals: np.ndarray) -> TriangleMesh:
        """A mesh of this one's parts in another order, which need not be checked again."""
        mesh = object.__new__(TriangleMesh)
        for name, value in (("positions", positions), ("triangles", triangles), ("corner_normals", corner_normals)):
            object.__setattr__(mesh, name, value)
        return mesh

    def face_normals(self) -> np.ndarray:
        """Unit normals (m, 3) of the flat triangles, zero where a triangle has no area."""
        a, b, c = (self.positions[self.triangles[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        length = np.linalg.norm(normals, axis=1, keepdims=True)
        return normals / np.where(length > 0.0, length, 1.0)
