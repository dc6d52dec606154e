"""Splitting cameras, at the middles of their edges or into any pieces: new corners have the true map's rays again."""
from __future__ import annotations

import numpy as np

from ..geometry import columns, cross, dot, groups, mask, numbered, shared_edges, split, unit
from ..support import portions
from .reflection_map import ReflectionMap
from .three_ray_cameras import Cameras

WELD = 1e-9  # of the mirror's size: corners closer than this are one
SAME_RAY = 1e-6  # radians: at a sharp edge of the mirror each side has rays of its own
ROUNDING = 1e-12  # of its size: a thinner camera is seen edge on, by whatever rounding says
BESIDE = 1.5  # times the picture: the border at which edges that reach far beyond it are split
ON_BORDER = 1e-6  # of an edge's length
CORNERS_AT_ONCE = 32768  # new ones: what their arrays take fits the cache


def split_cameras(cameras: Cameras,
                  marked: np.ndarray) -> tuple[Cameras, np.ndarray, np.ndarray]:
    """Cameras split along the `marked` (n, 3) edges, each from a corner to the next, on both sides of each edge.

    Returns
    -------
    cameras : Cameras, those in the picture
    parent : (m,) int64, the camera that each lies in
    new : (m,) bool, whether it is only a part of its parent
    """
    ends, first, edge = shared_edges(cameras.corners)
    chosen = mask(len(ends), edge[marked])
    cameras, parent = split_at(cameras, chosen, edge, *edge_middles(cameras, ends[chosen], first[chosen]))
    seen = in_picture(cameras)
    return cameras.select(seen), parent[seen], chosen[edge].any(axis=1)[parent[seen]]


