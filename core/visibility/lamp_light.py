"""What a lamp sees of a mirror: nothing behind what stands before it, and in each of its views its own part alone."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, with_pieces
from ..geometry import LampView, TriangleMesh, View, has_area
from ..polygons import ConvexPolygons, Line


def with_shades(view: View, mirror: TriangleMesh, faces: np.ndarray) -> tuple[TriangleMesh, np.ndarray]:
    """The mirror with what may stand before it, behind its own triangles, and which triangles may be seen, `faces` of
    the mirror and all that shade."""
    if not isinstance(view, LampView) or view.shades is None or not len(view.shades.triangles):
        return mirror, faces
    shades = view.shades
    corners = shades.positions[shades.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = np.abs(corners - corners[:, :1]).max(axis=(1, 2))
    across = np.einsum("ij,ij->i", view.directions(corners[:, 0]), normals) != 0.0
    chosen = np.flatnonzero(has_area(np.linalg.norm(normals, axis=1), size) & across)
    return TriangleMesh.joined((mirror, shades)), np.concatenate((faces, len(mirror.triangles) + chosen))


def cut_at_borders(cameras: Cameras) -> Cameras:
    """The cameras; of a lamp's view those across the borders of its picture without what lies beyond."""
    view = cameras.view
    if not isinstance(view, LampView):
        return cameras
    x, y, _, w = np.moveaxis(view.clip(cameras.places.T)[cameras.corners.T], 2, 0)
    sides = w - x, w + x, w - y, w + y
    whole = np.all([(side >= 0.0).all(axis=0) for side in sides], axis=0)
    across = np.flatnonzero(~whole)
    pieces = ConvexPolygons.whole(len(across))
    for side in sides:
        pieces = pieces.cut(side[:, across], Line.HIDDEN)
    parent, weights = pieces.triangles()
    return with_pieces(cameras, whole, across[parent], weights)[0]
