"""Parts of a mirror that a lamp lights: not shadowed by other objects, and within the borders of the lamp's view."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, not_edge_on, with_pieces
from ..geometry import TriangleMesh
from ..polygons import ConvexPolygons, Line
from ..views import LampView, View


def with_shades(view: View, mirror: TriangleMesh, faces: np.ndarray) -> tuple[TriangleMesh, np.ndarray]:
    """Append the occluders of a lamp's view to the mirror.

    Parameters
    ----------
    faces : (n,) int64, triangles of the mirror that may be seen

    Returns
    -------
    mesh : TriangleMesh, the mirror's triangles, then the occluders'
    chosen : (m,) int64, triangles of it that may be seen: `faces`, and the occluders that are not edge on
    """
    if not isinstance(view, LampView) or view.shades is None or not len(view.shades.triangles):
        return mirror, faces
    shades = view.shades
    chosen = np.flatnonzero(not_edge_on(view, shades))
    return TriangleMesh.joined((mirror, shades)), np.concatenate((faces, len(mirror.triangles) + chosen))


def lit(cameras: Cameras) -> np.ndarray:
    """Return True for cameras (n,) that the lamp's light may reach; for all if the view is not a lamp's."""
    if not isinstance(cameras.view, LampView):
        return np.ones(len(cameras), dtype=bool)
    return cameras.view.lights(np.take(cameras.places, cameras.corners.T, axis=1))


def cut_at_borders(cameras: Cameras) -> Cameras:
    """Cut cameras of a lamp's view at the borders of its picture; drop the parts beyond. Other views keep theirs."""
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
    return with_pieces(cameras, whole, across[parent], weights)
