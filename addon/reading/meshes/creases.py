"""Which edges of a mesh are creases in the places where it stands.

Where a mesh is only moved, turned and scaled evenly its angles are its own: they are told once, but for those so near
the limit that rounding decides.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# faces that meet at less than 140 degrees, Line Art's own default, make a crease
CREASE = np.cos(np.radians(180.0 - 140.0))
EVEN = 1e-5  # of its size: what the metric of a place differs from that of one which keeps all angles
DOUBT = 1e-4  # of a cosine: several times what that can change


@dataclass(frozen=True)
class Creases:
    """The creases of a mesh in its places (k).

    Attributes
    ----------
    creased : (e,) bool
        Edges that are creases in all places that are `even`, if they are `sure`.
    sure : (e,) bool
    even : (k,) bool
    meeting : (2, c) int32
        The faces on both sides of an edge that has two.
    meeting_of : (e,) int32
        Where each edge is among those, -1 where it is not.
    normals : (p, 3) float32
        Of the faces.
    metrics : (k, 3, 3) float64
        Scalar products of normals in each place.
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
        """The creases where `cofactors` (k, 3, 3) take the normals of the mesh to the world."""
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
        """Which of the edges (n, 3) are creases in the places (n,)."""
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
    """Scalar products of normals (n, 3), by these times the metric of the place where they stand, and the ones below
    which faces meet in a crease."""
    return _dot(turned, other), CREASE * np.sqrt(_dot(turned, one) * _dot(other_turned, other))


def _dot(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", one, other)
