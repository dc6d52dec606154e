"""What points of a mesh know, as arrays."""
from __future__ import annotations

import bpy
import numpy as np


def vectors(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    """An attribute of the points, (n, 3) float64."""
    values = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes[name].data.foreach_get("vector", values.reshape(-1))
    return values.astype(np.float64)
