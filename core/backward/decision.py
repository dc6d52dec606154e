"""Selection of the mirror parts made backwards: parts whose triangles are too small for one camera each."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import TriangleMesh, connected
from .lattice import Lattice

FEW_PIXELS = 4.0        # pixels per triangle of a part, visible or not, below which one ray per pixel is less work
# the same for parts that see mirrors, per triangle of theirs or of any mirror: cameras multiply with each bounce
FEW_IF_MIRRORS = 1024.0
MOST_POINTS = 1 << 21   # largest lattice for this selection; larger ones are made coarser
SPARSE = 8      # lattice points per tested point, along both axes, in the test if a part sees mirrors
SEEN = 0.02     # share of the tested points that see a mirror, above which the part counts as seeing mirrors


def may_have_small_parts(mirror: TriangleMesh, lattice: Lattice, mirrors: int) -> bool:
    """Return False if the mirror's box in the picture has too many pixels per triangle for any part to be small.

    `mirrors` is the number of triangles of all mirrors that it may see, 0 if the depth is one.
    """
    pixels = lattice.size[0] * lattice.size[1] * lattice.step**2
    return pixels < max(2.0 * FEW_PIXELS * len(mirror.triangles), FEW_IF_MIRRORS * mirrors)


def small_parts(mirror: TriangleMesh, lattice: Lattice, face: np.ndarray,
                sees_mirrors: Callable[[np.ndarray], np.ndarray], mirrors: int) -> np.ndarray:
    """Return True (m,) for triangles of connected parts of the mirror that have few pixels per triangle.

    Parameters
    ----------
    face : (n,) int64
        The triangle that is seen at each point of the lattice, -1 for none.
    sees_mirrors : callable
        Takes points (k,) of the lattice and returns True (k,) for those that see a mirror in the mirror.
    mirrors : int
        Number of triangles of all mirrors that it may see, 0 if the depth is one.
    """
    part = connected(mirror.triangles)
    triangles = np.bincount(part)
    at = np.flatnonzero(face >= 0)
    pixels = np.bincount(part[face[at]], minlength=len(triangles)) * lattice.step**2
    chosen = pixels < FEW_PIXELS * triangles
    doubtful = ~chosen & (pixels < FEW_IF_MIRRORS * mirrors)
    if doubtful.any():
        row, column = np.divmod(at, lattice.size[0])
        some = at[(row % SPARSE == 0) & (column % SPARSE == 0)]
        some = some[doubtful[part[face[some]]]]
        own = part[face[some]]
        seen = np.bincount(own, sees_mirrors(some), len(triangles))
        chosen |= doubtful & (seen > SEEN * np.bincount(own, minlength=len(triangles)))
    return chosen[part]
