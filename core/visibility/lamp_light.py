"""What a lamp sees of a mirror: nothing behind what stands before it, and in each of its views its own part alone."""
from __future__ import annotations

import numpy as np

from ..cameras import Cameras, not_edge_on, with_pieces
from ..geometry import TriangleMesh
from ..polygons import ConvexPolygons, Line
from ..views import LampView, View


def with_shades(view: View, mirror: TriangleMesh, faces: np.ndarray) -> tuple[TriangleMesh, np.ndarray]:
    """The mirror with what may stand before it, behind its own triangles, and which triangles may be seen, `faces` of
    the mirror and all that shade."""
    if not isinstance(view, LampView) or view.shades is None or not len(view.shades.triangles):
        return mirror, faces
    shades = view.shades
    chosen = np.flatnonzero(not_edge_on(view, shades))
    return TriangleMesh.joined((mirror, shades)), np.concatenate((faces, len(mirror.triangles) + chosen))


def lit(cameras: Cameras) -> np.ndarray:
    """Which cameras (n,) a lamp's light may fall on, if the view is a lamp's."""
    if not isinstance(cameras.view, LampView):
        return np.ones(len(cameras), dtype=bool)
    return cameras.view.lights(np.take(cameras.places, cameras.corners.T, axis=1))


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
    return with_pieces(cameras, whole, across[parent], weights)
