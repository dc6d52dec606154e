"""Assembly of the part made by rays from the eye, as the plain arrays of the result."""
from __future__ import annotations

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
    norm,
    others,
    rows,
)
from .backward_part import BackwardPart
from .paths import Paths

SAG_OF_FACE = 4.0 / 3.0     # sag of a face whose three edges sag alike, as a multiple of theirs
STEEPEST = 0.1      # largest sag of an edge, in viewing distances: at a silhouette planes are seen edge on
MOST_IN_CELL = 4    # largest number of vertices at one place of the picture: one for each corner of a cell
CLOSE = 0.1         # pixels: largest distance between the points that they show; with 0.75, p99 of a torus rises by a half


def backward_arrays(part: BackwardPart, met: SceneAndMirrors) -> dict:
    """Return the arrays of `ReflectionMesh` except its positions; triangle indices are in the canonical order.

    `lift` (n,) is how far vertices must move towards the eye so that no face lies behind the mirror, as `place` takes it.
    """
    paths, spots, cells = part.faces()
    used, corner = distinct(cells.faces.ravel())
    paths, spots, triangles = paths.select(used), spots[used], corner.reshape(-1, 3)
    source = part.source(cells.key)
    close = CLOSE * _motion(paths.point.T[triangles], spots, triangles)
    kept, triangles = _welded(paths, spots, triangles, source, close, met)
    paths, spots, close = paths.select(kept), spots[kept], close[kept]
    found, column = distinct(source)
    frames = SceneFrames.of(met, found)
    weights = frames.weights_within(np.repeat(column, 3), paths.point[:, triangles.ravel()]).T.reshape(-1, 3, 3)
    corners = rows(met.positions[frames.vertices[:, column]])
    normals = area_normals(corners)
    height = sum(dot(normals, columns(paths.origin, node) - corners[:, 0]) for node in triangles.T)
    turned = np.less(height, 0.0)
    order = np.where(turned[:, None], (0, 2, 1), (0, 1, 2))
    area = np.linalg.det(weights)
    parity = np.zeros(len(spots))
    sign = np.sign(area) * np.where(turned, -1.0, 1.0) * (-1.0)**paths.bounces[triangles[:, 0]]
    np.add.at(parity, triangles.ravel(), np.repeat(sign, 3))
    # a face's side along an edge of its source is exactly on that edge
    greatest = weights.max(axis=2)
    for corner, (one, other) in enumerate(map(others, range(3))):
        height, own = norm(normals) / norm(corners[:, one] - corners[:, other]), weights[..., corner]
        own[(own * height[:, None] <= close[triangles]) & (own < greatest)] = 0.0
    weights /= weights.sum(axis=2, keepdims=True)
    face = paths.face[triangles]
    return {
        "triangles": np.take_along_axis(triangles, order, axis=1), "reflected_position": paths.point.T,
        "mirror_position": paths.place.T, "path_length": paths.total,
        "image_parity": np.sign(parity).astype(np.int8), "mirror_normals": np.moveaxis(paths.normal, 2, 0),
        "source_face": met.of_scene(source), "source_weights": np.take_along_axis(weights, order[:, :, None], axis=1),
        "mirror_face": np.where((face == face[:, :1]).all(axis=1), face[:, 0], -1),
        "map_face": face[:, 0], "bounces": paths.bounces[triangles[:, 0]].astype(np.int8),
        "later_mirrors": paths.later.T[triangles[:, 0]], "lift": _lift(part, paths, triangles)}


def _lift(part: BackwardPart, paths: Paths, triangles: np.ndarray) -> np.ndarray:
    """Return how far the mirror lies before the faces around each vertex (n,), in units of `View.directions`."""
    surface, ahead = part.tracer.surface, part.view.directions(paths.place.T).T
    normal, place = surface.face_normal[:, paths.face], surface.a[:, paths.face]

    def before(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        """Return how far the plane of the mirror at `one` is before `other`, on the view ray of `other`."""
        with np.errstate(divide="ignore", invalid="ignore"):
            found = dot(normal[:, one], paths.place[:, other] - place[:, one]) / dot(normal[:, one], ahead[:, other])
        return np.clip(np.nan_to_num(found), -STEEPEST, STEEPEST)
    sag = np.zeros(len(triangles))
    for start, end in zip(triangles.T, np.roll(triangles.T, -1, axis=0)):
        # along an edge, a convex mirror is no nearer than the farther one of the planes at both ends
        one, other = (before(start, start), before(start, end)), (before(end, start), before(end, end))
        rise, fall = one[1] - one[0], other[0] - other[1]
        share = np.clip((other[0] - one[0]) / np.maximum(rise + fall, np.finfo(float).tiny), 0.0, 1.0)
        for way in (0.0, share, 1.0):
            np.maximum(sag, np.minimum(one[0] + way * rise, other[0] - way * fall), out=sag)
    lift = np.zeros(len(paths.face))
    np.maximum.at(lift, triangles, SAG_OF_FACE * sag[:, None])
    return lift


def _motion(points: np.ndarray, spots: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Return how far the reflected point moves per pixel, (n,) in scene units: the largest value of the faces around.

    `points` (m, 3, 3) are the reflected points at the corners of `triangles` (m, 3), `spots` (n, 2) the vertices' places
    in pixels.
    """
    moved, across = edge_lengths(points).max(axis=1), edge_lengths(spots[triangles]).max(axis=1)
    motion = np.zeros(len(spots))
    np.maximum.at(motion, triangles, (moved / np.maximum(across, np.finfo(float).tiny))[:, None])
    return motion


def _welded(paths: Paths, spots: np.ndarray, triangles: np.ndarray, source: np.ndarray, close: np.ndarray,
            met: SceneAndMirrors) -> tuple[np.ndarray, np.ndarray]:
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
    kept : (k,) int64
        The vertices that are left.
    triangles : (m, 3) int64
        Indices into these.
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
    kept, corner = distinct(stands[triangles].ravel())
    return kept, corner.reshape(-1, 3)
