"""Test if one surface continues from a face of a result to a neighbouring face."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, area_normals, distinct, dot, edge_lengths, norm, rows
from ..result import ReflectionMesh
from ..support import breathe

ONWARD = 0.75  # pixels: largest gap between the points that two faces show, in image scale, on one surface
CREASE = np.cos(np.radians(40.0))  # cosine of the crease angle: neighbouring triangles with a larger angle have a line
TINY = 1e-9  # pixels: lower bound for the size of a face, to avoid division by zero


@dataclass(frozen=True)
class Surfaces:
    """Data to test if a surface continues between two faces.

    Attributes
    ----------
    pixels : (n, 2) float64, vertices of the result in the picture
    scene : TriangleMesh, the reflected scene
    owner : (s,) int, object number of each triangle of the scene
    """

    pixels: np.ndarray
    scene: TriangleMesh
    owner: np.ndarray

    def goes_on(self, mesh: ReflectionMesh, faces: tuple, ends: tuple) -> np.ndarray:
        """Return True (k,) for pairs of faces that show one continuous surface.

        Parameters
        ----------
        faces : tuple, two faces (k,) each
        ends : tuple, (k,) each
            A vertex of the first face, and the start and the end of the second face's side that it lies on.
        """
        one, other = (mesh.source_face[face] for face in faces)
        bounces = mesh.bounces
        assert bounces is not None  # every result mesh has them
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
        """Return the distance (k,) between reflected points per pixel for faces `face` (k,), in scene units."""
        once, which = distinct(face)
        corners = mesh.triangles[once]
        return (edge_lengths(mesh.reflected_position[corners]).max(axis=1)
                / np.maximum(edge_lengths(self.pixels[corners]).max(axis=1), TINY))[which]
