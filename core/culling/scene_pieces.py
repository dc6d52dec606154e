"""Triangles and pieces of triangles of the diffuse scene that the cameras of a patch still have to show.

The patch shows all other triangles as unclipped triangles. Cameras outside of the patch see the whole scene. The border
between both is a straight side of a mirror triangle, so no cracks are seen there, wherever nodes lie along it.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..cameras import Cameras, PictureCells
from ..geometry import TriangleMesh, rows
from ..trees import SceneTree


@dataclass(frozen=True)
class ScenePieces:
    """Pieces (k) of the triangles of a scene.

    Attributes
    ----------
    mesh : TriangleMesh
        The pieces, on the scene's vertices, followed by the nodes at which triangles were split.
    source : (k,) int64, the triangle of the scene that each piece lies in, or is equal to
    merged : (m, 3) int64, optional
        The scene's triangles on merged vertices, if small details were merged: pieces are parts of these triangles.
    on_patch : (m,) bool, True for mirror triangles on which only these pieces are left to show
    cells : PictureCells, marked where pieces are seen in the picture of the patch
    open : (m,) bool, True for triangles of the patch on which pieces may also be seen outside of the marked cells
    """

    mesh: TriangleMesh
    source: np.ndarray
    on_patch: np.ndarray
    cells: PictureCells
    open: np.ndarray
    merged: np.ndarray | None = None

    @cached_property
    def tree(self) -> SceneTree:
        return SceneTree.of_ordered(self.mesh)

    def holds(self, cameras: Cameras) -> np.ndarray:
        """Return True (n,) for cameras on the patch; always False after the first bounce."""
        return self.on_patch[cameras.face] if cameras.mirror_map.bounce == 1 else np.zeros(len(cameras), dtype=bool)

    def shown(self, cameras: Cameras) -> np.ndarray:
        """Return True (n,) for cameras of the patch that may show some of the pieces."""
        spots = rows(np.clip(np.nan_to_num(cameras.view.pixels(cameras.places.T)), -1e9, 1e9))[:, cameras.corners]
        return self.open[cameras.face] | self.cells.touched(spots.min(axis=2), spots.max(axis=2))
