"""Depth order of unclipped faces: faces that nearer ones hide, and faces too close to be drawn in order."""
from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np

from ..culling import Opacities
from ..geometry import distinct, mask, rows
from ..result import DEPTH, GAP
from ..support import INSIDE
from ..views import Covered
from .images import Images
from .picture_samples import Grid, least_around
from .sinking import Sinking

APART = 1e-6  # share of the nearness: a surface that is nearer by less does not hide a face


@dataclass(frozen=True)
class Layers:
    """Visibility and order of whole faces, in a scene with the given opacities."""

    images: Images
    sinking: Sinking
    opacities: Opacities

    def hidden_and_close(self, nodes: np.ndarray, source: np.ndarray, solid: np.ndarray,
                         near: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return two masks (f,) of the faces with corners `nodes` (3, f), of source triangles `source` (f,).

        The first marks `solid` (f,) faces that nearer solid faces which stop light hide entirely. The second marks
        other faces so close to one another, or behind scene triangles with corners `near` (3, 3, t), that moving them
        could change the picture.
        """
        sinking, stops = self.sinking, self.opacities.stops_light(source)
        grid = Grid.over(sinking.patch)
        corners, order = grid.spots(self.images.pixel[:, nodes]), sinking.order(self.images)[nodes]
        covered = Covered.of(corners, order, grid.size, False)
        hidden = _hidden(solid & stops, covered, corners, order, grid.size) & solid
        pixels = grid.size[0] * grid.size[1]
        close = np.zeros(nodes.shape[1], dtype=bool)
        if sinking.layered:
            left = ~hidden[covered.face]
            face, pixel, order_there = covered.face[left], covered.pixel[left], covered.order[left]
            for one in self._close(nodes, stops, (face, pixel, order_there), pixels):
                close[one] = True
            close[self._behind_contacts(nodes, face, pixel, grid, near)] = True
        return hidden, close

    def _close(self, nodes, stops, samples, pixels: int) -> Generator[np.ndarray, None, None]:
        """Yield faces whose sag exceeds the gap to the next face behind them, layer by layer from the nearest.

        Deeper layers are examined where no nearer face stops light.

        Parameters
        ----------
        nodes : (3, f) int64, corners of the faces
        stops : (f,) bool, True for faces that stop light
        samples : tuple of face (k,), pixel (k,) and nearness (k,) at each sample
        pixels : int, number of pixels of the grid
        """
        face, pixel, near = samples
        while len(face):
            first, second = np.full(pixels, -1.0), np.full(pixels, -1.0)
            np.maximum.at(first, pixel, near)
            ahead = near >= first[pixel]
            np.maximum.at(second, pixel[~ahead], near[~ahead])
            # only the sag of the nearer faces counts: faces behind may sag
            over = ahead & (second[pixel] >= 0.0)
            above, column = distinct(face[over])
            sagitta = INSIDE * self.sinking.deepest(self.images, nodes[:, above])
            yield face[over][DEPTH * (first - second)[pixel[over]] <= sagitta[column]]
            seen_through = ~mask(pixels, pixel[ahead & stops[face]])
            ahead |= ~seen_through[pixel]
            face, pixel, near = face[~ahead], pixel[~ahead], near[~ahead]

    def _behind_contacts(self, nodes, face, pixel, grid: Grid, near: np.ndarray) -> np.ndarray:
        """Return faces that the scene hides from the eye so closely that they would slide through it.

        Parameters
        ----------
        nodes : (3, f) int64, corners of the faces
        face, pixel : (k,) int64, of the samples on `grid`
        near : (3, 3, t) float64, corners of the scene's triangles, as [component, corner, triangle]
        """
        patch = self.sinking.patch
        depth = patch.view.depths(near.reshape(3, -1).T).reshape(near.shape[1:])
        ahead = (depth > 0.0).all(axis=0)
        near, depth = near[:, :, ahead], depth[:, ahead]
        if not depth.size:
            return face[:0]
        spots = grid.spots(rows(patch.view.pixels(near.reshape(3, -1).T)).reshape(2, *depth.shape))
        nearness = -depth if patch.mirror_map.orthographic else 1.0 / depth
        scene = Covered.of(spots, nearness, grid.size, True)
        front = np.full(grid.size[0] * grid.size[1], -np.inf)
        np.maximum.at(front, scene.pixel, scene.order)
        some = np.isfinite(front[pixel])
        face, pixel = face[some], pixel[some]
        over, column = distinct(face)
        depth = patch.view.depths((self.images.place[:, nodes[:, over].ravel()] + patch.eye).T).reshape(3, -1)
        size = self.sinking.size if patch.mirror_map.orthographic else depth.max(axis=0)
        slid = self.sinking.slide * (GAP + DEPTH) * size
        lowest, highest = depth.min(axis=0) - 2.0 * slid, depth.max(axis=0)
        lowest, highest = (-end if patch.mirror_map.orthographic else 1.0 / end for end in (lowest, highest))
        return face[(front[pixel] >= highest[column]) & (front[pixel] <= lowest[column])]


def _hidden(solid: np.ndarray, covered: Covered, corners: np.ndarray, order: np.ndarray,
            size: tuple[int, int]) -> np.ndarray:
    """Return True for faces (f,) that `solid` (f,) ones hide, by their `corners` (2, 3, f) and their `order` (3, f)
    there, on a grid of this size."""
    front, own = np.full(size[0] * size[1], -1.0), solid[covered.face]
    np.maximum.at(front, covered.pixel[own], covered.order[own])
    shown = mask(len(solid), covered.face[covered.order >= front[covered.pixel]])
    # a face that is hidden at all pixel centres may still be seen between them
    doubtful = np.flatnonzero(~shown)
    touched = Covered.of(corners[:, :, doubtful], order[:, doubtful], size, True)
    around = least_around(front.reshape(size[::-1])).ravel()
    inside = np.bincount(touched.face, minlength=len(doubtful)) > 0
    shown[doubtful[~inside]] = True
    shown[doubtful[touched.face[touched.order * (1.0 + APART) >= around[touched.pixel]]]] = True
    return ~shown
