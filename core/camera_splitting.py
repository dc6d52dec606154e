"""Splitting cameras at the middles of their edges, where the rays are those of the true map again."""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .reflection_map import ReflectionMap
from .subdivision import shared_edges, split
from .view import View


def split_cameras(view: View, mirror_map: ReflectionMap, cameras: Cameras,
                  marked: np.ndarray) -> tuple[Cameras, np.ndarray, np.ndarray]:
    """Cameras split along the `marked` (n, 3) edges, each from a corner to the next, on both sides of each edge.

    Returns
    -------
    cameras : Cameras
        Those in the picture.
    parent : (m,) int64
        The camera that each lies in.
    new : (m,) bool
        Whether it is only a part of its parent.
    """
    ends, first, edge = shared_edges(cameras.corners)
    chosen = np.zeros(len(ends), dtype=bool)
    chosen[edge[marked]] = True
    cameras, parent = split_at(cameras, chosen, edge, *edge_middles(mirror_map, cameras, ends, first))
    seen = in_picture(view, cameras)
    return cameras.select(seen), parent[seen], chosen[edge].any(axis=1)[parent[seen]]


def edge_middles(mirror_map: ReflectionMap, cameras: Cameras, ends: np.ndarray,
                 first: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (3, e) halfway along edges `ends` (e, 2), and origins and directions of the true rays there."""
    middles = 0.5 * (cameras.places[:, ends[:, 0]] + cameras.places[:, ends[:, 1]])
    face = cameras.face[first // 3]
    return middles, *mirror_map.leave(face, mirror_map.coordinates(face, middles))


def split_at(cameras: Cameras, marked: np.ndarray, edge: np.ndarray, middles: np.ndarray, origins: np.ndarray,
             rays: np.ndarray) -> tuple[Cameras, np.ndarray]:
    """Cameras split at the middles of the `marked` (e,) edges, and the camera that each lies in; `edge` (n, 3) are the
    cameras' edges."""
    new = np.cumsum(marked) - 1 + cameras.places.shape[1]
    parent, local = split(marked[edge])
    six = np.concatenate((cameras.corners, new[edge]), axis=1)[parent]
    return cameras.replaced(np.take_along_axis(six, local, axis=1), cameras.face[parent], middles[:, marked],
                            origins[:, marked], rays[:, marked]), parent


def in_picture(view: View, cameras: Cameras) -> np.ndarray:
    """Which cameras may touch the picture: not all three corners beyond the same side of the view's pyramid."""
    clip = view.clip(cameras.places.T)
    margin = 1.0 + 2.0 / np.array(view.resolution)
    x, y, w = clip[:, 0], clip[:, 1], clip[:, 3]
    depth = view.depths(cameras.places.T)
    outside = np.stack((x > w * margin[0], -x > w * margin[0], y > w * margin[1], -y > w * margin[1], depth <= 0.0))
    return ~outside[:, cameras.corners].all(axis=2).any(axis=0)
