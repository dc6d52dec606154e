"""How much work one reflection may be: what the picture can show of the mirror, and what the memory holds.

All limits are counts, so that the same input gives the same result on any machine. They grow with the picture of the
mirror and with the meshes; no sample meets one, and Suzanne comes to a quarter of the limit on work. They are met
where much lies over one another in few pixels, as in crowds of mirrors. There what is most crowded is shown by rays
(`crowds`), and the result says so. Without a word rays show pixels in which they are less work than what they show.
"""
from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..support import Settings

# of arrays, at most at one time
CANDIDATE_BYTES, PAIR_BYTES, FACE_BYTES, PIECE_BYTES, TRIANGLE_BYTES = 1400, 160, 1100, 400, 140
LEAST = 1.0 / 4.0  # of the memory, whatever else takes it
LATER = 1.0 / 2.0  # of the limits of a bounce: those of the next
# pixels, where the tolerance is no less: the ray through a pixel's middle is that of a square then
SQUARE, WIDE_SQUARE = 0.5, 1.0
DENSE = 2.0  # candidates that take about as long as a ray and what it shows


@dataclass(frozen=True)
class Limits:
    """Largest counts.

    Attributes
    ----------
    cameras : int, of a bounce, before its outlines are refined
    pairs : int, of cones and triangles that touch
    candidates : int, of cameras and triangles that overlap
    work : int, candidates, each counted once more for every four mirrors that may hide it
    faces : int
    rays : int, through crowded cameras
    square : float, in pixels, the side of the squares through which these rays go, where their number allows it
    dense : float
        Work in such a square, from which on a ray through it shows all that is to be seen there; infinite where all of
        the geometry is asked for.
    bounced : int, cameras of a later bounce
    pieces : int, of the scene's triangles, whole faces among them
    memory : int, bytes of arrays beside those of the meshes
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
        """Limits for a mirror that is seen in so many pixels, of meshes with so many `triangles` altogether."""
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
        """The limits where so many bytes are held by what has been done."""
        room = max(self.memory - held, LEAST * self.memory)
        return replace(self, pairs=int(min(self.pairs, room / PAIR_BYTES)),
                       candidates=int(min(self.candidates, room / CANDIDATE_BYTES)))

    def of_next_bounce(self) -> Limits:
        """Light that has met one mirror more shows less, each part of it smaller: rays show all but the largest."""
        later = {name: int(LATER * most) for name, most in vars(self).items() if isinstance(most, int)}
        return replace(self, **{**later, "cameras": later["bounced"]})
