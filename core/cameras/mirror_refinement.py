"""Error-bounded refinement of the mirror: cameras are split where their rays deviate from the true reflection map.

A camera interpolates the rays of its corners; the true map is curved between them. At an edge's midpoint the two rays
differ by a vector delta, which moves the image of a point at distance l by some pixels: l |delta|, divided by the
motion of the reflected point along the edge, times the edge's length in the picture. Flat mirrors have no difference
and are not split.

If the mirror is strongly curved in one direction and almost flat in the other, the same delta is a small displacement
along an edge, but pixels across it. So the displacement is also solved in the motions along two edges. Its tolerance
is larger, because parts that cameras are cut into later have true rays.

In a picture, a sliver narrower than a pixel shows little, wherever its rays go. For a lamp, it may carry much light:
light that grazes several mirrors gets much brighter at each. There a further limit holds for the angle between the rays
at the ends of an edge.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..geometry import columns, dot, mask, norm, shared_edges, unit
from ..support import BESIDE_EDGES
from ..views import LampView
from .camera_splitting import edge_middles, in_picture, shares_in_picture, split_at
from .shading_horizon import beyond_horizon
from .three_ray_cameras import Cameras

LEVELS, DEEPER, FEW = 12, 48, 1024  # levels of splitting; levels if at most FEW cameras are left to split
INDEPENDENT = 1e-6  # sine between the motions along two edges: below, as on a fold, the system is singular
ROUNDING = 1e-14  # radians: rounding of unit vectors, which must not split a flat mirror
PARTED = 0.5  # smallest cosine between the rays of a lamp's light at the ends of an edge, after the first bounce
THIN = 0.05  # pixels: displacements across a narrower camera are ignored
SHORTEST_EDGE = 0.5  # pixels: shorter edges cannot deviate visibly


def refine_mirror(cameras: Cameras, tolerance: float, reach: float,
                  maximum: int) -> tuple[Cameras, bool]:
    """Split cameras in the picture until the rays of each edge deviate by less than `tolerance` pixels.

    Parameters
    ----------
    reach : float, distance of the farthest diffuse point from the mirror, in scene units
    maximum : int, largest number of cameras, approximately

    Returns
    -------
    cameras : Cameras
    limited : bool, True if the limit on levels or on cameras stopped the refinement
    """
    cameras = cameras.select(in_picture(cameras))
    finished: list[Cameras] = []
    limited = True
    for level in range(DEEPER):
        # an eye close above a large triangle needs many levels of few cameras; with many cameras they never end
        if sum(map(len, finished)) + len(cameras) > maximum or (level >= LEVELS and len(cameras) > FEW):
            break
        ends, first, edge = shared_edges(cameras.corners)
        share = shares_in_picture(cameras, ends)
        middles, origins, rays = edge_middles(cameras, ends, first, share)
        edges = _Edges.of(cameras, ends, share, rays)
        marked = _marked(cameras, edges, edge, reach, tolerance)
        if not marked.any():
            limited = False
            break
        # an unsplit camera stays unsplit: the test of an edge does not depend on the camera beside it
        divided = marked[edge].any(axis=1)
        finished.append(cameras.select(~divided))
        cameras, _ = split_at(cameras.select(divided), marked, edge[divided],
                              *(of_all[:, marked] for of_all in (middles, origins, rays)))
        cameras = cameras.select(in_picture(cameras))
    parts = [*finished, cameras]
    return replace(cameras, corners=np.concatenate([part.corners for part in parts]),
                   face=np.concatenate([part.face for part in parts])), limited


@dataclass(frozen=True)
class _Edges:
    """Edges of cameras, with the interpolated ray and the true ray at one place on each edge.

    That place is where the edge would be split, at a share t of it from 0 to 1: see `shares_in_picture`. It is the
    midpoint, t = 0.5, except for edges that lie mostly outside of the picture.

    Attributes
    ----------
    ends : (e, 2) int64, corners at the ends of the edges
    pixels : (c, 2) float64, all corners of the cameras in the picture, in pixels
    lengths : (e,) float64, lengths of the edges in pixels
    given : (3, e) float64, interpolated rays at t, as unit vectors in world space
    turns : (3, e) float64
        True unit rays minus `given`, estimated at the midpoint: the difference at t divided by 4 t (1 - t). It is taken
        as a parabola along the edge that is zero at both ends. Zero if it is rounding.
    """

    ends: np.ndarray
    pixels: np.ndarray
    lengths: np.ndarray
    given: np.ndarray
    turns: np.ndarray

    @classmethod
    def of(cls, cameras: Cameras, ends: np.ndarray, share: np.ndarray, middle_rays: np.ndarray) -> _Edges:
        a, b = ends[:, 0], ends[:, 1]
        with np.errstate(invalid="ignore", over="ignore"):
            pixels = cameras.view.pixels(cameras.places.T)
            lengths = np.linalg.norm(pixels[a] - pixels[b], axis=1)
        given = unit((1.0 - share) * cameras.rays[:, a] + share * cameras.rays[:, b])
        # the deviation is zero at both ends: scale it as a parabola to its value at the midpoint
        turns = (unit(middle_rays) - given) / (4.0 * share * (1.0 - share))
        return cls(ends, pixels, lengths, given, np.where(norm(turns) > ROUNDING, turns, 0.0))


def _marked(cameras: Cameras, edges: _Edges, edge: np.ndarray, reach: float, tolerance: float) -> np.ndarray:
    """Return True (e,) for edges to split; `edge` (n, 3) are the cameras' edges."""
    marked = _straying(cameras, edges, reach) > tolerance
    marked |= _straying_beside(cameras, edges, edge, reach) > BESIDE_EDGES * tolerance
    marked |= _parted(cameras, edges)
    # do not refine slivers of lifted rays
    asked = np.flatnonzero(marked[edge].any(axis=1))
    worth = mask(len(marked), edge[asked[~beyond_horizon(cameras.select(asked))]])
    return marked & worth


