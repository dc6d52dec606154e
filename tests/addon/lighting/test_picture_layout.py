"""Where a picture of light lies on a result: faces are cut until a UV map is linear enough."""
from __future__ import annotations

import bpy
import numpy as np


def test_slivers_are_cut_until_the_map_is_linear(blank, room):
    """Triangles a thousand times as long as wide, at all angles, on a floor that reaches far from the eye; what is
    cut covers what it did, once."""
    rng = np.random.default_rng(4)
    start, way = rng.uniform(-1.0, 1.0, (300, 2)), rng.normal(size=(300, 2))
    length = rng.uniform(1.0, 3.0, (300, 1))
    way *= length / np.linalg.norm(way, axis=1)[:, None]
    across = 1e-3 * rng.uniform(0.01, 1.0, (300, 1)) * way[:, ::-1] * (-1.0, 1.0)
    corners = np.zeros((300, 3, 3))
    corners[..., :2] = np.stack((start, start + way, start + rng.uniform(0.1, 0.9, (300, 1)) * way + across), axis=1)
    mesh = bpy.data.meshes.new("Slivers")
    mesh.from_pydata(corners.reshape(-1, 3).tolist(), [], np.arange(900).reshape(-1, 3).tolist())
    blank.scene.camera.location, blank.scene.camera.rotation_euler = (0.0, -4.0, 0.7), (1.4, 0.0, 0.0)
    blank.view_layer.update()
    place, view = room("addon.lighting.picture.picture_layout"), room("addon.reading").read_view(blank)
    area, matrix = sum(face.area for face in mesh.polygons), np.eye(4)
    straying = len(place._straying(mesh, view, matrix))
    assert straying > 100
    room("addon.faults").finished(room("addon.writing").halve_edges(mesh, lambda: place._straying(mesh, view, matrix)))
    assert not len(place._straying(mesh, view, matrix))
    assert len(mesh.polygons) < 300 + 40 * straying
    assert abs(sum(face.area for face in mesh.polygons) - area) < 1e-5 * area
