"""Error-bounded refinement of the mirror: cameras are split where their rays stray from the true reflection map.

A camera interpolates the rays of its corners; the true map bends between them. Halfway along an edge the two differ by
an angle, which moves the image of a point at distance l by some pixels: the angle's displacement l |delta| over the
motion of the reflected point along the edge, times the edge's length in the picture. Flat mirrors show no difference at
all and stay whole.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .mirror_map import MirrorMap
from .subdivision import shared_edges, split
from .vectors import dot, norm, unit
from .view import View

LEVELS = 12
SHORTEST_EDGE = 0.5  # pixels: a shorter edge cannot stray by a visible amount


def refine_mirror(view: View, mirror_map: MirrorMap, cameras: Cameras, tolerance: float, reach: float,
                  maximum: int) -> tuple[Cameras, bool]:
    """Cameras in the picture, split until each edge strays by less than `tolerance` pixels.

    Parameters
    ----------
    reach : float
        Distance of the farthest diffuse point from the mirror, in scene units.
    maximum : int
        No more than about this many cameras are made.

    Returns
    -------
    cameras : Cameras
    limited : bool
        Whether the bound on depth or count stopped the refinement.
    """
    cameras = cameras.select(in_picture(view, cameras))
    for _ in range(LEVELS):
        if not len(cameras) or len(cameras) > maximum:
            return cameras, bool(len(cameras))
        ends, first, edge = shared_edges(cameras.corners)
        middles, rays, lifted = _middles(mirror_map, cameras, ends, first)
        # beyond the horizon the map is a sliver of made-up rays: nothing to be exact about
        marked = (_straying(view, cameras, ends, rays, reach) > tolerance) & ~lifted
        if not marked.any():
            return cameras, False
        cameras, _ = _split(cameras, marked, edge, middles, rays)
        cameras = cameras.select(in_picture(view, cameras))
    return cameras, True


def split_cameras(view: View, mirror_map: MirrorMap, cameras: Cameras,
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
    middles, rays, _ = _middles(mirror_map, cameras, ends, first)
    cameras, parent = _split(cameras, chosen, edge, middles, rays)
    seen = in_picture(view, cameras)
    return cameras.select(seen), parent[seen], chosen[edge].any(axis=1)[parent[seen]]


def _middles(mirror_map: MirrorMap, cameras: Cameras, ends: np.ndarray, first: np.ndarray):
    """Places (3, e) halfway along edges `ends` (e, 2), the true rays there, and whether those had to be lifted."""
    middles = 0.5 * (cameras.places[:, ends[:, 0]] + cameras.places[:, ends[:, 1]])
    face = cameras.face[first // 3]
    uv = mirror_map.coordinates(face, middles)
    return middles, mirror_map.rays(face, uv), mirror_map.lifted(face, uv)


def _split(cameras: Cameras, marked: np.ndarray, edge: np.ndarray, middles: np.ndarray, rays: np.ndarray):
    new = np.cumsum(marked) - 1 + cameras.places.shape[1]
    parent, local = split(marked[edge])
    six = np.concatenate((cameras.corners, new[edge]), axis=1)[parent]
    return Cameras(np.take_along_axis(six, local, axis=1), cameras.face[parent],
                   np.concatenate((cameras.places, middles[:, marked]), axis=1),
                   np.concatenate((cameras.rays, rays[:, marked]), axis=1)), parent


def in_picture(view: View, cameras: Cameras) -> np.ndarray:
    """Which cameras may touch the picture: not all three corners beyond the same side of the view's pyramid."""
    clip = view.clip(cameras.places.T)
    margin = 1.0 + 2.0 / np.array(view.resolution)
    x, y, w = clip[:, 0], clip[:, 1], clip[:, 3]
    depth = view.depths(cameras.places.T)
    outside = np.stack((x > w * margin[0], -x > w * margin[0], y > w * margin[1], -y > w * margin[1], depth <= 0.0))
    return ~outside[:, cameras.corners].all(axis=2).any(axis=0)


def _straying(view: View, cameras: Cameras, ends: np.ndarray, middle_rays: np.ndarray, reach: float) -> np.ndarray:
    """Pixels by which the cameras stray from the true map halfway along edges `ends` (e, 2); infinite where an edge
    crosses the eye's plane and must be cut before anything can be said of it."""
    a, b = ends[:, 0], ends[:, 1]
    va, vb, ra, rb = cameras.places[:, a], cameras.places[:, b], cameras.rays[:, a], cameras.rays[:, b]
    behind = (view.depths(cameras.places.T) <= 0.0)[ends]
    with np.errstate(invalid="ignore", over="ignore"):
        pixels = view.pixels(cameras.places.T)
        length = np.linalg.norm(pixels[a] - pixels[b], axis=1)
    middle = unit(ra + rb)
    turn = norm(unit(middle_rays) - middle)
    along = vb - va
    across = norm(along - dot(along, middle) * middle)
    motion = np.hypot(across, reach * norm(unit(ra) - unit(rb)))
    # rounding of unit vectors alone must not split a flat mirror
    straying = length * reach * np.where(turn > 1e-14, turn, 0.0) / np.maximum(motion, 1e-300)
    straying[length < SHORTEST_EDGE] = 0.0
    straying[behind.all(axis=1)] = 0.0
    straying[behind.any(axis=1) & ~behind.all(axis=1)] = np.inf
    return straying
