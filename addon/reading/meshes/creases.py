"""Find the creases of a mesh in each of its placements.

A placement that is only moved, rotated and evenly scaled keeps the angles between faces. So these are computed once,
except for edges so near the limit that rounding decides.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# faces that meet at less than 140 degrees, Line Art's own default, make a crease
CREASE = np.cos(np.radians(180.0 - 140.0))
EVEN = 1e-5  # largest deviation of a placement's metric from an even scale, relative to its size
DOUBT = 1e-4  # relative distance of a cosine to the limit below which each placement is tested


@dataclass(frozen=True)
class Creases:
    """The creases of a mesh in its k placements.

    Attributes
    ----------
    creased : (e,) bool
        True for edges that are creases in all `even` placements; valid where `sure` is set.
    sure : (e,) bool
        False for edges so near the limit that they are tested in each placement.
    even : (k,) bool
        True for placements that keep angles.
    meeting : (2, c) int32
        The faces on both sides of each edge that has two.
    meeting_of : (e,) int32
        Column of each edge in `meeting`, -1 for edges without two faces.
    normals : (p, 3) float32
        Normals of the faces.
    metrics : (k, 3, 3) float64
        Matrices of the scalar product of two normals in each placement.
    """

    creased: np.ndarray
    sure: np.ndarray
    even: np.ndarray
    meeting: np.ndarray
    meeting_of: np.ndarray
    normals: np.ndarray
    metrics: np.ndarray

    @classmethod
    def of(cls, meeting: np.ndarray, meeting_of: np.ndarray, normals: np.ndarray, cofactors: np.ndarray) -> Creases:
        """Compute the creases for placements whose matrices `cofactors` (k, 3, 3) transform normals to world space."""
        metrics = np.matmul(cofactors.swapaxes(1, 2), cofactors)
        one, other = normals[meeting].astype(np.float64)
        creased, sure = np.zeros(len(meeting_of), dtype=bool), np.ones(len(meeting_of), dtype=bool)
        two = meeting_of >= 0
        if len(metrics) == 1:
            even = np.ones(1, dtype=bool)
            product, limit = _products(one, other, one @ metrics[0], other @ metrics[0])
        else:
            size = np.trace(metrics, axis1=1, axis2=2) / 3.0
            even = np.abs(metrics - size[:, None, None] * np.eye(3)).max(axis=(1, 2)) < EVEN * size
            product, limit = _products(one, other, one, other)
            sure[two] = np.abs(product - limit) > DOUBT * limit
        creased[two] = product < limit
        return cls(creased, sure, even, meeting, meeting_of, normals, metrics)

    def among(self, edge: np.ndarray, place: np.ndarray) -> np.ndarray:
        """Return True (n, 3) for each of the edges `edge` (n, 3) that is a crease in its placement `place` (n,)."""
        found = self.creased[edge]
        if self.sure.all() and self.even.all():
            return found
        row, side = np.nonzero(~(self.sure[edge] & self.even[place][:, None]) & (self.meeting_of[edge] >= 0))
        metric = self.metrics[place[row]]
        one, other = self.normals[self.meeting[:, self.meeting_of[edge[row, side]]]].astype(np.float64)
        product, limit = _products(one, other, *(np.matmul(normal[:, None], metric)[:, 0] for normal in (one, other)))
        found[row, side] = product < limit
        return found


def _products(one: np.ndarray, other: np.ndarray, turned: np.ndarray,
              other_turned: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the scalar products (n,) of the normals `one` and `other` (n, 3) in a placement, and the limits (n,) below
    which their faces meet in a crease. `turned` and `other_turned` are the normals times the placement's metric.
    """
    return _dot(turned, other), CREASE * np.sqrt(_dot(turned, one) * _dot(other_turned, other))


def _dot(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", one, other)
