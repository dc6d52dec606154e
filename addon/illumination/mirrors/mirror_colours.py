"""Compute the light that remains after several mirrors, by the material of each triangle."""
from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ....core import breathe
from ...reading import MirrorSurface
from .tint import Tint


@dataclass(frozen=True)
class MirrorColours:
    """The colours of mirrors.

    Attributes
    ----------
    tints : list of Tint
        Tints of all materials.
    tint_of : (k,) int64
        Index of the tint of each triangle, of all mirrors in order.
    """

    tints: list
    tint_of: np.ndarray

    @classmethod
    def of(cls, surfaces: Iterable[MirrorSurface]) -> MirrorColours:
        """Collect the colours of `surfaces`, whose triangles are numbered one mirror after another."""
        tints: list[Tint] = []
        tint_of = [np.zeros(0, dtype=np.int64)]
        for surface in surfaces:
            tint_of.append(len(tints) + surface.material.astype(np.int64))
            tints += [Tint.of_material(material) for material in surface.materials]
        return cls(tints, np.concatenate(tint_of))

    def ordered(self, triangle: np.ndarray) -> MirrorColours:
        """Return the colours for the triangles with indices `triangle` (n,)."""
        return MirrorColours(self.tints, self.tint_of[triangle])

    def left(self, met: np.ndarray, cosine: np.ndarray) -> np.ndarray:
        """Return the remaining share of red, green and blue.

        Parameters
        ----------
        met : (n, b) int64
            Triangles that light meets, in order; -1 after the last one.
        cosine : (n, ..., b) float64
            Cosines of the angles of incidence, negative at back faces.

        Returns
        -------
        (n, ..., 3) float64
        """
        left = np.ones((*cosine.shape[:-1], 3))
        for bounce in range(met.shape[1]):
            tint = np.where(met[:, bounce] >= 0, np.append(self.tint_of, -1)[met[:, bounce]], -1)
            for index, one in enumerate(self.tints):
                breathe()
                own = np.flatnonzero(tint == index)
                if len(own):
                    left[own] *= one.at(cosine[own, ..., bounce])
        return left
