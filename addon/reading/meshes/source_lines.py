"""The lines of a mesh, which its reflection must show as lines: sharp edges, creases, edges marked for Freestyle."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ... import compat
from .creases import Creases


@dataclass(frozen=True)
class SourceLines:
    """The edges (e) of a mesh, its faces (p), and where both are in its triangles (m).

    Attributes
    ----------
    side : (m, 3) int32
        The edge from each corner of a triangle to the next, -1 where a triangle cuts through a face.
    face : (m,) int32
        The face of each triangle.
    sharp_edges, marked_edges : (e,) bool
    sharp_faces, marked_faces : (p,) bool
    meeting : (2, c) int32
        The faces on both sides of an edge that has two.
    meeting_of : (e,) int32
        Where each edge is among those, -1 where it is not.
    normals : (p, 3) float32
        Of the faces.
    """

    side: np.ndarray
    face: np.ndarray
    sharp_edges: np.ndarray
    marked_edges: np.ndarray
    sharp_faces: np.ndarray
    marked_faces: np.ndarray
    meeting: np.ndarray
    meeting_of: np.ndarray
    normals: np.ndarray

    @classmethod
    def of(cls, mesh: bpy.types.Mesh, corners: np.ndarray, face: np.ndarray) -> SourceLines:
        """The lines of a mesh with triangles of the face `corners` (m, 3) in the faces `face` (m,)."""
        edges, faces = len(mesh.edges), len(mesh.polygons)
        edge = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_edge"].data.foreach_get("value", edge)
        start, total = (np.empty(faces, dtype=np.int32) for _ in range(2))
        mesh.polygons.foreach_get("loop_start", start)
        mesh.polygons.foreach_get("loop_total", total)
        following = np.arange(1, len(edge) + 1, dtype=np.int32)
        following[start + total - 1] = start
        side = np.where(following[corners] == np.roll(corners, -1, axis=1), edge[corners], -1)
        # of the edges with two faces, the first and the last in the order of corners
        owner = np.repeat(np.arange(faces, dtype=np.int32), total)
        meeting = np.zeros((2, edges), dtype=np.int32)
        meeting[0, edge[::-1]], meeting[1, edge] = owner[::-1], owner
        two = np.flatnonzero(np.bincount(edge, minlength=edges) == 2).astype(np.int32)
        meeting_of = np.full(edges, -1, dtype=np.int32)
        meeting_of[two] = np.arange(len(two), dtype=np.int32)
        normals = np.empty((faces, 3), dtype=np.float32)
        mesh.polygon_normals.foreach_get("vector", normals.reshape(-1))
        return cls(side, face, _flags(mesh, "sharp_edge", "EDGE", edges), compat.freestyle_marks(mesh, "EDGE"),
                   _flags(mesh, "sharp_face", "FACE", faces), compat.freestyle_marks(mesh, "FACE"),
                   meeting[:, two], meeting_of, normals)

    def creases(self, cofactors: np.ndarray) -> Creases:
        """The creases where the mesh stands in places with the `cofactors` (k, 3, 3) that take its normals there."""
        return Creases.of(self.meeting, self.meeting_of, self.normals, cofactors)

    def sharp_sides(self, triangle: np.ndarray, creases: Creases, place: np.ndarray) -> np.ndarray:
        """Which sides (n, 3) of triangles (n,) are sharp or creased, where the mesh stands in the places (n,)."""
        side = self.side[triangle]
        return (self.sharp_edges[side] | creases.among(side, place)) & (side >= 0)

    def marked_sides(self, triangle: np.ndarray) -> np.ndarray:
        """Which sides (n, 3) of triangles (n,) are marked."""
        side = self.side[triangle]
        return self.marked_edges[side] & (side >= 0)


def _flags(mesh: bpy.types.Mesh, name: str, domain: str, count: int) -> np.ndarray:
    """A boolean attribute; nowhere true where the mesh has none."""
    values = np.zeros(count, dtype=bool)
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.data_type == "BOOLEAN" and attribute.domain == domain:
        attribute.data.foreach_get("value", values)
    return values
