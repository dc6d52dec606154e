"""Error-bounded refinement of the mirror: cameras are split where their rays stray from the true reflection map.

A camera interpolates the rays of its corners; the true map bends between them. Halfway along an edge the two differ by
an angle, which moves the image of a point at distance l by some pixels: the angle's displacement l |delta| over the
motion of the reflected point along the edge, times the edge's length in the picture. Flat mirrors show no difference at
all and stay whole. Where the mirror is bent strongly one way and hardly the other, the same angle is little along an
edge and pixels beside it: there the displacement is solved in the motions along two edges, and bounded more loosely,
since what cameras are cut into later has true rays. It asks what the whole has met, which must not be far off.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm, shared_edges, unit
from ..support import breathe
from .camera_splitting import edge_middles, in_picture, split_at
from .shading_horizon import beyond_horizon
from .three_ray_cameras import Cameras

LEVELS = 12
BESIDE = 8.0  # times the tolerance: what rays may stray by beside an edge
INDEPENDENT = 1e-6  # sine between the motions along two edges: below, as on a fold, nothing can be solved in them
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
        marked |= _straying_beside(cameras, edge, len(ends), rays, reach) > BESIDE * tolerance
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


@np.errstate(invalid="ignore", over="ignore", divide="ignore")
def _straying_beside(cameras: Cameras, edge: np.ndarray, count: int, middle_rays: np.ndarray,
                     reach: float) -> np.ndarray:
    """Pixels (e,) by which cameras stray halfway along their edges `edge` (n, 3), in whatever direction."""
    places, origins = (rows[:, cameras.corners] for rows in (cameras.places, cameras.origins))
    pixels = cameras.view.pixels(places.reshape(3, -1).T).reshape(*cameras.corners.shape, 2)
    given = cameras.rays[:, cameras.corners]
    rays = unit(given)
    ahead = unit(rays.sum(axis=2))

    def across(moved: np.ndarray) -> np.ndarray:
        return moved - dot(moved, ahead) * ahead
    corner, first, second = (origins[:, :, k] + reach * rays[:, :, k] for k in range(3))
    u, v = across(first - corner), across(second - corner)
    uu, uv, vv = dot(u, u), dot(u, v), dot(v, v)
    area = uu * vv - uv**2
    area = np.where(area > INDEPENDENT**2 * uu * vv, area, np.inf)
    right, up = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    straying = np.zeros(count)
    for k in range(3):
        after = (k + 1) % 3
        turn = unit(middle_rays[:, edge[:, k]]) - unit(given[:, :, k] + given[:, :, after])
        # rounding of unit vectors alone must not split a flat mirror
        moved = across(reach * np.where(norm(turn) > 1e-14, turn, 0.0))
        a, b = dot(moved, u), dot(moved, v)
        found = np.linalg.norm(((vv * a - uv * b) / area)[:, None] * right + ((uu * b - uv * a) / area)[:, None] * up,
                               axis=1)
        long = np.linalg.norm(pixels[:, after] - pixels[:, k], axis=1) >= SHORTEST_EDGE
        np.maximum.at(straying, edge[:, k], np.where(long & np.isfinite(found), found, 0.0))
    return straying
