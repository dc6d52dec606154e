"""Assembly of the part made by rays from the eye, as the plain arrays of the result."""
from __future__ import annotations

import numpy as np

from ..culling import SceneAndMirrors
from ..geometry import SceneFrames, area_normals, columns, distinct, dot, norm, rows
from .backward_part import BackwardPart


def backward_arrays(part: BackwardPart, met: SceneAndMirrors) -> dict:
    """Return the arrays of `ReflectionMesh` except its positions; triangle indices are in the canonical order."""
    paths, spots, cells = part.faces()
    used, corner = distinct(cells.faces.ravel())
    paths, spots, triangles = paths.select(used), spots[used], corner.reshape(-1, 3)
    source = part.source(cells.key)
    found, column = distinct(source)
    frames = SceneFrames.of(met, found)
    weights = frames.weights_within(np.repeat(column, 3), paths.point[:, triangles.ravel()]).T.reshape(-1, 3, 3)
    # all faces at a vertex have the same source triangle, so a vertex needs one reflected point only
    corners = rows(met.positions[frames.vertices[:, column]])
    normals = area_normals(corners)
    height = sum(dot(normals, columns(paths.origin, node) - corners[:, 0]) for node in triangles.T)
    turned = np.less(height, 0.0)
    order = np.where(turned[:, None], (0, 2, 1), (0, 1, 2))
    area = np.linalg.det(weights)
    parity = np.zeros(len(spots))
    sign = np.sign(area) * np.where(turned, -1.0, 1.0) * (-1.0)**paths.bounces[triangles[:, 0]]
    np.add.at(parity, triangles.ravel(), np.repeat(sign, 3))
    face = paths.face[triangles]
    return {
        "triangles": np.take_along_axis(triangles, order, axis=1), "reflected_position": paths.point.T,
        "mirror_position": paths.place.T, "path_length": paths.length + norm(paths.point - paths.origin),
        "image_parity": np.sign(parity).astype(np.int8), "mirror_normals": np.moveaxis(paths.normal, 2, 0),
        "source_face": met.of_scene(source), "source_weights": np.take_along_axis(weights, order[:, :, None], axis=1),
        "mirror_face": np.where((face == face[:, :1]).all(axis=1), face[:, 0], -1),
        "map_face": face[:, 0], "bounces": paths.bounces[triangles[:, 0]].astype(np.int8),
        "later_mirrors": paths.later.T[triangles[:, 0]]}
