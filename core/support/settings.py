"""Settings of `core.reflect`: one number, the tolerance in pixels, and few choices."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .checks import LARGEST, number, whole_number

PLACEMENTS = ("LAYERED", "SURFACE", "VIRTUAL")
METHODS = ("GENERAL", "PARALLEL", "POINTS")
# limits of an automatic depth: bounces, and share of a mirror's pixels that may still see mirrors at the last one
MOST_BOUNCES, LEFT = 8, 0.002
_MOST = 2 ** 62
"""Whole numbers that are larger would not fit the arrays' own."""


@dataclass(frozen=True)
class Settings:
    """Settings of `core.reflect`.

    Parameters
    ----------
    tolerance : float
        Allowed displacement in pixels; drives the refinement of the mirror and of the reflected faces.
    placement : {'LAYERED', 'SURFACE', 'VIRTUAL'}
        Where the mesh lies: slid a little towards the eye in the order of path lengths, on the mirror, or at the
        virtual image's depth.
    method : {'GENERAL', 'PARALLEL', 'POINTS'}
        The general three-ray camera, continuous across mirror triangles, or its discontinuous parallel sibling; or
        every image of a diffuse vertex as a flat disc, for scenes whose triangles are smaller than a pixel.
    depth : int
        How many bounces from mirror to mirror are followed; 1 for a single reflection. Larger than what there is to see
        costs nothing. 0 follows what mirrors see of each other until it is less than `LEFT` of what is seen of them, up
        to `MOST_BOUNCES`.
    maximum_faces : int
        About how many there may be: refinement stops here, and what would take more is shown by rays, as where the
        memory holds no more. The result says so.
    maximum_memory : float
        Gigabytes of arrays. What would need more is worked out more coarsely or refused, and the result says so;
        infinite for no bound.
    hidden_faces : bool
        Also the faces that nearer ones hide whole, for whoever takes objects away; all of the geometry, at the price
        of work for what nobody sees. Scenes that let light through need it not: give `reflect` their opacity.

    Raises
    ------
    ValueError
        Where one of these is out of range or of another kind: numbers may be NumPy's, but no truth values or text, and
        whole ones no floats, not even 2.0.

    Examples
    --------
    >>> from core import Settings
    >>> Settings(tolerance=0.25, depth=2).placement
    'LAYERED'
    >>> Settings(depth=-1)
    Traceback (most recent call last):
        ...
    ValueError: The depth must be a whole number of bounces, at least 1, or 0 for as many as there are to see.
    """

    tolerance: float = 0.5
    placement: str = "LAYERED"
    method: str = "GENERAL"
    depth: int = 1
    maximum_faces: int = 4_000_000
    maximum_memory: float = 2.0
    hidden_faces: bool = False

    def __post_init__(self) -> None:
        tolerance, memory = number(self.tolerance), number(self.maximum_memory)
        depth, faces = whole_number(self.depth), whole_number(self.maximum_faces)
        if not 0.0 < tolerance < float("inf"):
            raise ValueError("The tolerance must be a number of pixels greater than zero.")
        if tolerance > LARGEST:
            raise ValueError("The tolerance must be a number of pixels up to 1e40.")
        if not (isinstance(self.placement, str) and self.placement in PLACEMENTS):
            raise ValueError(f"The placement must be one of {', '.join(PLACEMENTS)}.")
        if not (isinstance(self.method, str) and self.method in METHODS):
            raise ValueError(f"The method must be one of {', '.join(METHODS)}.")
        if depth is None or not 0 <= depth <= _MOST:
            raise ValueError("The depth must be a whole number of bounces, at least 1, or 0 for as many as there "
                             "are to see.")
        if depth > 1 and self.method == "POINTS":
            raise ValueError("Points follow one bounce only: set Bounces (depth) to 1, or let Made Of (method) be "
                             "faces.")
        if faces is None or not 1 <= faces <= _MOST:
            raise ValueError("The maximum_faces must be a whole number of faces, at least 1.")
        if not memory > 0.0:
            raise ValueError("The maximum_memory must be a number of gigabytes greater than zero.")
        if not isinstance(self.hidden_faces, (bool, np.bool_)):
            raise ValueError("The hidden_faces must be True or False.")
        for name, value in (("tolerance", tolerance), ("placement", str(self.placement)), ("method", str(self.method)),
                            ("depth", depth), ("maximum_faces", faces), ("maximum_memory", memory),
                            ("hidden_faces", bool(self.hidden_faces))):
            object.__setattr__(self, name, value)

    @property
    def bounces(self) -> int:
        """Largest number of bounces to follow."""
        if self.depth:
            return self.depth
        return 1 if self.method == "POINTS" else MOST_BOUNCES
