"""Read mesh attributes as arrays."""
from __future__ import annotations

import bpy
import numpy as np


def vectors(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Return a vector attribute of the points, (n, 3) float64."""
    values = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes[name].data.foreach_get("vector", values.reshape(-1))
    return values.astype(np.float64)


def corner_vertices(mesh: bpy.types.Mesh) -> np.ndarray:
    """Return the vertex indices (n, 3) of a mesh of triangles."""
    return numbers(mesh, ".corner_vert").reshape(-1, 3)


def numbers(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """Return an attribute with one number per point, corner or face, (n,) int32 or float32."""
    attribute = mesh.attributes[name]
    values = np.empty(len(attribute.data), dtype=np.float32 if attribute.data_type == "FLOAT" else np.int32)
    attribute.data.foreach_get("value", values)
    return values
