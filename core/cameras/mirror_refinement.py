"""Error-bounded refinement of the mirror: cameras are split where their rays stray from the true reflection map.

A camera interpolates the rays of its corners; the true map bends between them. Halfway along an edge the two differ by
an angle, which moves the image of a point at distance l by some pixels: the angle's displacement l |delta| over the
motion of the reflected point along the edge, times the edge's length in the picture. Flat mirrors show no difference at
all and stay whole.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm, shared_edges, unit
from ..support import breathe
from .camera_splitting import edge_middles, in_picture, split_at
from .shading_horizon import beyond_horizon
from .three_ray_cameras import Cameras

LEVELS = 12
SHORTEST_EDGE = 0.5  # pixels: a shorter edge cannot stray by a visible amount


def refine_mirror(cameras: Cameras, tolerance: float, reach: float,
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
    cameras = cameras.select(in_picture(cameras))
    finished: list[Cameras] = []
    limited = True
    for _ in range(LEVELS):
        breathe()
        if sum(map(len, finished)) + len(cameras) > maximum:
            break
        ends, first, edge = shared_edges(cameras.corners)
        middles, origins, rays = edge_middles(cameras, ends, first)
        marked = _straying(cameras, ends, rays, reach) > tolerance
        # beyond the horizon the map is a sliver of made-up rays: nothing to be exact about
        asked = np.flatnonzero(marked[edge].any(axis=1))
        worth = np.zeros(len(ends), dtype=bool)
        worth[edge[asked[~beyond_horizon(cameras.select(asked))]]] = True
        marked &= worth
        if not marked.any():
            limited = False
            break
        # a whole camera stays whole: what is said of an edge does not depend on who asks
        divided = marked[edge].any(axis=1)
        finished.append(cameras.select(~divided))
        cameras, _ = split_at(cameras.select(divided), marked, edge[divided],
                              *(of_all[:, marked] for of_all in (middles, origins, rays)))
        cameras = cameras.select(in_picture(cameras))
    parts = [*finished, cameras]
    return Cameras(np.concatenate([part.corners for part in parts]), np.concatenate([part.face for part in parts]),
                   cameras.places, cameras.rays, cameras.origins, cameras.mirror_map), limited


def _straying(cameras: Cameras, ends: np.ndarray, middle_rays: np.ndarray, reach: float) -> np.ndarray:
    """Pixels by which the cameras stray from the true map halfway along edges `ends` (e, 2)."""
    view = cameras.view
    a, b = ends[:, 0], ends[:, 1]
    va, vb, ra, rb = cameras.origins[:, a], cameras.origins[:, b], cameras.rays[:, a], cameras.rays[:, b]
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
    return straying
