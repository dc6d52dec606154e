"""Placement: where along its view ray each node is drawn.

LAYERED keeps the picture and orders the layers. Along a view ray the virtual image of a point at path s R lies 1 + s
times as far as the mirror. A node goes to k = 1 / (1 + gap + depth / (1 + s)) times that distance: 1 / k is an affine
function of 1 / (1 + s), a projective map that keeps straight lines straight, so that the layers of flat surfaces in a
flat mirror stay flat, and nearer paths come nearer to the eye everywhere, not only at the nodes.
"""
from __future__ import annotations

import numpy as np

from .nodes import Nodes
from .view import View

GAP = 2e-4  # share of the viewing distance kept free before the mirror
DEPTH = 2e-3  # share of the viewing distance over which the layers spread


def place(view: View, nodes: Nodes, path_length: np.ndarray, placement: str) -> np.ndarray:
    """World positions (3, n) of the nodes.

    Parameters
    ----------
    path_length : (n,) float64, in scene units
    placement : {'LAYERED', 'SURFACE', 'VIRTUAL'}
    """
    if placement == "SURFACE" or not len(path_length):
        return nodes.place
    ahead = view.directions(nodes.place.T).T
    if placement == "VIRTUAL":
        return nodes.place + ahead * (path_length if view.orthographic else nodes.distance)
    if view.orthographic:
        size = (nodes.place.max(axis=1) - nodes.place.min(axis=1)).max()
        slide = size * (GAP + DEPTH * (1.0 - path_length / max(path_length.max(), 1e-300)))
        return nodes.place - slide * ahead
    nearer = GAP + DEPTH / (1.0 + nodes.distance)
    return nodes.place - nearer / (1.0 + nearer) * ahead
