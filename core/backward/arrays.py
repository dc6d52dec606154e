"""Assembly of the part made by rays from the eye, as the plain arrays of the result."""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..culling import SceneAndMirrors
from ..geometry import (
    SceneFrames,
    area_normals,
    columns,
    connected,
    distinct,
    dot,
    edge_lengths,
    following,
    groups,
    norm,
    others,
    rows,
)
from .backward_part import BackwardPart
from .outlines import joined
from .paths import Paths

ROUNDING = 1e-12    # of the largest coordinate
SAG_OF_FACE = 4.0 / 3.0     # sag of a face whose three edges sag alike, as a multiple of theirs
# largest sag of an edge, in viewing distances or, before an orthographic eye, in sizes of the mirror: at a silhouette
# planes are seen edge on
STEEPEST = 0.1
MOST_IN_CELL = 4    # largest number of vertices at one place of the picture: one for each corner of a cell
# pixels: largest distance between the points that they show; with 0.75, the 99th percentile of a torus rises by a half
CLOSE = 0.1


def backward_arrays(part: BackwardPart, met: SceneAndMirrors) -> dict:
    """Return the arrays of `ReflectionMesh` except its positions; triangle indices are in the canonical order.

    `lift` (n,) is how far layers must move towards the eye so that none of their faces lies behind the mirror, in units
    of `View.directions`.
    """
    paths, spots, cells = part.faces()
    used, corner = distinct(cells.faces.ravel())
    paths, spots, triangles = paths.select(used), spots[used], corner.reshape(-1, 3)
    source = part.source(cells.key)
    close = CLOSE * _motion(paths.point.T[triangles], spots, triangles)
    close[used < part.samples] = 0.0    # pixel centres stay right
    triangles = _welded(paths, spots, triangles, source, close, met)
    # faces whose corners have become one are gone
    some = np.flatnonzero((triangles != following(triangles)).all(axis=1))
    paths, triangles, weights, sides = _on_sources(paths, triangles[some], source[some], close, met)
    source = source[some]
    used, corner = distinct(triangles.ravel())
    paths, triangles = paths.select(used), corner.reshape(-1, 3)

    corners = rows(met.positions[met.triangles[source].T])
    height = sum(dot(area_normals(corners), columns(paths.origin, node) - corners[:, 0]) for node in triangles.T)
    turned = np.less(height, 0.0)
    order = np.where(turned[:, None], (0, 2, 1), (0, 1, 2))
    parity = np.zeros(len(used))
    sign = sides * np.where(turned, -1.0, 1.0) * (-1.0)**paths.bounces[triangles[:, 0]]
    np.add.at(parity, triangles.ravel(), np.repeat(sign, 3))
    face, straight = paths.face[triangles], norm(paths.point - paths.place)
    return {
        "triangles": np.take_along_axis(triangles, order, axis=1), "reflected_position": paths.point.T,
        "mirror_position": paths.place.T,
        "path_length": np.where(paths.bounces == 1, straight, np.maximum(paths.total, straight)),
        "image_parity": np.sign(parity).astype(np.int8), "mirror_normals": np.moveaxis(paths.normal, 2, 0),
        "source_face": met.of_scene(source), "source_weights": np.take_along_axis(weights, order[:, :, None], axis=1),
        "mirror_face": np.where((face == face[:, :1]).all(axis=1), face[:, 0], -1),
        "map_face": face[:, 0], "bounces": paths.bounces[triangles[:, 0]].astype(np.int8),
        "later_mirrors": paths.later.T[triangles[:, 0]], "lift": _lift(part, paths, triangles)}


