"""Triangles cut along the outlines of the pieces that a mirror shows: each part then lies in one piece, or in none.

Most triangles that are seen are tiled by the pieces of one image, or are one of them, and those are the parts. Where
a mirror shows a triangle in part, or in several images over one another, Blender's constrained Delaunay triangulation
cuts it along all outlines at once.
"""
from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from itertools import pairwise

import numpy as np
from mathutils import Vector
from mathutils.geometry import delaunay_2d_cdt

from ...core import PicturePieces, in_steps
from ...core.geometry import solve
from ..faults import Steps, part

NEAR = 1e-6         # relative to a triangle's side; closer points are equal
HULL = 0            # option for all triangles of the convex hull, since Blender's face origins are not always right
AT_ONCE = 200       # number of pieces between two interruptions for the user interface
INWARDS = 0.9       # share of the way from a piece's middle to its corners; other pieces begin at its border


@dataclass(frozen=True)
class Parts:
    """Parts of triangles, each entirely visible in the mirror or not at all.

    Attributes
    ----------
    face : (n,) int64
        Triangle that contains each part.
    weights : (n, 3, 3) float64
        Barycentric coordinates of the part's corners in it.
    pixels : (n, 3, 2) float64
        Pixel positions of the corners in the largest image of the part; NaN if it is not visible.
    """

    face: np.ndarray
    weights: np.ndarray
    pixels: np.ndarray

    @property
    def seen(self) -> np.ndarray:
        """True (n,) for parts that the mirror shows."""
        return np.isfinite(self.pixels[:, 0, 0])


def cut_triangles(pieces: PicturePieces, count: int) -> Steps[Parts]:
    """Cut triangles 0 to `count` along `pieces`, which lie in them; yields (fraction, stage)."""
    number = np.bincount(pieces.face, minlength=count)
    whole = np.flatnonzero(number == 0)
    done = [Parts(whole, np.tile(np.eye(3), (len(whole), 1, 1)), np.full((len(whole), 3, 2), np.nan))]
    tiled = _tiled(pieces, count)
    yield 0.0, "Cutting faces"
    kept = pieces.select(tiled[pieces.face])
    turned = (np.linalg.det(kept.weights) < 0.0)[:, None, None]
    done.append(Parts(kept.face, np.where(turned, kept.weights[:, ::-1], kept.weights),
                      np.where(turned, kept.pixels[:, ::-1], kept.pixels)))
    yield 0.0, "Cutting faces"
    order = np.argsort(pieces.face, kind="stable")
    first = np.cumsum(number) - number
    cut = np.flatnonzero((number > 0) & ~tiled)
    before, total, looked = np.cumsum(number[cut]) - number[cut], number[cut].sum(), -1
    # one by one: laid out beside each other in one plane, triangles come back without some of their sides
    for face, along in zip(cut.tolist(), before.tolist()):
        if along // AT_ONCE > looked:
            looked = along // AT_ONCE
            yield along / total, "Cutting faces"
        own = pieces.select(order[first[face]:first[face] + number[face]])
        done.append((yield from part(_cut(face, own), along / total, 0.0, "Cutting faces")))
    joined = []
    for name in ("face", "weights", "pixels"):
        yield 1.0, "Cutting faces"
        joined.append(np.concatenate([getattr(part, name) for part in done]))
    yield 1.0, "Cutting faces"
    return Parts(*joined)


def _tiled(pieces: PicturePieces, count: int) -> np.ndarray:
    """Return True (count,) for triangles that the pieces of a single image cover completely."""
    area = np.bincount(pieces.face, np.abs(np.linalg.det(pieces.weights)), minlength=count)
    low, high = np.full(count, len(pieces.face)), np.full(count, -1)
    np.minimum.at(low, pieces.face, pieces.image)
    np.maximum.at(high, pieces.face, pieces.image)
    return (low == high) & (np.abs(area - 1.0) < NEAR)


