"""Assembly: nodes and faces as the plain arrays of the result."""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .connection import Faces
from .mirror_map import MirrorMap
from .nodes import Nodes
from .placement import place, slide_limits
from .reflection_mesh import ReflectionMesh
from .scene_frames import SceneFrames
from .vectors import norm
from .view import View

ON_CAUSTIC = 1e-5  # magnification below which bisection has put a node on the caustic


def assemble(view: View, mirror_map: MirrorMap, cameras: Cameras, frames: SceneFrames, nodes: Nodes, faces: Faces,
             placement: str) -> ReflectionMesh:
    """The faces as arrays, without unused nodes, all turned to the eye."""
    used, corner = np.unique(faces.nodes, return_inverse=True)
    triangles = corner.reshape(-1, 3)
    nodes = Nodes(nodes.place[:, used], nodes.point[:, used], nodes.distance[used])
    mirror_face = cameras.face[faces.camera]
    owner = np.zeros(len(used), dtype=np.int64)
    owner[triangles.ravel()] = np.repeat(mirror_face, 3)
    ray = mirror_map.rays(owner, mirror_map.coordinates(owner, nodes.place)) if len(used) else nodes.place
    path = nodes.distance * norm(ray)
    turned = mirror_map.turned(owner, mirror_map.coordinates(owner, nodes.place), nodes.distance)
    parity = np.where(np.abs(turned) < ON_CAUSTIC, 0, np.sign(turned)).astype(np.int8)
    pixels = view.pixels(nodes.place.T)[triangles]
    u, v = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    away = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0] < 0.0
    triangles[away] = triangles[away][:, [0, 2, 1]]
    column = np.repeat(faces.column, 3)
    weights = frames.weights(column, np.take(nodes.point, triangles.ravel(), axis=1))
    most = slide_limits(view, nodes, path, frames, triangles, faces.column)
    return ReflectionMesh(
        positions=place(view, nodes, path, placement, most).T, triangles=triangles,
        reflected_position=nodes.point.T, mirror_position=nodes.place.T, path_length=path, image_parity=parity,
        source_face=frames.triangle[faces.column], source_weights=weights.T.reshape(-1, 3, 3), mirror_face=mirror_face)
