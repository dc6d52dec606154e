"""Opacity of scene triangles to reflected rays and to view rays."""
from __future__ import annotations

from enum import IntEnum


class Opacity(IntEnum):
    """Opacity of a triangle of the scene: which rays it stops, and whether it is visible itself.

    Attributes
    ----------
    CLEAR
        All rays pass through it, and layers may cover it without a visible loss, for example clear glass.
    UNSEEN
        View rays pass through it and mirrors show it, for example a wall that is hidden from the camera.
    OPEN
        All rays pass through it, but it is visible itself, for example films, leaves and tinted panes.
    OPAQUE
        All rays end at it.

    Examples
    --------
    >>> import numpy as np
    >>> from core import Opacity, TriangleMesh, View, reflect
    >>> view = View.looking_at((0, -4, 3), (0, 0, 0), (320, 240))
    >>> mirror = TriangleMesh(np.array([[-2, -2, 0], [2, -2, 0], [0, 2, 0]]), np.array([[0, 1, 2]]))
    >>> pane = [[-2, -2, 0.001], [2, -2, 0.001], [0, 2, 0.001]]
    >>> scene = TriangleMesh(np.array([[0, 0, 1], [0.3, 0, 1], [0, 0, 1.4], *pane]), np.array([[0, 1, 2], [3, 4, 5]]))
    >>> opacity = [Opacity.OPAQUE, Opacity.CLEAR]
    >>> np.unique(reflect(view, mirror, scene, opacity=opacity).source_face).tolist()
    [0, 1]
    """

    CLEAR = 0
    UNSEEN = 1
    OPEN = 2
    OPAQUE = 3
