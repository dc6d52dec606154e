"""Which parts of a mirror are made backwards: those whose triangles are too small for cameras of their own."""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..geometry import TriangleMesh, connected
from .lattice import Lattice

# pixels for each of a part's triangles, seen or not, up to which one ray for each pixel is less work; of parts that see
# mirrors, which takes cameras many times as long
FEW_PIXELS, FEW_IF_MIRRORS = 4.0, 32.0
MOST_POINTS = 1 << 21   # of a lattice, from which on parts are told apart on a coarser one
SPARSE = 8      # of the lattice's points along both axes one is asked whether it sees a mirror
SEEN = 0.02     # share of a part that sees mirrors, from which on it is one of these


def may_have_small_parts(mirror: TriangleMesh, lattice: Lattice) -> bool:
    """Return False for a mirror whose box in the picture holds so many pixels that none of its parts is looked at."""
    pixels = lattice.size[0] * lattice.size[1] * lattice.step**2
    return pixels < 2.0 * FEW_IF_MIRRORS * len(mirror.triangles)


def small_parts(mirror: TriangleMesh, lattice: Lattice, face: np.ndarray,
                sees_mirrors: Callable[[np.ndarray], np.ndarray] | None) -> np.ndarray:
    """Return the triangles (m,) of the connected parts of a mirror that are small against a pixel.

    Parameters
    ----------
    face : (n,) int64
        The triangle that is seen at each point of the lattice, -1 for none.
    sees_mirrors : callable, optional
        Tells of points (k,) of the lattice where a mirror is seen in the mirror; None if that is the end.
    """
    part = connected(mirror.triangles)
    triangles = np.bincount(part)
    at = np.flatnonzero(face >= 0)
    pixels = np.bincount(part[face[at]], minlength=len(triangles)) * lattice.step**2
    chosen = pixels < FEW_PIXELS * triangles
    doubtful = ~chosen & (pixels < FEW_IF_MIRRORS * triangles)
    if sees_mirrors is not None and doubtful.any():
        row, column = np.divmod(at, lattice.size[0])
        some = at[(row % SPARSE == 0) & (column % SPARSE == 0)]
        some = some[doubtful[part[face[some]]]]
        own = part[face[some]]
        seen = np.bincount(own, sees_mirrors(some), len(triangles))
        chosen |= doubtful & (seen > SEEN * np.bincount(own, minlength=len(triangles)))
    return chosen[part]