def _on_sources(paths: Paths, triangles: np.ndarray, source: np.ndarray, close: np.ndarray, met: SceneAndMirrors
                ) -> tuple[Paths, np.ndarray, np.ndarray, np.ndarray]:
    """Move the points that vertices show onto the source triangles of their faces.

    Points close to an edge of the source are moved onto it: a face's side along an edge is exactly on that edge. A
    vertex whose point does not lie on the source triangle of one of its faces becomes two.

    Parameters
    ----------
    paths : Paths, the n vertices
    triangles : (m, 3) int64, vertices of the faces
    source : (m,) int64, their source triangles
    close : (n,) float64, distance from an edge in scene units

    Returns
    -------
    paths, triangles : the same, with more vertices
    weights : (m, 3, 3) float64, barycentric coordinates of the faces' corners on their source triangles
    sides : (m,) float64, 1 if the corners run round the face as those of its source do, -1 if against, 0 if neither
    """
    found, column = distinct(source)
    frames, column = SceneFrames.of(met, found), np.repeat(column, 3)
    corners = met.positions[met.triangles[source]]
    area, corner = norm(area_normals(rows(corners.transpose(1, 0, 2)))), triangles.ravel()

    def on_source(points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return barycentric coordinates (m, 3, 3) of points (3, 3 m), and the nearest points of the triangles."""
        weights = frames.weights_within(column, points).T.reshape(-1, 3, 3)
        return weights, rows(np.matmul(weights, corners).reshape(-1, 3))
    weights, _ = on_source(paths.point[:, corner])
    sides = np.sign(np.linalg.det(weights))
    greatest = weights.max(axis=2)
    for k, (one, other) in enumerate(map(others, range(3))):
        height, own = area / norm(rows(corners[:, one] - corners[:, other])), weights[..., k]
        own[(own * height[:, None] <= close[triangles]) & (own < greatest)] = 0.0
    weights /= weights.sum(axis=2, keepdims=True)
    point = paths.point.copy()
    point[:, corner] = rows(np.matmul(weights, corners).reshape(-1, 3))
    weights, nearest = on_source(point[:, corner])
    apart = np.flatnonzero(norm(nearest - point[:, corner]) > ROUNDING * np.abs(corners).max(initial=0.0))
    first, group = groups(corner[apart], np.repeat(source, 3)[apart])
    more = paths.select(corner[apart[first]])
    corner = corner.copy()
    corner[apart] = point.shape[1] + group
    point = np.concatenate((point, nearest[:, apart[first]]), axis=1)
    return replace(joined([paths, more]), point=point), corner.reshape(-1, 3), weights, sides


def _lift(part: BackwardPart, paths: Paths, triangles: np.ndarray) -> np.ndarray:
    """Return how far the mirror lies before the faces around each vertex (n,), in units of `View.directions`."""
    surface, ahead = part.tracer.surface, part.view.directions(paths.place.T).T
    normal, place = surface.face_normal[:, paths.face], surface.a[:, paths.face]
    most = STEEPEST * (part.tracer.size if part.view.orthographic else 1.0)

    def before(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return how far the plane of the mirror at `one` is before `other`, on the view ray of `other`."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found = dot(normal[:, one], paths.place[:, other] - place[:, one]) / dot(normal[:, one], ahead[:, other])
        return np.clip(np.nan_to_num(found), -most, most)
    sag = np.zeros(len(triangles))
    for start, end in zip(triangles.T, np.roll(triangles.T, -1, axis=0)):
        # along an edge, a convex mirror is no nearer than the farther one of the planes at both ends
        one, other = (before(start, start), before(start, end)), (before(end, start), before(end, end))
        rise, fall = one[1] - one[0], other[0] - other[1]
        with np.errstate(over="ignore"):
            share = np.clip((other[0] - one[0]) / np.maximum(rise + fall, np.finfo(float).tiny), 0.0, 1.0)
        for way in (0.0, share, 1.0):
            np.maximum(sag, np.minimum(one[0] + way * rise, other[0] - way * fall), out=sag)
    lift = np.zeros(len(paths.face))
    np.maximum.at(lift, triangles, SAG_OF_FACE * sag[:, None])
    return lift


def _motion(points: np.ndarray, spots: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return how far the reflected point moves per pixel, (n,) in scene units: the mean over the edges of faces around.

    `points` (m, 3, 3) are the reflected points at the corners of `triangles` (m, 3), `spots` (n, 2) the places of the
    vertices in pixels.
    """
    moved, across = (np.bincount(triangles.ravel(), np.repeat(edge_lengths(corners).sum(axis=1), 3), len(spots))
                     for corners in (points, spots[triangles]))
    return moved / np.maximum(across, np.finfo(float).tiny)


def _welded(paths: Paths, spots: np.ndarray, triangles: np.ndarray, source: np.ndarray, close: np.ndarray,
            met: SceneAndMirrors) -> np.ndarray:
    """Merge vertices at one place of the picture that show one point of an edge between two source triangles.

    Line Art and Freestyle then find the edge inside a surface, as they find it in the scene.

    Parameters
    ----------
    paths, spots : the vertices (n), and their places (n, 2) in pixels
    triangles : (m, 3) int64, vertices of the faces; all faces at a vertex show the same source triangle
    source : (m,) int64, source triangle of each face
    close : (n,) float64, largest distance between the points that merged vertices show, in scene units

    Returns
    -------
    triangles : (m, 3) int64, with one of the vertices at each place
    """
    shown = np.zeros(len(spots), dtype=np.int64)
    shown[triangles] = source[:, None]
    order = np.lexsort(spots.T)
    pairs = np.concatenate([np.stack((order[:-step], order[step:])) for step in range(1, MOST_IN_CELL)], axis=1)
    pairs = pairs[:, (spots[pairs[0]] == spots[pairs[1]]).all(axis=1)]
    pairs = pairs[:, paths.bounces[pairs[0]] == paths.bounces[pairs[1]]]
    pairs = pairs[:, norm(paths.point[:, pairs[0]] - paths.point[:, pairs[1]]) <= close[pairs].min(axis=0)]
    mesh = met.tree.mesh
    one, other = (mesh.place_of[mesh.triangles[shown[part]]] for part in pairs)
    pairs = pairs[:, (one[:, :, None] == other[:, None, :]).sum(axis=(1, 2)) >= 2]
    stands = np.arange(len(spots))
    if pairs.size:
        group = np.repeat(connected(pairs.T), 2)
        lowest = np.full(int(group.max()) + 1, len(stands))
        np.minimum.at(lowest, group, pairs.T.ravel())
        stands[pairs.T.ravel()] = lowest[group]
    return stands[triangles]
