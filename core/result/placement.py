"""Placement: where along its view ray each node is drawn.

LAYERED keeps the picture and orders the layers. Along a view ray the virtual image of a point at path s R lies 1 + s
times as far as the mirror. A node goes to k = 1 / (1 + gap + depth / (1 + s)) times that distance: 1 / k is an affine
function of 1 / (1 + s), a projective map that keeps straight lines straight, so that the layers of flat surfaces in a
flat mirror stay flat, and nearer paths come nearer to the eye everywhere, not only at the nodes.
"""
from __future__ import annotations

import numpy as np

from ..geometry import norm
from ..views import View

GAP = 2e-4  # share of the viewing distance kept free before the mirror
DEPTH = 2e-3  # share of the viewing distance over which the layers spread


def place(view: View, places: np.ndarray, path_length: np.ndarray, placement: str, reach: float = 0.0,
          share: float = 1.0) -> np.ndarray:
    """Compute world positions (3, n) at which to draw nodes that are seen at `places` (3, n) on the mirror.

    Parameters
    ----------
    path_length : (n,) float64, from the mirror to the reflected point over all bounces, in scene units
    placement : {'LAYERED', 'SURFACE', 'VIRTUAL'}
    reach : float, length of a path over which the layers of an orthographic view spread at least
    share : float, factor on `GAP` and `DEPTH` for LAYERED
    """
    if placement == "SURFACE" or not len(path_length):
        return places
    ahead = view.directions(places.T).T
    distance = path_length / norm(ahead)
    if placement == "VIRTUAL":
        return places + ahead * distance
    if view.orthographic:
        size = share * np.ptp(places, axis=1).max()
        return places - size * (GAP + DEPTH * (1.0 - path_length / max(path_length.max(), reach, 1e-300))) * ahead
    nearer = share * (GAP + DEPTH / (1.0 + distance))
    return places - nearer / (1.0 + nearer) * ahead
