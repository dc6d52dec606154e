"""Filling: cameras that are not cut are shown by rays, the talk's holes.

Two kinds are not: those in which more lies over one another than the picture can show or the memory holds, and those
of a pixel in which outlines are bent still, as where rays cross on a caustic. They are divided into cells of about a
pixel, and each cell shows the one triangle that the ray through its middle meets first. Cells that lie together in a
part of a pixel share one ray, so that the work is bounded by the picture however many there are.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from .camera_splitting import edge_middles, in_picture, split_at
from .cameras import Cameras
from .candidates import Candidates
from .limits import Limits, crowded, picture_areas
from .met_surfaces import MetSurfaces
from .reflection_map import ReflectionMap
from .scene_frames import SceneFrames
from .stepping import breathe
from .subdivision import shared_edges
from .vectors import groups
from .view import View

HIDING = 1.0 / 4.0  # of the work for a candidate: that of asking whether a mirror hides it
OVERLAPPING = 24  # of the mirrors in a camera: more hardly lie over one and the same polygon
LEVELS = 16
CELL = 1.0  # pixels: the longest edge of a cell, where the number of rays allows it
SHARED = 0.5  # of a cell's longest edge: cells whose middles lie in one square of that size share a ray


def thinned(view: View, cameras: Cameras, candidates: Candidates, mirror: np.ndarray, crowd: np.ndarray,
            limits: Limits) -> tuple[Cameras, Candidates, np.ndarray]:
    """Cameras and their candidates within the limits; and which cameras (n,) are too crowded for that, those that
    `crowd` (n,) names among them. `mirror` (p,) tells which candidates are mirrors: of these each may hide a part of
    all others in its camera."""
    count, hiding = (np.bincount(candidates.camera, weights, len(cameras)) for weights in (None, mirror))
    load, worth = count * (1.0 + HIDING * np.minimum(hiding, OVERLAPPING)), picture_areas(view, cameras)
    crowd = crowd | crowded(count, worth, limits.candidates) | crowded(load, worth, limits.work)
    if not crowd.any():
        return cameras, candidates, crowd
    candidates = candidates.select(np.flatnonzero(~crowd[candidates.camera]))
    candidates = replace(candidates, camera=(np.cumsum(~crowd) - 1)[candidates.camera])
    return cameras.select(~crowd), candidates, crowd


def with_crowds(view: View, mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames, candidates: Candidates,
                crowds: list[Cameras], met: MetSurfaces,
                most: int) -> tuple[Cameras, SceneFrames, Candidates, int, int]:
    """The cameras and behind them the cells of those that are too crowded, each with the one triangle that it shows as
    its candidate; how many cells there are, and how many rays were traced."""
    # all lie on corners that the cameras have too: whoever splits cameras adds corners behind those there are
    corners, face = (np.concatenate([getattr(crowd, name) for crowd in crowds]) for name in ("corners", "face"))
    crowd = Cameras(corners, face, cameras.places, cameras.rays, cameras.origins)
    cells, triangle, rays = _cells_and_triangles(view, mirror_map, crowd, met, most)
    seen = np.union1d(frames.triangle, triangle)
    column = np.searchsorted(seen, frames.triangle)
    pairs = Candidates.unknown(np.arange(len(cells)) + len(cameras), np.searchsorted(seen, triangle))
    candidates = Candidates.joined((replace(candidates, column=column[candidates.column]), pairs))
    whole = Cameras(np.concatenate((cameras.corners, cells.corners)), np.concatenate((cameras.face, cells.face)),
                    cells.places, cells.rays, cells.origins)
    return whole, SceneFrames.of(met, seen), candidates, len(cells), rays


def _cells_and_triangles(view: View, mirror_map: ReflectionMap, cameras: Cameras, met: MetSurfaces,
                         most: int) -> tuple[Cameras, np.ndarray, int]:
    """Cells of crowded cameras that show something, the triangle (m,) that each shows, and how many rays, about `most`
    at most, were traced for it."""
    # no more rays than `most` by the area, and no more cells by the cameras' lengths
    corners = np.clip(np.nan_to_num(view.pixels(cameras.places.T)), 0.0, view.resolution)[cameras.corners]
    length = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1).sum()
    longest = max(CELL, np.sqrt(2.0 * picture_areas(view, cameras).sum() / most) / SHARED, 2.0 * length / most)
    cells = _cells(view, mirror_map, cameras, longest)
    middle = view.pixels(cells.places[:, cells.corners].mean(axis=2).T)
    square = np.floor(middle / (SHARED * longest)).astype(np.int64)
    square -= square.min(axis=0, initial=0)
    first, group = groups(cells.face, *square.T)
    if len(first) > most:
        first, group = groups(*square.T)
    triangle = met.shown_in_middles(mirror_map, cells.select(first))[group]
    shown = np.flatnonzero(triangle >= 0)
    return cells.select(shown), triangle[shown], len(first)


def _cells(view: View, mirror_map: ReflectionMap, cameras: Cameras, longest: float) -> Cameras:
    """The parts of the cameras in the picture, without an edge longer than `longest` pixels."""
    for _ in range(LEVELS):
        breathe()
        cameras = cameras.select(in_picture(view, cameras))
        pixels = view.pixels(cameras.places.T)[cameras.corners]
        long = np.linalg.norm(pixels - np.roll(pixels, -1, axis=1), axis=2) > longest
        if not long.any():
            break
        ends, first, edge = shared_edges(cameras.corners)
        marked = np.zeros(len(ends), dtype=bool)
        marked[edge[long]] = True
        cameras, _ = split_at(cameras, marked, edge, *edge_middles(mirror_map, cameras, ends, first))
    return cameras
