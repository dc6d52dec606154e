"""Refinement of the cameras in which the straight outline of a triangle would miss the true, quadratic one.

What the quadratic part adds to a triangle's side halfway along a camera's edge, over the side's rise per pixel, tells
how many pixels the straight outline misses there. Tall cameras that see a triangle edge on ask for it, and those in
which the rays cross before the triangle; all others keep their size.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import beyond_horizon, split_cameras
from ..culling import Candidates, SceneAndMirrors, overlapping
from ..geometry import doubled_areas, edge_lengths, ranges
from ..support import breathe
from .clipping import clip
from .convex_polygons import Line, scene_edges

LEVELS = 10
SHORTEST_EDGE = 1.0  # pixels: a shorter edge of a camera is not split
CROWD = 6  # outlines of mirrors that a camera may hold: all that it sees is cut along each


def refine_for_outlines(candidates: Candidates, tolerance: float, maximum: int,
                        met: SceneAndMirrors) -> tuple[Candidates, np.ndarray, int]:
    """Candidates of cameras split until no outline in them misses the true one by more than `tolerance` pixels, or
    until there are `maximum` candidates.

    Returns
    -------
    candidates : Candidates
        The pairs that may really overlap.
    open_ : (n,) bool
        Cameras too small to be split in which some outline still does.
    limited : int
        Edges of cameras that the bound on depth or count left unsplit.
    """
    cameras, frames = candidates.cameras, candidates.frames
    settled, open_ = candidates.select(np.zeros(0, dtype=np.int64)), np.zeros(len(cameras), dtype=bool)
    for level in range(LEVELS + 1):
        breathe()
        candidates, lines = _really_overlapping(candidates)
        lines &= ~met.inner_sides(candidates)
        bent, long = _bent_edges(candidates, lines, tolerance)
        bent &= ~beyond_horizon(cameras)[:, None]
        crowded = _crowded(candidates, lines & met.are_mirrors(candidates))
        split = (bent | crowded[:, None]) & long
        settled = Candidates.joined((settled, candidates))
        if level == LEVELS or not split.any() or len(settled) > maximum:
            break
        open_ |= (bent & ~long).any(axis=1)
        before = len(cameras)
        cameras, parent, new = split_cameras(cameras, split)
        now = np.full(before, -1)
        now[parent[~new]] = np.flatnonzero(~new)
        open_ = open_[parent] & ~new
        candidates = overlapping(cameras, frames, *_children(settled, parent, new, before, len(frames.triangle)))
        settled = settled.on(cameras, now)
    return settled, open_ | (bent.any(axis=1) & ~long.any(axis=1)), int((bent & long).sum())


def _children(candidates: Candidates, parent: np.ndarray, new: np.ndarray, before: int,
              columns: int) -> tuple[np.ndarray, np.ndarray]:
    """Pairs of the new cameras with the candidates of their parents, each once: a camera across a triangle's plane
    stands twice among the candidates."""
    order = np.argsort(candidates.camera, kind="stable")
    start = np.searchsorted(candidates.camera[order], np.arange(before + 1))
    child = np.flatnonzero(new)
    entry, run = ranges(start[parent[child]], start[parent[child] + 1] - start[parent[child]])
    pairs = np.unique(child[run] * columns + candidates.column[order][entry])
    return pairs // columns, pairs % columns


def _really_overlapping(candidates: Candidates) -> tuple[Candidates, np.ndarray]:
    """Candidates that overlap when each side moves out by all that its quadratic part may add; and (3, p), which of the
    triangle's sides then still bound the overlap."""
    wide = replace(candidates, sides=candidates.sides + candidates.room[:, None])
    polygons = clip(wide)
    scene = scene_edges(polygons.after)
    lines = np.zeros((3, len(polygons)), dtype=bool)
    lines[polygons.after[scene] - Line.SCENE_EDGE, polygons.polygon[scene]] = True
    return candidates.select(polygons.pair), lines


def _crowded(candidates: Candidates, outlines: np.ndarray) -> np.ndarray:
    """Which cameras (n,) hold too many `outlines` (3, p) of mirrors."""
    return np.bincount(candidates.camera, outlines.sum(axis=0), minlength=len(candidates.cameras)) > CROWD


def _bent_edges(candidates: Candidates, lines: np.ndarray, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
    """Edges (n, 3) of the cameras, from each corner to the next, along which some outline misses too much; and those
    that are long enough to be split."""
    cameras = candidates.cameras
    view = cameras.view
    pixels = view.pixels(cameras.places.T)[cameras.corners]
    across, up = pixels[:, 1] - pixels[:, 0], pixels[:, 2] - pixels[:, 0]
    area = np.abs(doubled_areas(pixels))
    camera = candidates.camera
    rise, climb = candidates.sides[:, 1] - candidates.sides[:, 0], candidates.sides[:, 2] - candidates.sides[:, 0]
    steepness = np.hypot(rise * up[camera, 1] - climb * across[camera, 1],
                         climb * across[camera, 0] - rise * up[camera, 0])
    misses = (np.abs(candidates.bend) * area[camera] > tolerance * steepness[:, None]) & lines[:, None]
    edge, pair = np.nonzero(misses.any(axis=0))
    bent = np.zeros((len(cameras), 3), dtype=bool)
    bent[camera[pair], edge] = True
    return bent, edge_lengths(pixels) > SHORTEST_EDGE
