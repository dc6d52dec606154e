"""Placement: where along its view ray each node is drawn.

LAYERED keeps the picture and orders the layers. Along a view ray the virtual image of a point at path s R lies 1 + s
times as far as the mirror. A node goes to k = 1 / (1 + gap + depth / (1 + s)) times that distance: 1 / k is an affine
function of 1 / (1 + s), a projective map that keeps straight lines straight, so that the layers of flat surfaces in a
flat mirror stay flat, and nearer paths come nearer to the eye everywhere, not only at the nodes.
"""
from __future__ import annotations

import numpy as np

from .nodes import Nodes
from .scene_frames import SceneFrames
from .vectors import norm
from .view import View

GAP = 2e-4  # share of the viewing distance kept free before the mirror
DEPTH = 2e-3  # share of the viewing distance over which the layers spread
CONTACT = 10.0  # times the slide: a longer path ends on a surface too far off to come out through


def place(view: View, nodes: Nodes, path_length: np.ndarray, placement: str, most: np.ndarray) -> np.ndarray:
    """World positions (3, n) of the nodes.

    Parameters
    ----------
    path_length : (n,) float64, in scene units
    placement : {'LAYERED', 'SURFACE', 'VIRTUAL'}
    most : (n,) float64
        How far a node may slide towards the eye, in scene units; infinite where nothing is near.
    """
    if placement == "SURFACE" or not len(path_length):
        return nodes.place
    ahead = view.directions(nodes.place.T).T
    if placement == "VIRTUAL":
        return nodes.place + ahead * (path_length if view.orthographic else nodes.distance)
    if view.orthographic:
        size = (nodes.place.max(axis=1) - nodes.place.min(axis=1)).max()
        slide = size * (GAP + DEPTH * (1.0 - path_length / max(path_length.max(), 1e-300)))
        return nodes.place - np.minimum(slide, most) * ahead
    nearer = GAP + DEPTH / (1.0 + nodes.distance)
    return nodes.place - np.minimum(nearer / (1.0 + nearer), most / norm(ahead)) * ahead


def slide_limits(view: View, nodes: Nodes, path_length: np.ndarray, frames: SceneFrames, triangles: np.ndarray,
                 column: np.ndarray) -> np.ndarray:
    """How far nodes may slide before they come out through the surface that they show.

    Where the mirror dips into the scene, its part behind a diffuse triangle shows that triangle from behind, hidden
    from the eye by the triangle itself; a node there stops halfway to its plane.

    Parameters
    ----------
    triangles : (m, 3) int64, nodes of the faces
    column : (m,) int64, of the faces' diffuse triangles in the frames

    Returns
    -------
    (n,) float64, in scene units
    """
    most = np.full(len(path_length), np.inf)
    if not len(path_length):
        return most
    ahead = view.directions(nodes.place.T).T
    unit = np.ptp(nodes.place, axis=1).max() if view.orthographic else norm(ahead)
    near = path_length < CONTACT * (GAP + DEPTH) * unit
    face, corner = np.nonzero(near[triangles])
    node, column = triangles[face, corner], column[face]
    _, _, height = frames.coordinates(column, nodes.place[:, node])
    _, _, falling = frames.directions(column, ahead[:, node])
    share = height / np.where(falling != 0.0, falling, 1e-300)
    away = share * norm(ahead[:, node])
    # on the plane itself rounding decides the sign: the eye's side tells
    hidden = (share > -1e-9) & (share < 1.0)
    np.minimum.at(most, node[hidden], np.maximum(0.5 * away[hidden], 0.0))
    return most
