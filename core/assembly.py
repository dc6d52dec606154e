"""Assembly: nodes and faces as the plain arrays of the result."""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .connection import Faces
from .reflection_map import ReflectionMap
from .nodes import Nodes
from .placement import place as placed
from .reflection_mesh import ReflectionMesh
from .scene_frames import SceneFrames
from .vectors import groups, norm, rows
from .view import View

ON_CAUSTIC = 1e-5  # magnification below which bisection has put a node on the caustic


def assemble(view: View, mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames, positions: np.ndarray,
             nodes: Nodes, faces: Faces, placement: str) -> ReflectionMesh:
    """The faces as arrays, no two on the same nodes, without unused nodes, all turned to the eye."""
    # doubled triangles of the scene, and polygons that fold flat, give the same face twice
    once, _ = groups(*np.sort(faces.nodes, axis=1).T)
    faces = faces.select(np.sort(once))
    used, corner = np.unique(faces.nodes, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    place, point = nodes.place[:, used], nodes.point[:, used].copy()
    pixels = view.pixels(place.T)[triangles]
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    away = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0.0
    triangles[away] = triangles[away][:, [0, 2, 1]]
    column = np.repeat(faces.column, 3)
    weights = frames.weights(column, np.take(point, triangles.ravel(), axis=1))
    # straight outlines may leave a corner a fraction of a pixel beside its triangle: it takes the point of the rim
    beside = np.flatnonzero(weights.min(axis=0) < 0.0)
    weights = np.maximum(weights, 0.0)
    weights /= weights.sum(axis=0)
    rim = rows(positions[frames.vertices[:, column[beside]]])
    point[:, triangles.ravel()[beside]] = (rim * weights[:, beside]).sum(axis=1)
    path, ahead = norm(point - place), norm(view.directions(place.T).T)
    nodes = Nodes(place, point, path / ahead)
    mirror_face = cameras.face[faces.camera]
    owner = np.zeros(len(used), dtype=np.int64)
    owner[triangles.ravel()] = np.repeat(mirror_face, 3)
    turned = mirror_map.turned(owner, mirror_map.coordinates(owner, nodes.place), nodes.distance)
    parity = np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned)).astype(np.int8)
    return ReflectionMesh(
        positions=placed(view, nodes, path, placement).T, triangles=triangles,
        reflected_position=nodes.point.T, mirror_position=nodes.place.T, path_length=path, image_parity=parity,
        source_face=frames.triangle[faces.column], source_weights=weights.T.reshape(-1, 3, 3), mirror_face=mirror_face)
