"""Opacities of triangles that rays may hit: whether they hide objects behind them from the eye and from mirrors."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import Opacity


@dataclass(frozen=True)
class Opacities:
    """Opacities of diffuse triangles; all others are opaque.

    Attributes
    ----------
    of_scene : (m,) int8, optional
        `Opacity` of each triangle of the scene, in the order of its tree; None if all are opaque.
    values : (d,) int8, optional
        The same for all triangles that `SceneAndMirrors` numbers before the mirrors': pieces as well.
    """

    of_scene: np.ndarray | None = None
    values: np.ndarray | None = None

    @classmethod
    def of(cls, of_scene: np.ndarray | None) -> Opacities:
        """Make the opacities of a scene whose triangles (m,) are not divided into pieces."""
        if of_scene is None or (of_scene == Opacity.OPAQUE).all():
            return cls()
        return cls(of_scene, of_scene)

    def with_pieces(self, sources: list[np.ndarray]) -> Opacities:
        """Return a copy with appended pieces; `sources` lists arrays (k,) of the triangles that they are pieces of."""
        if self.of_scene is None:
            return self
        return Opacities(self.of_scene, np.concatenate([self.of_scene, *(self.of_scene[some] for some in sources)]))

    @property
    def all_opaque(self) -> bool:
        return self.of_scene is None

    def stops_light(self, triangle: np.ndarray) -> np.ndarray:
        """Return True (n,) for triangles that hide objects behind them from mirrors."""
        return self._is_one_of(triangle, Opacity.UNSEEN, Opacity.OPAQUE)

    def not_to_cover(self, triangle: np.ndarray) -> np.ndarray:
        """Return True (n,) for triangles that the eye sees, so that layers on a mirror must not cover them."""
        return self._is_one_of(triangle, Opacity.OPEN, Opacity.OPAQUE)

    def _is_one_of(self, triangle: np.ndarray, one: Opacity, other: Opacity) -> np.ndarray:
        found = np.ones(len(triangle), dtype=bool)
        if self.values is not None:
            known = np.flatnonzero((triangle >= 0) & (triangle < len(self.values)))
            values = self.values[triangle[known]]
            found[known] = (values == one) | (values == other)
        return found
