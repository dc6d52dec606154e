"""Count of overlapping caustic faces."""
from __future__ import annotations

import numpy as np

from ..support import portions

SAMPLES = 256  # faces whose centroids are tested
AT_ONCE = 1 << 20
SLIVER = 1e-6  # doubled area over squared size: thinner faces are ignored


def most_layers(positions: np.ndarray, triangles: np.ndarray, source_face: np.ndarray) -> int:
    """Return the largest number of caustic faces that overlap at a sampled point of one receiver triangle.

    Parameters
    ----------
    positions : (n, 3) float, vertices
    triangles : (m, 3) int, the faces
    source_face : (m,) int, receiver triangle of each face
    """
    asked = np.unique(np.linspace(0, len(triangles) - 1, SAMPLES).astype(np.int64))
    corners = positions[triangles].astype(np.float64)
    a, b, c = np.moveaxis(corners, 1, 0)
    normal, size = np.cross(b - a, c - a), np.abs(corners - corners[:, :1]).max(axis=(1, 2))
    covers = np.linalg.norm(normal, axis=1) > SLIVER * size**2
    middle, most = corners[asked].mean(axis=1), 0
    # (second - first) x (place - first) . normal
    sides = [(towards, np.einsum("ij,ij->i", towards, first)) for first, towards in (
        (first, np.cross(normal, second - first)) for first, second in ((a, b), (b, c), (c, a)))]
    step = max(AT_ONCE // max(len(triangles), 1), 1)
    for own in portions(len(asked), step):
        inside = (source_face[asked[own], None] == source_face[None]) & covers
        for towards, least in sides:
            inside &= middle[own] @ towards.T >= least
        most = max(most, int(inside.sum(axis=1).max()))
    return most
