"""Edges of polygons without a partner on the same two nodes, which may bound an opening.

Over a camera's edge the partner is the same triangle's polygon in the neighbouring camera; over a scene edge, the
neighbouring triangle's in the same camera, on the other side or, where the surface turns away, on the same. Edges are
without one by right on the border of the mirror, of the scene and of a contact.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .candidates import Candidates
from .clipping import CONTACT, SCENE_EDGE, Polygons
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .subdivision import shared_edges


def unmatched_edges(cameras: Cameras, tree: SceneTree, frames: SceneFrames, candidates: Candidates,
                    polygons: Polygons, node_of: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Polygon edges without a partner that should have one.

    Returns
    -------
    edge : (e,) int64
        The polygon corners where they start.
    camera : (e,) int64
        The camera in which the partner is missing.
    partner : (e,) int64
        Its triangle's column in the frames, -1 where the frames do not have it.
    """
    start, end = node_of, node_of[following_corners(polygons)]
    inner = polygons.after < CONTACT
    proper = np.flatnonzero((start != end) & inner)
    low, high = np.minimum(start, end)[proper], np.maximum(start, end)[proper]
    _, pair, uses = np.unique(low * (int(node_of.max(initial=0)) + 1) + high, return_inverse=True, return_counts=True)
    odd = proper[uses[pair] % 2 == 1]
    of = np.repeat(polygons.pair, np.diff(polygons.start))[odd]
    camera, column, label = candidates.camera[of], candidates.column[of], polygons.after[odd].astype(np.int64)
    on_mirror = label < SCENE_EDGE
    expected = np.zeros(len(odd), dtype=bool)
    beyond = _across(cameras, camera[on_mirror], label[on_mirror])
    camera[on_mirror], expected[on_mirror] = beyond, beyond >= 0
    neighbour = _neighbour(tree, frames, column[~on_mirror], label[~on_mirror] - SCENE_EDGE)
    of_neighbour, known = frames.columns(neighbour)
    column[~on_mirror], expected[~on_mirror] = np.where(known, of_neighbour, -1), neighbour >= 0
    return odd[expected], camera[expected], column[expected]


def following_corners(polygons: Polygons) -> np.ndarray:
    """(k,) int64, of each polygon corner the next one round."""
    following = np.arange(1, len(polygons.after) + 1)
    following[polygons.start[1:] - 1] = polygons.start[:-1]
    return following


def _neighbour(tree: SceneTree, frames: SceneFrames, column: np.ndarray, side: np.ndarray) -> np.ndarray:
    """The triangle with an area beyond the scene edge opposite vertex `side`, -1 where there is none or several."""
    row, mesh = np.arange(len(column)), tree.mesh
    vertices = frames.vertices[:, column]
    asked = np.sort(np.stack((vertices[(side + 1) % 3, row], vertices[(side + 2) % 3, row])), axis=0)
    touched = np.zeros(len(mesh.positions), dtype=bool)
    touched[asked] = True
    near = tree.leaf_triangles[touched[mesh.triangles[tree.leaf_triangles]].sum(axis=1) >= 2]
    ends, _, edge = shared_edges(mesh.triangles[near])
    uses, other = _uses(edge, near)
    count = len(mesh.positions)
    # the triangle that is asked about has an area itself: its edges are among them
    here = np.searchsorted(ends[:, 0] * count + ends[:, 1], asked[0] * count + asked[1])
    return np.where(uses[here] == 2, other[here] - frames.triangle[column], -1)


def _across(cameras: Cameras, camera: np.ndarray, label: np.ndarray) -> np.ndarray:
    """The camera beyond the edge opposite corner `label`, -1 where there is none or more than one."""
    _, _, edge = shared_edges(cameras.corners)
    uses, both = _uses(edge, np.arange(len(cameras)))
    here = edge[camera, (label + 1) % 3]
    return np.where(uses[here] == 2, both[here] - camera, -1)


def _uses(edge: np.ndarray, name: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How many triangles have each of the edges (n, 3), and the sum of these triangles' names (n,)."""
    total = np.bincount(edge.ravel(), weights=np.repeat(name, 3).astype(np.float64))
    return np.bincount(edge.ravel()), total.astype(np.int64)
