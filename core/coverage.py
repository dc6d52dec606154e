"""Coverage: whether a triangle's polygons cover a place in the picture."""
from __future__ import annotations

from collections.abc import Generator

import numpy as np

from .cameras import Cameras
from .candidates import Candidates
from .clipping import Polygons
from .scene_frames import SceneFrames
from .unmatched_edges import following_corners
from .vectors import ranges, shares

PAIRS_AT_ONCE = 1 << 20
CELL, CELLS = 4.0, 4096  # pixels; cells across all that is told apart
MARGIN = 0.1  # pixels by which a polygon may end before the place that it covers


def touching(cameras: Cameras, camera: np.ndarray) -> np.ndarray:
    """(n,) bool, which cameras share a corner with one of `camera`."""
    corner = np.zeros(cameras.places.shape[1], dtype=bool)
    corner[cameras.corners[camera]] = True
    return corner[cameras.corners].any(axis=1)


def covered(cameras: Cameras, frames: SceneFrames, candidates: Candidates, polygons: Polygons,
            corner_pixels: np.ndarray, camera: np.ndarray, column: np.ndarray, pixel: np.ndarray) -> np.ndarray:
    """Whether a polygon of triangle `column` (n,), in `camera` (n,) or one that touches it, covers `pixel` (n, 2);
    never where the column is -1.

    Parameters
    ----------
    corner_pixels : (k, 2) float64
        Picture positions of the polygons' corners.
    """
    inside = np.zeros(len(camera), dtype=bool)
    wanted = np.zeros(len(frames.triangle), dtype=bool)
    wanted[column[column >= 0]] = True
    of_camera, of_column = candidates.camera[polygons.pair], candidates.column[polygons.pair]
    chosen = np.flatnonzero(touching(cameras, camera)[of_camera] & wanted[of_column])
    pairs = np.zeros(0, dtype=np.int64)
    if len(chosen):
        low, high = (bound.reduceat(corner_pixels, polygons.start[:-1], axis=0)[chosen] + room
                     for bound, room in ((np.minimum, -MARGIN), (np.maximum, MARGIN)))
        shown = cameras.corners[of_camera[chosen]] * len(wanted) + of_column[chosen][:, None]
        asked = np.flatnonzero(column >= 0)
        wished = cameras.corners[camera[asked]] * len(wanted) + column[asked][:, None]
        for own, place in _in_one_cell(shown, low, high, wished, pixel[asked]):
            near = ((pixel[asked[place]] >= low[own]) & (pixel[asked[place]] <= high[own])).all(axis=1)
            pairs = np.union1d(pairs, asked[place[near]] * len(polygons.pair) + chosen[own[near]])
    place, polygon = pairs // max(len(polygons.pair), 1), pairs % max(len(polygons.pair), 1)
    size = np.diff(polygons.start)[polygon]
    corner, run = ranges(polygons.start[polygon], size)
    if not len(run):
        return inside
    a, b, at = corner_pixels[corner], corner_pixels[following_corners(polygons)[corner]], pixel[place[run]]
    way, offset = b - a, at - a
    square = (way**2).sum(axis=1)
    share = np.clip((offset * way).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away = np.linalg.norm(offset - share[:, None] * way, axis=1)
    # moved onto the true map, polygons need not be convex: count the edges that a line to the right crosses
    above = a[:, 1] > at[:, 1]
    left = (way[:, 0] * offset[:, 1] - way[:, 1] * offset[:, 0]) * np.where(above, -1.0, 1.0) > 0.0
    crossed = (above != (b[:, 1] > at[:, 1])) & left
    begin = np.cumsum(size) - size
    within = np.add.reduceat(crossed.astype(np.int64), begin) % 2 == 1
    within |= np.minimum.reduceat(away, begin) <= MARGIN
    inside[place[within]] = True
    return inside


def _in_one_cell(shown: np.ndarray, low: np.ndarray, high: np.ndarray, wished: np.ndarray,
                 pixel: np.ndarray) -> Generator[tuple[np.ndarray, np.ndarray], None, None]:
    """Pairs of a box, from `low` to `high` (n, 2), and a place `pixel` (m, 2) with a name in common among the three
    that each has, `shown` (n, 3) and `wished` (m, 3); some of them twice, in shares that fit the memory.

    Thousands of small boxes may have one name: they and the places are told apart by cells of the picture.
    """
    first, last = _cells(low), _cells(high)
    small = (last - first <= 1).all(axis=1)
    names = np.unique(shown)
    # a large box has a cell of its own, of which every place asks as well
    large, number = CELLS * CELLS, np.arange(len(shown))
    parts = [(number[~small], np.full(np.count_nonzero(~small), large))]
    for dx, dy in ((0, 0), (0, 1), (1, 0), (1, 1)):
        other = number[small & (first + (dx, dy) <= last).all(axis=1)]
        parts.append((other, (first[other, 0] + dx) * CELLS + first[other, 1] + dy))
    box, cell = (np.concatenate(part) for part in zip(*parts))
    key = (np.searchsorted(names, shown[box]) * (large + 1) + cell[:, None]).ravel()
    order = np.argsort(key, kind="stable")
    key, box = key[order], box[order // 3]
    place, wish = np.repeat(np.arange(len(wished)), 3), np.searchsorted(names, wished.ravel())
    known = names[np.minimum(wish, len(names) - 1)] == wished.ravel()
    place, wish = place[known], wish[known]
    spot = _cells(pixel[place])
    for cell in (large, spot[:, 0] * CELLS + spot[:, 1]):
        start, stop = (np.searchsorted(key, wish * (large + 1) + cell, side=side) for side in ("left", "right"))
        for part in shares(stop - start, PAIRS_AT_ONCE):
            entry, row = ranges(start[part], (stop - start)[part])
            yield box[entry], place[part][row]


def _cells(pixel: np.ndarray) -> np.ndarray:
    """Cells (n, 2) of the picture, the outermost without an end."""
    return np.clip(np.nan_to_num(pixel) // CELL + CELLS // 2, 0, CELLS - 1).astype(np.int64)
