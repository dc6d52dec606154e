"""Limits on the work for one reflection, from the mirror's size in the picture and from the memory.

All limits are counts, so that the same input gives the same result on any machine. They grow with the picture of the
mirror and with the meshes. No sample scene reaches one; Suzanne reaches a quarter of the limit on work. They are
reached where many triangles overlap in few pixels, as in crowds of mirrors. Then the most crowded cameras are sampled
by rays (`crowds`), and the result reports it. Pixels in which rays cost less than clipping are sampled without a
report.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..support import Settings

# peak size of all arrays, per candidate, pair, face, piece and triangle
CANDIDATE_BYTES, PAIR_BYTES, FACE_BYTES, PIECE_BYTES, TRIANGLE_BYTES = 1400, 160, 1100, 400, 140
LEAST = 1.0 / 4.0  # share of the memory that is always used, even if meshes and earlier results take more
LATER = 1.0 / 2.0  # factor from the limits of one bounce to those of the next
# side of a square in pixels, if the tolerance is not smaller: the ray through a pixel's centre is that of a square then
SQUARE, WIDE_SQUARE = 0.5, 1.0
DENSE = 2.0  # number of candidates that cost as much as one ray and its cell


@dataclass(frozen=True)
class Limits:
    """Largest counts of one bounce.

    Attributes
    ----------
    cameras : int, cameras before outlines are refined
    pairs : int, pairs of a cone and a triangle that touch
    candidates : int, pairs of a camera and a triangle that overlap
    work : int, candidates, each counted once more for every four mirrors that may hide it
    faces : int
    rays : int, rays through crowded cameras
    square : float, side in pixels of the squares that these rays sample, if their number allows it
    dense : float
        Cost in such a square, in candidates, above which a ray samples it; infinite if hidden faces are requested.
    bounced : int, cameras of a later bounce
    pieces : int, pieces of the scene's triangles, including unclipped triangles
    memory : int, bytes of arrays, without the meshes
    """

    cameras: int
    pairs: int
    candidates: int
    work: int
    faces: int
    rays: int
    bounced: int
    pieces: int
    memory: int
    square: float
    dense: float

    @classmethod
    def of(cls, settings: Settings, pixels: int, triangles: int) -> Limits:
        """Return the limits for a mirror of so many `pixels` in the picture, and meshes of so many `triangles`."""
        memory, faces = 1e9 * settings.maximum_memory, settings.maximum_faces
        memory = max(memory - TRIANGLE_BYTES * triangles, LEAST * memory)
        return cls(int(min(10_000 + 4 * pixels, faces)),
                   int(min(400_000 + 16 * pixels + 8 * triangles, memory / PAIR_BYTES)),
                   int(min(100_000 + 8 * pixels + 4 * triangles, memory / CANDIDATE_BYTES, faces)),
                   int(50_000 + 10 * pixels + 8 * triangles),
                   int(min(200_000 + 32 * pixels + 16 * triangles, memory / FACE_BYTES, faces)),
                   int(min(8000 + pixels, 500_000, faces)), int(min(8000 + pixels // 2, faces // 16)),
                   int(min(200_000 + 32 * pixels + triangles, memory / PIECE_BYTES)), int(min(memory, 2.0**62)),
                   WIDE_SQUARE if settings.tolerance >= WIDE_SQUARE else min(SQUARE, settings.tolerance),
                   np.inf if settings.hidden_faces else DENSE)

    def beside(self, held: int) -> Limits:
        """Return the limits if earlier results hold so many bytes (`held`)."""
        room = max(self.memory - held, LEAST * self.memory)
        return replace(self, pairs=int(min(self.pairs, room / PAIR_BYTES)),
                       candidates=int(min(self.candidates, room / CANDIDATE_BYTES)))

    def of_next_bounce(self) -> Limits:
        """Return the smaller limits of the next bounce.

        Images after one more mirror are fewer and smaller, so rays sample all but the largest.
        """
        later = {name: int(LATER * most) for name, most in vars(self).items() if isinstance(most, int)}
        return replace(self, **{**later, "cameras": later["bounced"]})
