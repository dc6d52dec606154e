"""Whether one surface goes on from one face of a result to another that lies beside it."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, area_normals, distinct, dot, edge_lengths, norm, rows
from ..result import ReflectionMesh
from ..support import breathe

ONWARD = 0.75  # pixels: between faces that show points farther apart than they move them by this the surface ends
CREASE = np.cos(np.radians(40.0))  # of the angle between surfaces that meet in a line, as wherever lines are told
TINY = 1e-9  # pixels: no face is told to be smaller


@dataclass(frozen=True)
class Surfaces:
    """Where vertices (n) are in the picture, `pixels` (n, 2), and what was reflected."""

    pixels: np.ndarray
    scene: TriangleMesh
    owner: np.ndarray

    def goes_on(self, mesh: ReflectionMesh, faces: tuple, ends: tuple) -> np.ndarray:
        """Whether one surface goes on from one of two faces (k,) each to the other, where a vertex (k,) of the one lies
        on a side of the other, from a start to an end."""
        one, other = (mesh.source_face[face] for face in faces)
        bounces = mesh.bounces
        assert bounces is not None  # every mesh has them
        found = (self.owner[one] == self.owner[other]) & (bounces[faces[0]] == bounces[faces[1]])
        some = np.flatnonzero(found)
        point, start, end = (mesh.reflected_position[vertex[some]].T for vertex in ends)
        way = end - start
        share = np.clip(dot(point - start, way) / np.maximum(dot(way, way), 1e-300), 0.0, 1.0)
        breathe()
        apart = norm(start + share * way - point)
        close = apart <= ONWARD * np.maximum(*(self._motion(mesh, face[some]) for face in faces))
        some = some[close]
        one, other = (area_normals(rows(self.scene.positions[self.scene.triangles[source[some]].T]))
                      for source in (one, other))
        found[:] = False
        found[some] = dot(one, other) >= CREASE * norm(one) * norm(other)
        return found

    def _motion(self, mesh: ReflectionMesh, face: np.ndarray) -> np.ndarray:
        """By how much the points that faces (k,) show are apart, for each pixel."""
        once, which = distinct(face)
        corners = mesh.triangles[once]
        return (edge_lengths(mesh.reflected_position[corners]).max(axis=1)
                / np.maximum(edge_lengths(self.pixels[corners]).max(axis=1), TINY))[which]
