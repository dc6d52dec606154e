"""Refinement of the cameras in which the straight outline of a triangle would miss the true, quadratic one.

The deviation in pixels is the contribution of the quadratic part to a triangle's side halfway along a camera's edge,
divided by the side's gradient per pixel. It is large in tall cameras that see a triangle edge on, and in cameras whose
rays cross before the triangle; all others keep their size.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import Cameras, beyond_horizon, split_cameras
from ..culling import Candidates, SceneAndMirrors, inherited
from ..geometry import columns, distinct, doubled_areas, edge_lengths, mask
from ..support import ENDING_SHARE
from .covering import Overlaps

LEVELS = 10
SHORTEST_EDGE = 1.0  # pixels: a shorter edge of a camera is not split
CROWD = 24  # outlines of mirrors in a camera, at most: everything that it sees is cut along them


def refine_for_outlines(candidates: Candidates, tolerance: float, maximum: int, met: SceneAndMirrors,
                        last: bool) -> tuple[Candidates, np.ndarray, int]:
    """Split cameras until no straight outline in them misses the true one by more than `tolerance` pixels.

    Splitting stops at about `maximum` candidates. At the `last` bounce mirror triangles only hide others.

    Returns
    -------
    candidates : Candidates, the pairs that may really overlap, and that no mirror hides from the whole of their camera
    open_ : (n,) bool, True for cameras too small to be split in which some outline still misses by more
    limited : int, edges of cameras that the bound on depth or count left unsplit
    """
    cameras, frames = candidates.cameras, candidates.frames
    parts, open_ = [], np.zeros(len(cameras), dtype=bool)
    camera, column = np.zeros((2, 0), dtype=np.int64)
    for level in range(LEVELS + 1):
        parts.append(candidates)
        # current camera index of every pair so far, -1 if that camera has been split
        camera, column = np.append(camera, candidates.camera), np.append(column, candidates.column)
        mirror = met.are_mirrors(candidates)
        bent, long = _bent_edges(candidates, tolerance * np.where(mirror, ENDING_SHARE, 1.0))
        split = (bent | _crowded(candidates, mirror)[:, None]) & long
        if level == LEVELS or not split.any() or (camera >= 0).sum() > maximum:
            break
        open_ |= (bent & ~long).any(axis=1)
        before = len(cameras)
        cameras, parent, new = split_cameras(cameras, split)
        now = np.full(before, -1)
        now[parent[~new]] = np.flatnonzero(~new)
        open_ = open_[parent] & ~new
        child = np.flatnonzero(new)
        own = np.flatnonzero((camera >= 0) & mask(before, parent[child])[camera])
        pairs = inherited(camera[own], column[own], parent[child], child)
        candidates = Overlaps.of(cameras, frames, pairs, met).in_sight(last)
        camera = np.where(camera >= 0, now[camera], -1)
    settled = replace(Candidates.joined(parts), cameras=cameras, camera=camera).select(np.flatnonzero(camera >= 0))
    return settled, open_ | (bent.any(axis=1) & ~long.any(axis=1)), int((bent & long).sum())


def _crowded(candidates: Candidates, mirror: np.ndarray) -> np.ndarray:
    """Return True for cameras (n,) with too many outlines of mirrors; `mirror` (p,) is True for mirror candidates."""
    outlines = np.where(mirror, candidates.outlines.sum(axis=0), 0)
    return np.bincount(candidates.camera, outlines, minlength=len(candidates.cameras)) > CROWD


def _bent_edges(candidates: Candidates, tolerance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Find edges of the cameras, from each corner to the next, along which a straight outline misses the true one.

    Parameters
    ----------
    tolerance : (p,) float64, pixels, of each candidate

    Returns
    -------
    bent : (n, 3) bool, True where some outline misses by more than its tolerance
    long : (n, 3) bool, True for edges of those cameras that are long enough to be split
    """
    cameras, some = candidates.cameras, np.flatnonzero(candidates.outlines.any(axis=0))
    asked, camera = distinct(candidates.camera[some])
    pixels = cameras.view.pixels(cameras.places[:, cameras.corners[asked].ravel()].T).reshape(-1, 3, 2)
    across, up = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    area, sides = np.abs(doubled_areas(pixels)), columns(candidates.sides, some)
    rise, climb = sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0]
    steepness = np.hypot(rise * up[camera, 1] - climb * across[camera, 1],
                         climb * across[camera, 0] - rise * up[camera, 0])
    misses = np.abs(columns(candidates.bend, some)) * area[camera] > tolerance[some] * steepness[:, None]
    edge, pair = np.nonzero((misses & columns(candidates.outlines, some)[:, None]).any(axis=0))
    bent, long = (np.zeros((len(cameras), 3), dtype=bool) for _ in range(2))
    bent[asked[camera[pair]], edge] = True
    long[asked] = edge_lengths(pixels) > SHORTEST_EDGE
    return bent & _worth_refining(cameras, bent), long


def _worth_refining(cameras: Cameras, bent: np.ndarray) -> np.ndarray:
    """Return True (n, 1) for cameras with `bent` (n, 3) edges that are no slivers beyond the horizon."""
    asked = bent.any(axis=1)
    worth = asked.copy()
    worth[asked] = ~beyond_horizon(cameras.select(asked))
    return worth[:, None]