def _straying(cameras: Cameras, edges: _Edges, reach: float) -> np.ndarray:
    """Return the deviation (e,) in pixels of the cameras from the true map at edge midpoints, along the edges."""
    a, b = edges.ends[:, 0], edges.ends[:, 1]
    along = cameras.origins[:, b] - cameras.origins[:, a]
    across = norm(along - dot(along, edges.given) * edges.given)
    motion = np.hypot(across, reach * norm(unit(cameras.rays[:, a]) - unit(cameras.rays[:, b])))
    straying = edges.lengths * reach * norm(edges.turns) / np.maximum(motion, 1e-300)
    straying[edges.lengths < SHORTEST_EDGE] = 0.0
    return straying


def _parted(cameras: Cameras, edges: _Edges) -> np.ndarray:
    """Return True (e,) for edges whose end rays diverge too much; only for a lamp's light after two or more bounces."""
    if cameras.mirror_map.bounce == 1 or not isinstance(cameras.view, LampView):
        return np.zeros(len(edges.ends), dtype=bool)
    start, end = (unit(cameras.rays[:, corner]) for corner in edges.ends.T)
    return dot(start, end) < PARTED


@np.errstate(invalid="ignore", over="ignore", divide="ignore")
def _straying_beside(cameras: Cameras, edges: _Edges, edge: np.ndarray, reach: float) -> np.ndarray:
    """Return the deviation (e,) in pixels of the cameras from the true map at edge midpoints, in any direction.

    `edge` (n, 3) are the cameras' edges.
    """
    rays = [unit(columns(cameras.rays, corner)) for corner in cameras.corners.T]
    ahead = unit(rays[0] + rays[1] + rays[2])

    def across(moved: np.ndarray) -> np.ndarray:
        return moved - dot(moved, ahead) * ahead
    first, second, third = (columns(cameras.origins, corner) + reach * ray
                            for corner, ray in zip(cameras.corners.T, rays))
    u, v = across(second - first), across(third - first)
    uu, uv, vv = dot(u, u), dot(u, v), dot(v, v)
    area = uu * vv - uv**2
    area = np.where(area > INDEPENDENT**2 * uu * vv, area, np.inf)
    right, up = (edges.pixels[cameras.corners[:, k]] - edges.pixels[cameras.corners[:, 0]] for k in (1, 2))
    # in a sliver points move only along it, and `_straying` has tested its edges
    wide = ~(np.abs(right[:, 0] * up[:, 1] - right[:, 1] * up[:, 0]) < THIN * edges.lengths[edge].max(axis=1))
    straying = np.zeros(len(edges.ends))
    for side in edge.T:
        moved = across(reach * columns(edges.turns, side))
        a, b = dot(moved, u), dot(moved, v)
        found = np.linalg.norm(((vv * a - uv * b) / area)[:, None] * right + ((uu * b - uv * a) / area)[:, None] * up,
                               axis=1)
        told = wide & (edges.lengths[side] >= SHORTEST_EDGE) & np.isfinite(found)
        np.maximum.at(straying, side, np.where(told, found, 0.0))
    return straying
