"""Triangles cut along the outlines of the pieces that a mirror shows: each part then lies in one piece, or in none.

Pieces of one image lie side by side, those of several over one another; Blender's constrained Delaunay triangulation
cuts along all of them at once. It works in single precision and takes its time for all that lies in one plane, and so
a few triangles at a time are laid out beside each other, each as half a unit square.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from mathutils import Vector
from mathutils.geometry import delaunay_2d_cdt

from ...core import PicturePieces
from ..faults import Steps

ACROSS = 4          # triangles beside each other in a layout, and as many rows
NEAR = 1e-6         # of a triangle's side for each of them: what is nearer is one place
HULL = 0            # all triangles of the layout: Blender does not tell rightly which lie in what is thin


@dataclass(frozen=True)
class Parts:
    """Parts of triangles: of those that a mirror shows, what it shows of them apart from the rest.

    Attributes
    ----------
    face : (n,) int64
        Triangle that each part lies in.
    weights : (n, 3, 3) float64
        Barycentric coordinates of the part's corners in it.
    pixels : (n, 3, 2) float64
        Where the corners are seen in the largest image that shows the part; no numbers where none does.
    """

    face: np.ndarray
    weights: np.ndarray
    pixels: np.ndarray

    @property
    def seen(self) -> np.ndarray:
        """(n,) bool: whether the mirror shows the part."""
        return np.isfinite(self.pixels[:, 0, 0])


def cut_triangles(pieces: PicturePieces, count: int) -> Steps[Parts]:
    """Cut triangles 0 to `count` along `pieces`, which lie in them; yields (fraction, stage)."""
    number = np.bincount(pieces.face, minlength=count)
    whole = np.flatnonzero(number == 0)
    done = [Parts(whole, np.tile(np.eye(3), (len(whole), 1, 1)), np.full((len(whole), 3, 2), np.nan))]
    order = np.argsort(pieces.face, kind="stable")
    first = np.cumsum(number) - number
    # triangles of as many pieces together: the layout is as exact as the finest of them needs
    cut = np.flatnonzero(number)
    cut = cut[np.argsort(number[cut], kind="stable")]
    for start in range(0, len(cut), ACROSS**2):
        yield start / len(cut), "Cutting faces"
        chosen = np.sort(cut[start:start + ACROSS**2])
        inside = np.concatenate([order[first[face]:first[face] + number[face]] for face in chosen])
        done.append(_cut(chosen, pieces.select(inside)))
    return Parts(*(np.concatenate([getattr(part, name) for part in done]) for name in ("face", "weights", "pixels")))


def _cut(chosen: np.ndarray, pieces: PicturePieces) -> Parts:
    """Cut the triangles `chosen`, in rising order, along the pieces that lie in them, in one layout."""
    near = NEAR * ACROSS
    corners = np.concatenate((np.tile(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), (len(chosen), 1, 1)),
                              pieces.weights[:, :, 1:]))
    cell = np.concatenate((np.arange(len(chosen)), np.searchsorted(chosen, pieces.face)))
    # sides of what is thinner than what counts as one place would cross each other there
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    high = np.abs(_doubled(corners)) > 4.0 * near * longest
    laid_out = (corners + _place(cell)[:, None])[high].reshape(-1, 2)
    numbers = np.arange(len(laid_out)).reshape(-1, 3)
    sides = np.stack((numbers, np.roll(numbers, -1, axis=1)), axis=2).reshape(-1, 2)
    points, _, triangles, *_ = delaunay_2d_cdt(list(map(Vector, laid_out.tolist())), sides.tolist(), [], HULL, near,
                                               False)
    found = np.array([tuple(point) for point in points])[np.array(triangles, dtype=np.int64).reshape(-1, 3)]
    own = (found.mean(axis=1) // 2).astype(np.int64) @ (1, ACROSS)
    found = (found - _place(own)[:, None])[own < len(chosen)]
    own = own[own < len(chosen)]
    within = (found.mean(axis=1).sum(axis=1) < 1.0) & (_doubled(found) > 0.0)
    face, found = chosen[own[within]], found[within]
    weights = _clean(np.concatenate((1.0 - found.sum(axis=2, keepdims=True), found), axis=2), near)
    piece = pieces.holding(face, weights.mean(axis=1))
    pixels = np.full((len(found), 3, 2), np.nan)
    seen = np.flatnonzero(piece >= 0)
    shares = np.maximum(weights[seen] @ np.linalg.inv(pieces.weights[piece[seen]]), 0.0)
    pixels[seen] = shares / shares.sum(axis=2, keepdims=True) @ pieces.pixels[piece[seen]]
    return Parts(face, weights, pixels)


def _place(cell: np.ndarray) -> np.ndarray:
    """Lower left corners (n, 2) of cells (n,) in the layout, a side's length between them."""
    return 2.0 * np.stack((cell % ACROSS, cell // ACROSS), axis=1)


def _doubled(corners: np.ndarray) -> np.ndarray:
    """Twice the areas (n,) of triangles (n, 3, 2)."""
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return ux * vy - uy * vx


def _clean(weights: np.ndarray, near: float) -> np.ndarray:
    """Barycentric coordinates without what single precision leaves beside the sides of a triangle."""
    weights = np.where(weights < near, 0.0, weights)
    return weights / weights.sum(axis=2, keepdims=True)

