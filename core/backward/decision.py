"""Which parts of a mirror are made backwards: those whose triangles are too small for cameras of their own."""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh, connected
from .lattice import Lattice

FEW_PIXELS = 4.0    # for each of a part's triangles, seen or not, up to which one ray for each pixel is less work


def small_parts(mirror: TriangleMesh, lattice: Lattice, face: np.ndarray) -> np.ndarray:
    """Return the triangles (m,) of the connected parts of a mirror that are small against a pixel.

    Parameters
    ----------
    face : (n,) int64
        The triangle that is seen at each point of the lattice, -1 for none.
    """
    part = connected(mirror.triangles)
    triangles = np.bincount(part)
    pixels = np.bincount(part[face[face >= 0]], minlength=len(triangles)) * lattice.step**2
    return (pixels < FEW_PIXELS * triangles)[part]
