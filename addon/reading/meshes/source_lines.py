"""The lines of a mesh that its reflection must also show: sharp edges, creases, and edges marked for Freestyle."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ... import compat
from .creases import Creases


@dataclass(frozen=True)
class SourceLines:
    """The e edges and p faces of a mesh, and their indices at its m triangles.

    Attributes
    ----------
    side : (m, 3) int32
        The edge from each corner of a triangle to the next, -1 for diagonals inside a face.
    face : (m,) int32
        The face of each triangle.
    sharp_edges, marked_edges : (e,) bool
    sharp_faces, marked_faces : (p,) bool
    meeting : (2, c) int32
        The faces on both sides of each edge that has two.
    meeting_of : (e,) int32
        Column of each edge in `meeting`, -1 for edges without two faces.
    normals : (p, 3) float32
        Normals of the faces.
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
        """Read the lines of a mesh. Its m triangles have the face `corners` (m, 3) and lie in the faces `face` (m,)."""
        edges, faces = len(mesh.edges), len(mesh.polygons)
        edge = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_edge"].data.foreach_get("value", edge)
        start, total = (np.empty(faces, dtype=np.int32) for _ in range(2))
        mesh.polygons.foreach_get("loop_start", start)
        mesh.polygons.foreach_get("loop_total", total)
        following = np.arange(1, len(edge) + 1, dtype=np.int32)
        following[start + total - 1] = start
        side = np.where(following[corners] == np.roll(corners, -1, axis=1), edge[corners], -1)
        # find the first and the last face of each edge, in the order of corners, for edges with two faces
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
        """Return the creases for placements whose matrices `cofactors` (k, 3, 3) transform normals to world space."""
        return Creases.of(self.meeting, self.meeting_of, self.normals, cofactors)

    def sharp_sides(self, triangle: np.ndarray, creases: Creases, place: np.ndarray) -> np.ndarray:
        """Return True (n, 3) for sides of `triangle` (n,) that are sharp edges, or creases in the placements `place`
        (n,).
        """
        side = self.side[triangle]
        return (self.sharp_edges[side] | creases.among(side, place)) & (side >= 0)

    def marked_sides(self, triangle: np.ndarray) -> np.ndarray:
        """Return True (n, 3) for sides of `triangle` (n,) that are marked for Freestyle."""
        side = self.side[triangle]
        return self.marked_edges[side] & (side >= 0)


def _flags(mesh: bpy.types.Mesh, name: str, domain: str, count: int) -> np.ndarray:
    """Return a boolean attribute (count,); all False if the mesh does not have it."""
    values = np.zeros(count, dtype=bool)
    attribute = mesh.attributes.get(name)
    if attribute is not None and attribute.data_type == "BOOLEAN" and attribute.domain == domain:
        attribute.data.foreach_get("value", values)
    return values
