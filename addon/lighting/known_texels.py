"""Texels of a rendered picture of light, found again for a reflection that was generated for another view.

A matte source point has the same light from everywhere. So the source point of each texel is kept in memory while the
file is open, and faces that show the same points look their light up there.
"""
from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np
from mathutils.kdtree import KDTree

from .light_paths import LightPaths

MOST_PATHS = 4_000_000  # texels of a picture, whose paths take 77 bytes each
MOST = 100_000      # texels that are remembered of a picture; between them places are found by their linear change
NEAR = 4.0          # texels between those remembered, from which on a point is not in the picture
APART = 8.0         # times the length that a face's side should have in texels, from which on it spans two parts
FEWEST = 0.5        # share of the faces that must be found


class Texels(NamedTuple):
    """Some texels of a picture: a tree of the points that they show, their places (n, 2) from 0 to 1, how points change
    along a row and along a column (n, 2, 3), how many texels stand for one, the picture's size; all of its paths, if
    they are no more than `MOST_PATHS`, and how often the light of each has been copied (h, w)."""

    tree: KDTree
    spots: np.ndarray
    changes: np.ndarray
    stride: float
    size: np.ndarray
    paths: LightPaths | None
    age: np.ndarray


_known: dict[int, Texels] = {}


def remember(image: bpy.types.Image, paths: LightPaths, age: np.ndarray) -> None:
    """Remember the points that the texels of a picture of light show, and how often their light was copied."""
    row, column = np.nonzero(paths.used)
    stride = max(1, -(-len(row) // MOST))
    row, column = row[::stride], column[::stride]
    tree = KDTree(len(row))
    for number, point in enumerate(paths.target[row, column].tolist()):
        tree.insert(point, number)
    tree.balance()
    size = np.array(paths.used.shape[::-1])
    changes = np.stack((paths.across[row, column], paths.up[row, column]), axis=1).astype(np.float64)
    for uid in set(_known) - {one.session_uid for one in bpy.data.images}:
        del _known[uid]
    _known[image.session_uid] = Texels(tree, (np.stack((column, row), axis=1) + 0.5) / size, changes, stride, size,
                                       paths if paths.used.size <= MOST_PATHS else None, age)


def known_texels(image: bpy.types.Image) -> Texels | None:
    """Return what is remembered of a picture."""
    return _known.get(image.session_uid)


def found_again(image: bpy.types.Image | None, points: np.ndarray) -> np.ndarray | None:
    """Return where in a picture of light the corners (m, 3, 3) of faces lie that show these points: (m, 3, 2) from 0 to
    1; None if the picture is not known, or most faces are not in it."""
    known = None if image is None else _known.get(image.session_uid)
    if known is None or not len(points):
        return None
    own, back = np.unique(points.reshape(-1, 3), axis=0, return_inverse=True)
    found = [known.tree.find(point) for point in own.tolist()]
    at, nearest = np.array([place[:] for place, _, _ in found]), np.array([number for _, number, _ in found])
    # where between the texels: the least squares of the points' linear change
    changes = known.changes[nearest]
    steps = np.einsum("nij,njk->nik", (own - at)[:, None], np.linalg.pinv(changes))[:, 0]
    texel = np.linalg.norm(changes, axis=2).max(axis=1)
    left = np.linalg.norm(own - at - np.einsum("ni,nij->nj", steps, changes), axis=1)
    reach = NEAR * np.sqrt(known.stride)
    inside = (np.abs(steps) < reach).all(axis=1) & (left <= texel)
    back = back.reshape(-1, 3)
    spots = (known.spots[nearest] + np.where(inside[:, None], steps, 0.0) / known.size)[back]
    whole = inside[back].all(axis=1) & _holds_together(known, spots, points, texel[back])
    if whole.mean() < FEWEST:
        return None
    # a face of which not all is known shows the colour of one corner
    spots[~whole] = spots[~whole][:, :1]
    return spots


def _holds_together(known: Texels, spots: np.ndarray, points: np.ndarray, texel: np.ndarray) -> np.ndarray:
    """Return True for faces (m,) whose corners lie as far apart in the picture as their points are from each other."""
    in_picture = np.linalg.norm((np.roll(spots, -1, axis=1) - spots) * known.size, axis=2)
    in_scene = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2) / np.maximum(texel, 1e-30)
    return (in_picture <= APART * (in_scene + 1.0)).all(axis=1)
