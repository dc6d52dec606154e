"""A lamp in the eye's place: it lights what it sees of a mirror, and what stands in the way casts a shadow."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, norm
from .view import View

SURE = 1e-6  # radians


@dataclass(frozen=True)
class LampView(View):
    """A view from a lamp, whose picture ends exactly at its borders, so that several such views make a whole one.

    Parameters
    ----------
    shades : TriangleMesh, optional
        What may stand between the lamp and the mirror: the mirror is seen only where none of it stands before it.
    screens : TriangleMesh, optional
        What may stand behind the mirror on the light's way: it hides what lies behind it, as mirrors do, and reflects
        nothing. The diffuse scene may be a part of it.
    cone : (3,) float64 and float, optional
        Axis, a unit vector, and half angle in radians of a cone round all of the light.
    """

    shades: TriangleMesh | None = None
    screens: TriangleMesh | None = None
    cone: tuple[np.ndarray, float] | None = None

    def lights(self, corners: np.ndarray) -> np.ndarray:
        """Return True for triangles with `corners` (3, 3, m), as [component, corner, triangle], that may be lit."""
        if self.cone is None:
            return np.ones(corners.shape[2], dtype=bool)
        return in_cone(self.cone, corners - self.eye[:, None, None])


def in_cone(cone: tuple[np.ndarray, float], ways: np.ndarray) -> np.ndarray:
    """Return True for triangles (m,) that may overlap a cone.

    Parameters
    ----------
    cone : (3,) float64 and float, unit axis and half angle in radians
    ways : (3, 3, m) float64, vectors from the apex to the corners, as [component, corner, triangle]
    """
    axis, half = cone
    middle = ways.mean(axis=1)
    radius = norm(ways - middle[:, None]).max(axis=0)
    distance = norm(middle)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = np.arccos(np.clip(np.tensordot(axis, middle, 1) / distance, -1.0, 1.0))
        return ~(off > half + np.arcsin(np.minimum(radius / distance, 1.0)) + SURE) | (distance <= radius)
