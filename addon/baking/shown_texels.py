"""Texels of an object's picture of which mirrors show but a part, or nothing: their own bodies hide the rest."""
from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...core import breathe
from ...core.geometry import ranges, shares
from ..rendering import grown
from .mirror_bodies import MirrorBodies

AT_ONCE = 1 << 18  # texels, in the boxes of triangles
ALONG = 4  # places along a side of a texel, of which some may be hidden


def shown_texels(bodies: MirrorBodies, corners: np.ndarray, spots: np.ndarray, size: np.ndarray,
                 turned: bool) -> np.ndarray | None:
    """How much of each texel of a picture is not hidden by `bodies`.

    Parameters
    ----------
    corners, spots : (n, 3, 3) and (n, 3, 2) float64
        Of triangles, in space, and in the picture, in texels.
    size : (2,) int64
        Width and height of the picture.
    turned : bool
        Whether it shows their backs.

    Returns
    -------
    shown : (height, width) float32, or None
        From 0, also where its middle is hidden, to 1; None where nothing is.
    """
    near = bodies.near(corners)
    corners, spots = corners[near], spots[near]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals *= (-1.0 if turned else 1.0) / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    steps, found, shown = _steps(corners, spots), [], np.ones(size[::-1], dtype=np.float32)

    def hidden(row: np.ndarray, column: np.ndarray, part: np.ndarray) -> np.ndarray:
        away = np.column_stack((column, row)) - spots[part, 0]
        places = corners[part, 0] + np.einsum("nk,nkc->nc", away, steps[part])
        inside = bodies.near(places[:, None])
        inside[inside] = bodies.hide(places[inside], normals[part[inside]])
        return inside

    for row, column, part in _texels(spots, size):
        met = hidden(row + 0.5, column + 0.5, part)
        shown[row[met], column[met]] = 0.0
        found.append((row, column, part))
    if shown.all():
        return None
    edge = grown(shown == 0.0, 1) & (shown > 0.0)
    row, column, part = (np.concatenate(each)[np.concatenate([edge[one[0], one[1]] for one in found])]
                         for each in zip(*found, strict=True))
    places = (np.arange(ALONG) + 0.5) / ALONG
    shown[row, column] = 1.0 - np.mean([hidden(row + up, column + along, part) for up in places for along in places],
                                       axis=0)
    return shown


def _steps(corners: np.ndarray, spots: np.ndarray) -> np.ndarray:
    """What a texel to the right, and one up, is in space on each triangle, (n, 2, 3)."""
    along, up = (spots[:, end] - spots[:, 0] for end in (1, 2))
    area = along[:, 0] * up[:, 1] - along[:, 1] * up[:, 0]
    back = np.stack((up[:, 1], -along[:, 1], -up[:, 0], along[:, 0]), axis=1)
    back *= np.where(area != 0.0, 1.0 / np.where(area != 0.0, area, 1.0), 0.0)[:, None]
    return np.matmul(back.reshape(-1, 2, 2), corners[:, 1:] - corners[:, :1])


def _texels(spots: np.ndarray, size: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Rows and columns (t,) of the texels whose middles lie in triangles with corners `spots` (n, 3, 2), and in which,
    some after some."""
    low = np.clip(np.floor(spots.min(axis=1)).astype(np.int64), 0, size)
    wide, high = (np.clip(np.ceil(spots.max(axis=1)).astype(np.int64), 0, size) - low).T
    for some in shares(wide * high, AT_ONCE):
        breathe()
        step, part = ranges(np.zeros(some.stop - some.start, dtype=np.int64), (wide * high)[some])
        part += some.start
        column, row = low[part, 0] + step % wide[part], low[part, 1] + step // wide[part]
        turns = []
        for start, end in ((0, 1), (1, 2), (2, 0)):
            side = spots[part, end] - spots[part, start]
            turns.append(side[:, 0] * (row + 0.5 - spots[part, start, 1])
                         - side[:, 1] * (column + 0.5 - spots[part, start, 0]))
        inside = (np.min(turns, axis=0) >= 0.0) | (np.max(turns, axis=0) <= 0.0)
        yield row[inside], column[inside], part[inside]
