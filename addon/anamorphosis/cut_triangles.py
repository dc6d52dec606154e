"""Triangles cut along the outlines of the pieces that a mirror shows: each part then lies in one piece, or in none.

Pieces of one image lie side by side, those of several over one another; Blender's constrained Delaunay triangulation
cuts along all of them at once. It works in single precision and takes its time for all that lies in one plane, and so
a few triangles at a time are laid out beside each other, each as half a unit square.
"""
from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

import numpy as np
from mathutils import Vector
from mathutils.geometry import delaunay_2d_cdt

from ...core import PicturePieces
from ..faults import Steps

ACROSS = 4          # triangles beside each other in a layout, and as many rows
NEAR = 1e-6         # of a triangle's side for each of them: what is nearer is one place
INSIDE = 1          # what Blender calls triangles without those of the convex hull


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
        chosen = cut[start:start + ACROSS**2]
        inside = np.concatenate([order[first[face]:first[face] + number[face]] for face in chosen])
        done.append(_cut(chosen, pieces, inside))
    return Parts(*(np.concatenate([getattr(part, name) for part in done]) for name in ("face", "weights", "pixels")))


def _cut(chosen: np.ndarray, pieces: PicturePieces, inside: np.ndarray) -> Parts:
    """Cut the triangles `chosen` along the pieces `inside`, in one layout."""
    near = NEAR * ACROSS
    cell = np.searchsorted(np.sort(chosen), pieces.face[inside])
    chosen = np.sort(chosen)
    corners = pieces.weights[inside][:, :, 1:]
    doubled = _doubled(corners)
    # the triangulation wants them turned to the left, and higher than what it takes for one place
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    high = np.flatnonzero(np.abs(doubled) > 4.0 * near * longest)
    inside, cell, turned = inside[high], cell[high], doubled[high] < 0.0
    corners = np.where(turned[:, None, None], corners[high][:, ::-1], corners[high])
    halves = np.tile(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)), (len(chosen), 1, 1))
    cells = np.concatenate((np.arange(len(chosen)), cell))
    places = np.concatenate((halves, corners)) + _place(cells)[:, None]
    numbers = np.arange(3 * len(places)).reshape(-1, 3).tolist()
    points, _, triangles, _, _, origins = delaunay_2d_cdt(list(map(Vector, places.reshape(-1, 2).tolist())), [],
                                                          numbers, INSIDE, near, True)
    found = np.array([tuple(point) for point in points])[np.array(triangles, dtype=np.int64).reshape(-1, 3)]
    middle = found.mean(axis=1)
    own = (middle // 2).astype(np.int64) @ (1, ACROSS)
    found -= _place(own)[:, None]
    weights = _clean(np.concatenate((1.0 - found.sum(axis=2, keepdims=True), found), axis=2), near)
    piece = _largest(middle - _place(own), origins, len(chosen), corners, pieces.image[inside])
    pixels = np.full((len(found), 3, 2), np.nan)
    seen = np.flatnonzero(piece >= 0)
    shown = np.where(turned[:, None, None], pieces.pixels[inside][:, ::-1], pieces.pixels[inside])[piece[seen]]
    shares = np.maximum(_barycentric(corners[piece[seen]], found[seen]), 0.0)
    pixels[seen] = shares / shares.sum(axis=2, keepdims=True) @ shown
    kept = _doubled(weights[:, :, 1:]) > 0.0
    return Parts(chosen[own[kept]], weights[kept], pixels[kept])


def _place(cell: np.ndarray) -> np.ndarray:
    """Lower left corners (n, 2) of cells (n,) in the layout, a side's length between them."""
    return 2.0 * np.stack((cell % ACROSS, cell // ACROSS), axis=1)


def _largest(middle: np.ndarray, origins: list, before: int, corners: np.ndarray, image: np.ndarray) -> np.ndarray:
    """Piece (n,) of the largest image that holds the middle of each triangle; -1 where there is none.

    Blender tells too many for triangles beside very thin pieces; that the middle lies inside is asked of all.
    """
    triangle = np.repeat(np.arange(len(origins)), np.fromiter(map(len, origins), np.int64, len(origins)))
    piece = np.fromiter(chain.from_iterable(origins), np.int64, len(triangle)) - before
    triangle, piece = triangle[piece >= 0], piece[piece >= 0]
    holds = (_barycentric(corners[piece], middle[triangle][:, None])[:, 0] > 0.0).all(axis=1)
    triangle, piece = triangle[holds], piece[holds]
    order = np.lexsort((image[piece], triangle))
    first = np.unique(triangle[order], return_index=True)[1]
    found = np.full(len(origins), -1)
    found[triangle[order[first]]] = piece[order[first]]
    return found


def _doubled(corners: np.ndarray) -> np.ndarray:
    """Twice the areas (n,) of triangles (n, 3, 2)."""
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return ux * vy - uy * vx


def _barycentric(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Barycentric coordinates (n, k, 3) of points (n, k, 2) in triangles (n, 3, 2)."""
    (ux, uy), (vx, vy) = (corners[:, 1:] - corners[:, :1]).transpose(1, 2, 0)[..., None]
    x, y = np.moveaxis(points - corners[:, :1], 2, 0)
    area = ux * vy - uy * vx
    second, third = (x * vy - y * vx) / area, (ux * y - uy * x) / area
    return np.stack((1.0 - second - third, second, third), axis=2)


def _clean(weights: np.ndarray, near: float) -> np.ndarray:
    """Barycentric coordinates without what single precision leaves beside the sides of a triangle."""
    weights = np.where(weights < near, 0.0, weights)
    return weights / weights.sum(axis=2, keepdims=True)

