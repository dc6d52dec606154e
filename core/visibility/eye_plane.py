"""The eye's plane: of mirrors that run on behind the eye, only what lies before it is seen.

Nothing on the plane of a perspective eye has a place in the picture, and what lies behind it would have a wrong one.
So cameras, and the triangles that may hide them, are cut before it. An orthographic eye sees from its plane on. What
a perspective eye sees of a triangle lies no nearer to its plane than the triangle's plane lies to the eye, times the
cosine of the angle to the picture's corners; half of that is left out of the picture, but has a place in it.
"""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, with_pieces
from ..geometry import TriangleMesh, cross, dot, norm, rows
from ..polygons import ConvexPolygons, Line
from ..views import View

ON_PLANE = 1e-12  # share of the distance from an orthographic eye: points nearer to its plane lie on it by rounding
LEAST = 0.5  # share of the least depth that a perspective eye can see of a triangle: the triangle is cut there


def cut_before_eye(cameras: Cameras) -> Cameras:
    """Cut cameras that cross the eye's plane; return all cameras without their parts behind that plane."""
    view = cameras.view
    whole, parent, weights = _before(view, cameras.places[:, cameras.corners.T])
    return cameras if whole.all() else with_pieces(cameras, whole, parent, weights)


def triangles_before_eye(view: View, mesh: TriangleMesh, chosen: np.ndarray) -> tuple[TriangleMesh, np.ndarray]:
    """Return the parts before the eye of the triangles `chosen` (n,) of a mesh.

    Returns
    -------
    parts : TriangleMesh, without normals
    owner : (m,) int64, triangle of `mesh` that each triangle of `parts` is a part of
    """
    corners = rows(mesh.positions[mesh.triangles[chosen].T])
    whole, parent, weights = _before(view, corners)
    if not len(parent):
        return mesh.like(mesh.positions, mesh.triangles[chosen], None), chosen
    places = np.einsum("xjn,jkn->nkx", corners[:, :, parent], weights).reshape(-1, 3)
    new = len(mesh.positions) + np.arange(len(places)).reshape(-1, 3)
    parts = mesh.like(np.concatenate((mesh.positions, places)),
                      np.concatenate((mesh.triangles[chosen[whole]], new)), None)
    return parts, np.concatenate((chosen[whole], chosen[parent]))


def _before(view: View, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Clip triangles with `corners` (3, 3, n), as [component, corner, triangle], against the eye's plane.

    Returns
    -------
    whole : (n,) bool, True for triangles that lie entirely before the eye
    parent : (m,) int64, triangle of each part of the others
    weights : (3, 3, m) float64, barycentric coordinates of the parts' corners, entry [i, k]: weight i of corner k
    """
    count = corners.shape[2]
    depth = view.depths(corners.reshape(3, -1).T).reshape(3, count)
    whole = np.all(depth > 0.0, axis=0)
    across = np.flatnonzero(~whole & (depth > 0.0).any(axis=0))
    ahead = depth[:, across] - _least_depth(view, corners[:, :, across])
    parent, weights = ConvexPolygons.whole(len(across)).cut(ahead, Line.HIDDEN).triangles()
    return whole, across[parent], weights


def _least_depth(view: View, corners: np.ndarray) -> np.ndarray:
    """Return the depth (n,) at which to cut each triangle: nearer parts cannot be in the picture.

    `corners` (3, 3, n) are those of the triangles, as [component, corner, triangle].
    """
    if view.orthographic:
        return ON_PLANE * np.abs(corners - view.eye[:, None, None]).max(axis=(0, 1))
    a, b, c = np.moveaxis(corners, 1, 0)
    normal = cross(b - a, c - a)
    height = np.abs(dot(normal, a - view.eye[:, None])) / np.maximum(norm(normal), 1e-300)
    width, top = view.resolution
    _, towards = view.rays(np.array([(0, 0), (width, 0), (0, top), (width, top)], dtype=np.float64))
    return LEAST * (towards @ view.forward).min() * height
