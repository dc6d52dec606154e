"""Splitting of cameras at edge midpoints or into given pieces. New corners get the rays of the true reflection map."""
from __future__ import annotations

import numpy as np

from ..geometry import columns, cross, dot, groups, mask, numbered, shared_edges, split, unit
from ..support import portions
from .reflection_map import ReflectionMap
from .three_ray_cameras import Cameras

WELD = 1e-9  # share of the mirror's size: closer corners are merged
SAME_RAY = 1e-6  # radians: corners are merged only if their rays agree; at sharp edges of the mirror they differ
ROUNDING = 1e-12  # relative volume: thinner cameras are edge-on, and the signs of their sides are rounding
BESIDE = 1.5  # picture sizes: edges that reach far outside of the picture are split at this border
ON_BORDER = 1e-6  # share of an edge's length: shorter parts inside of that border do not count
CORNERS_AT_ONCE = 32768  # new corners per chunk, whose arrays fit the CPU cache


def split_cameras(cameras: Cameras,
                  marked: np.ndarray) -> tuple[Cameras, np.ndarray, np.ndarray]:
    """Split cameras at the midpoints of the `marked` (n, 3) bool edges 01, 12, 20, on both sides of each edge.

    Returns
    -------
    cameras : Cameras, parts that may lie in the picture
    parent : (m,) int64, the old camera that each new one lies in
    new : (m,) bool, True if the parent was split
    """
    ends, first, edge = shared_edges(cameras.corners)
    chosen = mask(len(ends), edge[marked])
    cameras, parent = split_at(cameras, chosen, edge, *edge_middles(cameras, ends[chosen], first[chosen]))
    seen = in_picture(cameras)
    return cameras.select(seen), parent[seen], chosen[edge].any(axis=1)[parent[seen]]


def edge_middles(cameras: Cameras, ends: np.ndarray, first: np.ndarray,
                 share: np.ndarray | float = 0.5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places (3, e) on edges of cameras, and the origins (3, e) and directions (3, e) of the true rays there.

    Parameters
    ----------
    ends : (e, 2) int64, corners at the ends of the edges
    first : (e,) int64, for each edge one camera and its side, as 3 * camera + side
    share : (e,) float64 or float, place along each edge from 0 to 1
    """
    mirror_map = cameras.mirror_map
    middles = (1.0 - share) * cameras.places[:, ends[:, 0]] + share * cameras.places[:, ends[:, 1]]
    face = cameras.face[first // 3]
    return middles, *mirror_map.leave(face, mirror_map.coordinates(face, middles))


def split_at(cameras: Cameras, marked: np.ndarray, edge: np.ndarray, middles: np.ndarray, origins: np.ndarray,
             rays: np.ndarray) -> tuple[Cameras, np.ndarray]:
    """Split cameras at given places on their edges.

    Parameters
    ----------
    marked : (e,) bool, the k edges to split
    edge : (n, 3) int64, edges of the cameras
    middles, origins, rays : (3, k) float64, new corners, and the origins and directions of their rays

    Returns
    -------
    cameras : Cameras
    parent : (m,) int64, the old camera that each new one lies in
    """
    new = numbered(len(marked), marked, cameras.places.shape[1])
    parent, local = split(marked[edge])
    six = np.concatenate((cameras.corners, new[edge]), axis=1)[parent]
    return cameras.replaced(np.take_along_axis(six, local, axis=1), cameras.face[parent], middles, origins,
                            rays), parent


def with_pieces(cameras: Cameras, whole: np.ndarray, parent: np.ndarray, weights: np.ndarray) -> Cameras:
    """Return the `whole` cameras, followed by m given pieces of cameras. New corners with the same place and ray merge.

    Parameters
    ----------
    whole : (n,) bool, cameras to keep unsplit
    parent : (m,) int64, camera that each piece lies in
    weights : (3, 3, m) float64, entry [i, k] is the barycentric weight i of the piece's corner k in its parent
    """
    mirror_map = cameras.mirror_map
    places = np.einsum("xjn,jkn->xkn", np.take(cameras.places, cameras.corners[parent].T, axis=1), weights)
    places, face = places.reshape(3, -1), np.tile(cameras.face[parent], 3)
    corner = np.empty(len(face), dtype=np.int64)
    # reuse the parents' corners, which neighbours share
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
    """Return integers (3, n) that are equal for `rays` (3, n) of the same direction, up to rounding."""
    return np.rint((unit(rays) + 1.0) / SAME_RAY).astype(np.int64)


def true_rays(mirror_map: ReflectionMap, face: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return origins (3, n) and directions (3, n) of the map's rays at `places` (3, n) on the faces `face` (n,)."""
    origins, rays = np.empty_like(places), np.empty_like(places)
    for part in portions(len(face), CORNERS_AT_ONCE):
        origins[:, part], rays[:, part] = mirror_map.leave(face[part],
                                                           mirror_map.coordinates(face[part], places[:, part]))
    return origins, rays


def shares_in_picture(cameras: Cameras, ends: np.ndarray) -> np.ndarray:
    """Return the place (e,) along each edge at which to split it, from 0 to 1.

    The place is the midpoint. If more than half of the edge lies outside of the picture, it is the crossing with a
    border around the picture, so that the inner part has no end far outside. `ends` (e, 2) are the edges' corners.
    """
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
    # an edge that only touches the border has been split there before
    share[out] = np.where((last - first > ON_BORDER) & (last - first < 0.5), border, 0.5)
    return share


def in_picture(cameras: Cameras) -> np.ndarray:
    """Return True (n,) for cameras that may overlap the picture.

    A camera is outside if a plane of the view frustum or a plane through the eye and a side of the camera separates it
    from the picture.
    """
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
    """Return True (n,) for triangles with all of the picture on the outer side of one of their sides.

    The test is also valid for corners behind the eye: a pixel shows the triangle if none of its barycentric weights is
    negative.

    Parameters
    ----------
    clip : (3, c) float64, homogeneous picture coordinates x, y, w of all corners
    corners : (n, 3) int64, columns of `clip`
    margin : (2,) float64, half width and half height of the picture in these coordinates
    """
    a, b, c = (columns(clip, corner) for corner in corners.T)
    sides = np.stack([cross(b, c), cross(c, a), cross(a, b)])
    volume = dot(a, sides[0])
    size = np.sqrt(dot(a, a) * dot(b, b) * dot(c, c))
    picture = np.array([(margin[0] * i, margin[1] * j, 1.0) for i in (-1, 1) for j in (-1, 1)])
    beyond = np.einsum("pk,skn->spn", picture, sides) * np.sign(volume) < 0.0
    return beyond.all(axis=1).any(axis=0) & (np.abs(volume) > ROUNDING * size)
