"""How far whole faces sink into the mirror.

The corners of a whole face lie on the mirror, or slid from it towards the eye by a little, the nearer the path the
more. Between them a face over several triangles of a convex mirror sinks, by the sagitta of the mirror. Where that is
more than the room between two layers, or between the mirror and the layer, the picture would show the wrong one.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import dot
from ..patches import Patch
from ..result import DEPTH, GAP
from .images import Images

SINKING = 0.5  # of the room before the mirror: what an edge may take of it; the inside of a face takes a third more


@dataclass(frozen=True)
class Sinking:
    """How far apart layers lie.

    Attributes
    ----------
    patch : Patch
    layered : bool, whether they are apart at all
    size, reach : float, of an orthographic view: what is seen of the mirror, and the longest path
    slide : float, share of what layers slide before other mirrors
    """

    patch: Patch
    layered: bool
    size: float
    reach: float
    slide: float

    def order(self, images: Images, node: np.ndarray | slice = slice(None)) -> np.ndarray:
        """How near nodes (n,) come to the eye, from 0 to 1."""
        s = np.maximum(images.distance[node], 0.0)
        return 1.0 - np.minimum(s / self.reach, 1.0) if self.patch.mirror_map.orthographic else 1.0 / (1.0 + s)

    def sagitta(self, images: Images, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return the sag (e,) of the edges from a to b below the mirror, measured along view rays.

        The unit is the size of the view times the share by which layers slide. Let the ends of an edge over two flat
        triangles lie p and q below the plane of the other end: it sags by p q / (p + q). Over more triangles, as on a
        smooth mirror, it sags by less.
        """
        patch, way, depths = self.patch, images.place[:, b] - images.place[:, a], []
        for end in (a, b):
            flat = patch.mirror_map.surface.face_normal[:, patch.face[images.member[end]]]
            arriving = patch.arriving(images.place[:, end])
            depths.append(np.abs(dot(flat, way)) / np.maximum(np.abs(dot(flat, arriving)), 1e-300))
        one, other = depths
        deepest = one * other / np.maximum(one + other, 1e-300)
        return deepest / (self.slide * (self.size if patch.mirror_map.orthographic else 1.0))

    def deepest(self, images: Images, nodes: np.ndarray) -> np.ndarray:
        """How far the edges of faces (3, f) sink at most."""
        most = np.zeros(nodes.shape[1])
        # a face on one triangle of the mirror does not sink
        some = np.flatnonzero(images.several(nodes))
        for edge in sides(nodes[:, some]):
            most[some] = np.maximum(most[some], self.sagitta(images, *edge))
        return most

    def sunk(self, images: Images, nodes: np.ndarray) -> np.ndarray:
        """Which faces (3, f) sink nearly to the mirror."""
        some = np.flatnonzero(images.several(nodes))
        found = np.zeros(nodes.shape[1], dtype=bool)
        for edge in sides(nodes[:, some]):
            found[some] |= self.too_deep(images, *edge)
        return found

    def too_deep(self, images: Images, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Which edges (e,) from a to b sink nearly to the mirror."""
        if not self.layered:
            return np.zeros(len(a), dtype=bool)
        order = np.minimum(self.order(images, a), self.order(images, b))
        return self.sagitta(images, a, b) > SINKING * (GAP + DEPTH * order)


def sides(nodes: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """The ends of the edges 01, 12 and 20 of faces (3, f)."""
    a, b, c = nodes
    return (a, b), (b, c), (c, a)