def _cut(face: int, pieces: PicturePieces) -> Steps[Parts]:
    """Cut the triangle `face`, as half a unit square, along the pieces that lie in it."""
    covered = yield from in_steps(partial(_covered, pieces))
    pieces = pieces.select(~covered)
    yield 0.0, ""
    corners = np.concatenate(([[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]], pieces.weights[:, :, 1:]))
    # sides of what is thinner than what counts as one place would cross each other there
    corners = corners[np.abs(_doubled(corners)) > 4.0 * NEAR * _longest(corners)].reshape(-1, 2)
    numbers = np.arange(len(corners)).reshape(-1, 3)
    sides = np.stack((numbers, np.roll(numbers, -1, axis=1)), axis=2).reshape(-1, 2)
    given = list(map(Vector, corners.tolist())), sides.tolist(), [], HULL, NEAR, False
    yield 0.0, ""
    points, _, polygons, *_ = delaunay_2d_cdt(*given)
    yield 0.0, ""
    # among slivers a face may have more corners than three, and one of them twice
    triangles = [(first, *pair) for first, *others in polygons for pair in pairwise(others)]
    found = np.array([tuple(point) for point in points])[np.array(triangles, dtype=np.int64).reshape(-1, 3)]
    found = found[_doubled(found) > NEAR * _longest(found)]
    weights = _clean(np.concatenate((1.0 - found.sum(axis=2, keepdims=True), found), axis=2))
    faces = np.full(len(found), face)
    yield 0.0, ""
    piece = yield from in_steps(partial(pieces.holding, faces, weights.mean(axis=1)))
    pixels = np.full((len(found), 3, 2), np.nan)
    seen = np.flatnonzero(piece >= 0)
    yield 0.0, ""
    shares = np.maximum(_within(weights[seen], pieces.weights[piece[seen]]), 0.0)
    pixels[seen] = shares / shares.sum(axis=2, keepdims=True) @ pieces.pixels[piece[seen]]
    return Parts(faces, weights, pixels)


def _within(spots: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Return barycentric coordinates (n, m, 3) of `spots` (n, m, 3) in triangles with `corners` (n, 3, 3).

    By Cramer's rule: OpenBLAS divides each inverse of a small matrix between threads, and where other work keeps the
    processors busy, as a render does, these wait for each other thousands of times as long as they work.
    """
    one, other, third = corners.transpose(1, 2, 0)
    return np.stack([solve(one, other, third, spot) for spot in spots.transpose(1, 2, 0)]).transpose(2, 0, 1)


def _covered(pieces: PicturePieces) -> np.ndarray:
    """Return True (k,) for pieces of one triangle that larger images cover, at the middle and near each corner.

    A mirror may show the triangle several times, in a dozen images that overlap. A piece is a part of the triangle as
    one image shows it, see `PicturePieces`. The caller ignores covered pieces.
    """
    middle = pieces.weights.mean(axis=1, keepdims=True)
    spots = np.concatenate((middle, middle + INWARDS * (pieces.weights - middle)), axis=1)
    first = pieces.holding(np.repeat(pieces.face, 4), spots.reshape(-1, 3)).reshape(-1, 4)
    return ((first >= 0) & (pieces.image[first] < pieces.image[:, None])).all(axis=1)


def _doubled(corners: np.ndarray) -> np.ndarray:
    """Return twice the areas (n,) of triangles (n, 3, 2)."""
    (ux, uy), (vx, vy) = (corners[:, 1] - corners[:, 0]).T, (corners[:, 2] - corners[:, 0]).T
    return ux * vy - uy * vx


def _longest(corners: np.ndarray) -> np.ndarray:
    """Return the length (n,) of the longest side of triangles (n, 3, 2)."""
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)


def _clean(weights: np.ndarray) -> np.ndarray:
    """Return barycentric coordinates without rounding errors at the sides of a triangle."""
    weights = np.where(weights < NEAR, 0.0, weights)
    return weights / weights.sum(axis=2, keepdims=True)
