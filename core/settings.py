"""What the user asks for: one number, the tolerance in pixels, and few choices."""
from __future__ import annotations

from dataclasses import dataclass

PLACEMENTS = ("LAYERED", "SURFACE", "VIRTUAL")
METHODS = ("GENERAL", "PARALLEL", "POINTS")


@dataclass(frozen=True)
class Settings:
    """How `core.reflect` works.

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
        How many bounces from mirror to mirror are followed; 1 for a single reflection.
    maximum_faces : int
        Refinement stops here and the result says so.
    """

    tolerance: float = 0.5
    placement: str = "LAYERED"
    method: str = "GENERAL"
    depth: int = 1
    maximum_faces: int = 4_000_000

    def __post_init__(self) -> None:
        if not 0.0 < float(self.tolerance) < float("inf"):
            raise ValueError("The tolerance must be a number of pixels greater than zero.")
        if self.placement not in PLACEMENTS:
            raise ValueError(f"The placement must be one of {', '.join(PLACEMENTS)}.")
        if self.method not in METHODS:
            raise ValueError(f"The method must be one of {', '.join(METHODS)}.")
        if self.depth < 1:
            raise ValueError("The depth must be at least one bounce.")
        if self.depth > 1 and self.method == "POINTS":
            raise ValueError("Points follow one bounce only; set the depth to 1 or choose another method.")
        if self.maximum_faces < 1:
            raise ValueError("The maximum number of faces must be at least 1.")
