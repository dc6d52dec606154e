"""Borders between faces that lie side by side and show one surface going on, closed: such faces share vertices.

What is drawn whole, what cameras cut and what rays show is worked out part by part. Two parts may have a vertex each in
one place of the picture, or one of them a vertex on a side of the other. No pixel tells that, but who draws lines takes
such sides for the end of the surface.
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

ROUNDS = 3  # of splitting faces, each along one of its sides


def with_borders_closed(mesh: ReflectionMesh, view: View, scene: TriangleMesh, owner: np.ndarray) -> ReflectionMesh:
    """A result with faces that share vertices wherever what they show goes on from one to the other.

    Parameters
    ----------
    mesh : ReflectionMesh
        With faces.
    view : View
        The eye that it was made for.
    scene : TriangleMesh
        What was reflected.
    owner : (s,) int
        Which object each of its triangles is of: between two there is a line.

    Returns
    -------
    ReflectionMesh
        Vertices that others stand for are left out, and faces with a vertex of another on a side are split.

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
    # of two faces on the same vertices, as slivers that closed a gap are then, one is enough
    once, _ = groups(*np.sort(closed.triangles, axis=1).T)
    once.sort()
    closed = replace(closed, triangles=closed.triangles[once], **closed.of_faces(once))
    kept, corners = distinct(closed.triangles.ravel())
    breathe()
    return replace(closed, triangles=corners.reshape(-1, 3), **closed.of_vertices(kept))
