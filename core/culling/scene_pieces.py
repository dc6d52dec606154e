"""What whole faces leave of the diffuse scene to the cameras of their patch: triangles, and pieces of triangles.

All other cameras see the scene as it is. Where both meet is a straight side of a mirror triangle: whatever nodes lie
along it, no crack is seen there.
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
        The pieces between the scene's vertices and, numbered behind these, the nodes that triangles were split at.
    source : (k,) int64, the triangle of the scene that each is a piece of, or is
    merged : (m, 3) int64, optional
        The scene's triangles between the vertices that stand for their corners, where small parts have been drawn
        together: pieces are pieces of these.
    on_patch : (m,) bool, the mirror's triangles on which nothing but these pieces is left to show
    cells : PictureCells, where in the picture on the patch pieces are seen
    open : (m,) bool, triangles of the patch on which pieces may be seen elsewhere too
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
        """Which cameras (n,) lie on the patch, where light has met one mirror."""
        return self.on_patch[cameras.face] if cameras.mirror_map.bounce == 1 else np.zeros(len(cameras), dtype=bool)

    def shown(self, cameras: Cameras) -> np.ndarray:
        """Which cameras (n,) of the patch may show some of them."""
        spots = rows(np.clip(np.nan_to_num(cameras.view.pixels(cameras.places.T)), -1e9, 1e9))[:, cameras.corners]
        return self.open[cameras.face] | self.cells.touched(spots.min(axis=2), spots.max(axis=2))
