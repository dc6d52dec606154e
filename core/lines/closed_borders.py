"""Stitching of neighbouring faces that show one continuous surface, so that they share vertices.

Unclipped triangles, faces clipped by cameras and cells sampled by rays are computed part by part. Two parts may each
have a vertex at one place of the picture, or one part a vertex on a side of the other. This is invisible in the
picture, but line drawing would treat such sides as the end of the surface.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..geometry import TriangleMesh, distinct, groups
from ..result import ReflectionMesh
from ..support import breathe
from ..views import View
from .joined_places import with_places_joined
from .split_sides import with_sides_split
from .surfaces import Surfaces

ROUNDS = 3  # rounds of splitting; each round splits a face along one of its sides


def with_borders_closed(mesh: ReflectionMesh, view: View, scene: TriangleMesh, owner: np.ndarray) -> ReflectionMesh:
    """Return the result with shared vertices wherever a surface continues from one face to the next.

    Parameters
    ----------
    mesh : ReflectionMesh
        A result with faces.
    view : View
        The view of the result.
    scene : TriangleMesh
        The reflected scene.
    owner : (s,) int
        Object number of each triangle of the scene: between two objects there is a line.

    Returns
    -------
    ReflectionMesh
        Duplicate vertices are merged. Faces with a vertex of another face on a side are split there.

    Examples
    --------
    >>> import numpy as np
    >>> from core import TriangleMesh, View, reflect, with_borders_closed
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4]]), np.array([[0, 1, 2]]))
    >>> mesh = reflect(view, mirror, scene)
    >>> closed = with_borders_closed(mesh, view, scene, np.zeros(1, dtype=int))
    >>> len(closed.triangles) == len(mesh.triangles)  # all of it hangs together as it is
    True
    """
    surfaces = Surfaces(view.pixels(mesh.positions), scene, owner)
    closed = with_places_joined(mesh, surfaces)
    waiting = np.ones(len(closed.triangles), dtype=bool)
    for _ in range(ROUNDS):
        if not waiting.any():
            break
        closed, waiting = with_sides_split(closed, surfaces, waiting)
    if closed is mesh:
        return mesh
    # drop duplicate faces on the same vertices, as from slivers that closed a gap
    once, _ = groups(*np.sort(closed.triangles, axis=1).T)
    once.sort()
    closed = replace(closed, triangles=closed.triangles[once], **closed.of_faces(once))
    kept, corners = distinct(closed.triangles.ravel())
    breathe()
    return replace(closed, triangles=corners.reshape(-1, 3), **closed.of_vertices(kept))
