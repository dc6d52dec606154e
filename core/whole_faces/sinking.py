"""Chord sag: the depth to which unclipped faces sink below the mirror between their corners.

The corners of such a face lie on the mirror, or a little before it towards the eye, the more the shorter the path.
Between them a face over several triangles of a convex mirror sags below it, by the mirror's sagitta. If that exceeds
the gap between two layers, or between the mirror and the layer, the picture would show the wrong one.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import dot
from ..patches import Patch
from ..result import DEPTH, GAP
from .images import Images

SINKING = 0.5  # share of the gap before the mirror that an edge may sag by; the inside of a face sags a third more


@dataclass(frozen=True)
class Sinking:
    """Distances between layers, and the chord sag of faces in these terms.

    Attributes
    ----------
    patch : Patch
    layered : bool, False if layers do not slide apart
    size, reach : float, for orthographic views: size of the visible mirror, and longest path, in scene units
    slide : float, share of the usual distance that layers slide
    """

    patch: Patch
    layered: bool
    size: float
    reach: float
    slide: float

    def order(self, images: Images, node: np.ndarray | slice = slice(None)) -> np.ndarray:
        """Return the depth order of nodes `node` (n,), from 0 to 1 for the shortest path, nearest to the eye."""
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
        """Return the largest sag (f,) of the edges of faces with corners `nodes` (3, f), as in `sagitta`."""
        most = np.zeros(nodes.shape[1])
        # a face on one triangle of the mirror does not sag
        some = np.flatnonzero(images.several(nodes))
        for edge in sides(nodes[:, some]):
            most[some] = np.maximum(most[some], self.sagitta(images, *edge))
        return most

    def sunk(self, images: Images, nodes: np.ndarray) -> np.ndarray:
        """Return True for faces with corners `nodes` (3, f) that have an edge which sags too deep."""
        some = np.flatnonzero(images.several(nodes))
        found = np.zeros(nodes.shape[1], dtype=bool)
        for edge in sides(nodes[:, some]):
            found[some] |= self.too_deep(images, *edge)
        return found

    def too_deep(self, images: Images, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return True for edges from nodes `a` to `b` (e,) that sag by more than `SINKING` of their gap."""
        if not self.layered:
            return np.zeros(len(a), dtype=bool)
        order = np.minimum(self.order(images, a), self.order(images, b))
        return self.sagitta(images, a, b) > SINKING * (GAP + DEPTH * order)


def sides(nodes: np.ndarray) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Return the end nodes, (f,) each, of the edges 01, 12 and 20 of faces with corners `nodes` (3, f)."""
    a, b, c = nodes
    return (a, b), (b, c), (c, a)
