"""Rotations, and whole scenes that are turned, scaled and moved."""
from __future__ import annotations

import numpy as np

from core import TriangleMesh, View


def random_rotation(rng: np.random.Generator) -> np.ndarray:
    """A rotation (3, 3), all directions alike."""
    rotation, upper = np.linalg.qr(rng.normal(0.0, 1.0, (3, 3)))
    rotation *= np.sign(np.diag(upper))
    return rotation * np.sign(np.linalg.det(rotation))


def placed_mesh(mesh: TriangleMesh, rotation: np.ndarray, scale: float, offset: np.ndarray,
                with_normals: bool) -> TriangleMesh:
    """The mesh turned, then scaled, then moved; without normals of its own unless `with_normals`."""
    normals = mesh.corner_normals @ rotation.T if with_normals else None
    return TriangleMesh(mesh.positions @ rotation.T * scale + offset, mesh.triangles, normals)


def placed_view(view: View, rotation: np.ndarray, scale: float, offset: np.ndarray) -> View:
    """The eye that sees of a scene so placed what `view` sees of the scene as it was."""
    camera, projection = view.camera_to_world.copy(), view.projection.copy()
    camera[:3, :3] = rotation @ camera[:3, :3]
    camera[:3, 3] = rotation @ camera[:3, 3] * scale + offset
    # an orthographic picture holds a width in scene units
    projection[:2, :2] /= scale if view.orthographic else 1.0
    return View(camera, projection, view.resolution)
