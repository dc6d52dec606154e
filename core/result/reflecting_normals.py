"""How a mirror must stand to show what it shows."""
from __future__ import annotations

import numpy as np

from ..geometry import View


def reflecting_normals(view: View, mirror_position: np.ndarray, reflected_position: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3), in world space and towards the eye, of a mirror that shows the points `reflected_position`
    (n, 3) at `mirror_position` (n, 3): halfway between the ways to the eye and to the points, by the law of reflection.

    Where a point lies on the mirror its way has no direction, and the normal is the way to the eye.
    """
    to_eye = -view.directions(mirror_position)
    to_eye /= np.maximum(np.linalg.norm(to_eye, axis=1, keepdims=True), np.finfo(float).tiny)
    way = reflected_position - mirror_position
    length = np.linalg.norm(way, axis=1, keepdims=True)
    normal = to_eye + np.divide(way, length, out=np.zeros_like(way), where=length > 0.0)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    return np.where(size > 0.0, normal / np.where(size > 0.0, size, 1.0), to_eye)
