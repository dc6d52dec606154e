"""A reflection as triangles that a z-buffer draws: geometry, which any view from the same eye can look at."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..views import View, draw


@dataclass(frozen=True)
class DrawnMesh:
    """Triangles to be drawn over the mirror.

    Attributes
    ----------
    positions : (v, 3) float64
        Where the vertices are drawn.
    triangles : (m, 3) int64
    source : (m,) int64
        The diffuse scene's triangle that each shows.
    point : (v, 3) float64
        The diffuse point that each vertex shows.
    stencilled : bool
        Drawn wherever the mirror is seen and nowhere else; otherwise the mirror hides what lies behind it.
    """

    positions: np.ndarray
    triangles: np.ndarray
    source: np.ndarray
    point: np.ndarray
    stencilled: bool = False

    def seen(self, view: View, mirror_depth: np.ndarray,
             scene_depth: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Find the pixels of a view whose centres show this mesh.

        Parameters
        ----------
        mirror_depth, scene_depth : (height, width) float64, depths of the mirror and of the scene in the view

        Returns
        -------
        pixel : (n,) int64, row times width plus column
        triangle : (n,) int64, of the diffuse scene
        point : (3, n) float64, point of the diffuse scene
        """
        drawn = draw(view, self.positions, self.triangles)
        mirror, scene = mirror_depth.ravel(), scene_depth.ravel()
        shown = (drawn.triangle >= 0) & (mirror < scene) if self.stencilled else drawn.depth < np.minimum(mirror, scene)
        pixel = np.flatnonzero(shown)
        return pixel, self.source[drawn.triangle[pixel]], drawn.interpolate(self.point, self.triangles, pixel)