def edge_middles(cameras: Cameras, ends: np.ndarray, first: np.ndarray,
                 share: np.ndarray | float = 0.5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places (3, e) halfway, or a `share` (e,) of the way, along edges `ends` (e, 2), and origins and directions of the
    true rays there."""
    mirror_map = cameras.mirror_map
    middles = (1.0 - share) * cameras.places[:, ends[:, 0]] + share * cameras.places[:, ends[:, 1]]
    face = cameras.face[first // 3]
    return middles, *mirror_map.leave(face, mirror_map.coordinates(face, middles))


def split_at(cameras: Cameras, marked: np.ndarray, edge: np.ndarray, middles: np.ndarray, origins: np.ndarray,
             rays: np.ndarray) -> tuple[Cameras, np.ndarray]:
    """Cameras split at the `middles` (3, k) of the k `marked` of e edges, which have rays and their origins, and the
    camera that each lies in; `edge` (n, 3) are the cameras' edges."""
    new = numbered(len(marked), marked, cameras.places.shape[1])
    parent, local = split(marked[edge])
    six = np.concatenate((cameras.corners, new[edge]), axis=1)[parent]
    return cameras.replaced(np.take_along_axis(six, local, axis=1), cameras.face[parent], middles, origins,
                            rays), parent


def with_pieces(cameras: Cameras, whole: np.ndarray, parent: np.ndarray, weights: np.ndarray) -> Cameras:
    """The `whole` cameras (n,) and behind them pieces (m) of the cameras `parent`, with weights (3, 3, m) of their
    corners, entry [i, k]: weight i of corner k. New corners are welded where place and ray agree."""
    mirror_map = cameras.mirror_map
    places = np.einsum("xjn,jkn->xkn", np.take(cameras.places, cameras.corners[parent].T, axis=1), weights)
    places, face = places.reshape(3, -1), np.tile(cameras.face[parent], 3)
    corner = np.empty(len(face), dtype=np.int64)
    # the parents' own corners stay what they are, shared with the neighbours
    own, new = (np.flatnonzero((weights == 1.0).any(axis=0).ravel() == state) for state in (True, False))
    number, piece = own // max(len(parent), 1), own % max(len(parent), 1)
    corner[own] = cameras.corners[parent[piece], np.argmax(weights[:, number, piece], axis=0)]
    places, face = places[:, new], face[new]
    origins, rays = true_rays(mirror_map, face, places)
    low = cameras.places.min(axis=1, keepdims=True)
    size = np.ptp(cameras.places, axis=1).max()
    first, group = groups(*np.rint((places - low) / (WELD * size)).astype(np.int64),
                          *ray_numbers(rays))
    corner[new] = group + cameras.places.shape[1]
    kept = cameras.select(whole)
    return cameras.replaced(np.concatenate((kept.corners, corner.reshape(3, -1).T)),
                            np.concatenate((kept.face, cameras.face[parent])), places[:, first], origins[:, first],
                            rays[:, first])


def ray_numbers(rays: np.ndarray) -> np.ndarray:
    """Whole numbers (3, n), the same for rays that go the same way."""
    return np.rint((unit(rays) + 1.0) / SAME_RAY).astype(np.int64)


def true_rays(mirror_map: ReflectionMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Origins and directions (3, n) of the rays that leave the mirror where places (3, n) on its faces are seen."""
    origins, rays = np.empty_like(places), np.empty_like(places)
    for part in portions(len(face), CORNERS_AT_ONCE):
        origins[:, part], rays[:, part] = mirror_map.leave(face[part],
                                                           mirror_map.coordinates(face[part], places[:, part]))
    return origins, rays


def shares_in_picture(cameras: Cameras, ends: np.ndarray) -> np.ndarray:
    """How far along edges `ends` (e, 2) each is best split: halfway, or, where more of it than half lies beside the
    picture, at the picture's border, so that what is left has no ends far outside."""
    clip = cameras.view.clip(cameras.places.T).T
    share = np.full(len(ends), 0.5)
    apart = BESIDE * clip[3] - np.abs(clip[:2]).max(axis=0) < 0.0
    out = np.flatnonzero(apart[ends].any(axis=1))
    first, last = np.zeros(len(out)), np.ones(len(out))
    for axis in (0, 1):
        for side in (1.0, -1.0):
            start, end = ((BESIDE * clip[3] + side * clip[axis])[corner] for corner in ends[out].T)
            with np.errstate(divide="ignore", invalid="ignore"):
                crossing = start / (start - end)
            first = np.where((start < 0.0) & (end > 0.0), np.maximum(first, crossing), first)
            last = np.where((start > 0.0) & (end < 0.0), np.minimum(last, crossing), last)
            last = np.where((start <= 0.0) & (end <= 0.0), -1.0, last)
    border = np.where(first > 1.0 - last, first, last)
    # an edge that ends at the border has been split there
    share[out] = np.where((last - first > ON_BORDER) & (last - first < 0.5), border, 0.5)
    return share


def in_picture(cameras: Cameras) -> np.ndarray:
    """Which cameras may touch the picture: neither a side of the view's pyramid nor one of theirs parts them."""
    view = cameras.view
    clip = view.clip(cameras.places.T)
    margin = 1.0 + 2.0 / np.array(view.resolution)
    x, y, w = clip[:, 0], clip[:, 1], clip[:, 3]
    depth = view.depths(cameras.places.T)
    outside = np.stack((x > w * margin[0], -x > w * margin[0], y > w * margin[1], -y > w * margin[1], depth <= 0.0))
    of_corners = outside[:, cameras.corners]
    seen = ~np.any(of_corners.all(axis=2), axis=0)
    crossing = np.flatnonzero(seen & of_corners.any(axis=(0, 2)))
    seen[crossing] = ~_parted(np.stack((x, y, w)), cameras.corners[crossing], margin)
    return seen


def _parted(clip: np.ndarray, corners: np.ndarray, margin: np.ndarray) -> np.ndarray:
    """Whether one side of triangles with `corners` (n, 3) at homogeneous `clip` (3, c) has all of the picture beyond
    it. That holds behind the eye too: a pixel is seen in the triangle where none of its weights is negative."""
    a, b, c = (columns(clip, corner) for corner in corners.T)
    sides = np.stack([cross(b, c), cross(c, a), cross(a, b)])
    volume = dot(a, sides[0])
    size = np.sqrt(dot(a, a) * dot(b, b) * dot(c, c))
    picture = np.array([(margin[0] * i, margin[1] * j, 1.0) for i in (-1, 1) for j in (-1, 1)])
    beyond = np.einsum("pk,skn->spn", picture, sides) * np.sign(volume) < 0.0
    return beyond.all(axis=1).any(axis=0) & (np.abs(volume) > ROUNDING * size)
