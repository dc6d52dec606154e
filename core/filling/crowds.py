"""Filling: cameras that are not cut are shown by rays, the talk's holes.

Two kinds are not: those in which more lies over one another than the picture can show or the memory holds, and those
of a pixel in which outlines are bent still, as where rays cross on a caustic. They are cut along squares of less than a
pixel, and in each of them a face of the mirror shows the one triangle that the ray through the middle of its first cell
meets first. So the work is bounded by the picture: where too many lie in a square, all of them share one ray.
"""
from __future__ import annotations

from dataclasses import replace

import numpy as np

from ..cameras import Cameras, ReflectionMap, picture_areas, pixels_of, with_pieces
from ..culling import Candidates, SceneAndMirrors
from ..geometry import SceneFrames, View, edge_lengths, groups
from ..support import crowded
from .limits import Limits
from .picture_squares import in_squares

HIDING = 1.0 / 4.0  # of the work for a candidate: that of asking whether a mirror hides it
OVERLAPPING = 24  # of the mirrors in a camera: more hardly lie over one and the same polygon
SQUARE = 0.5  # pixels: the side of the squares in which cameras are shown, where the number of rays allows it
CROSSED = 2.0 / np.pi  # half as many lines of a square grid as a line of any direction crosses in its side's length
SMALLEST = 1e-9  # square pixels: smaller cells are nothing


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
                crowds: list[Cameras], met: SceneAndMirrors,
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


def _cells_and_triangles(view: View, mirror_map: ReflectionMap, cameras: Cameras, met: SceneAndMirrors,
                         most: int) -> tuple[Cameras, np.ndarray, int]:
    """Cells of crowded cameras that show something, the triangle (m,) that each shows, and how many rays, about `most`
    at most, were traced for it."""
    # a camera lies in about as many squares as its area holds, its edges cross more, and one
    area, crossed = pixels_of(view, cameras).sum(), CROSSED * _lengths(view, cameras).sum()
    room = max(most - len(cameras), most / 2)
    size = max(SQUARE, 2.0 * area / max(np.sqrt(crossed**2 + 4.0 * area * room) - crossed, 1e-300))
    cells, square = _cells(view, mirror_map, cameras, size)
    first, group = groups(cells.face, *square)
    if len(first) > most:
        first, group = groups(*square)
    triangle = met.shown_in_middles(mirror_map, cells.select(first))[group]
    shown = np.flatnonzero(triangle >= 0)
    return cells.select(shown), triangle[shown], len(first)


def _lengths(view: View, cameras: Cameras) -> np.ndarray:
    """The lengths (n,) of the way round cameras, about as far as it lies in the picture."""
    corners = np.clip(np.nan_to_num(view.pixels(cameras.places.T)), 0.0, view.resolution)[cameras.corners]
    return edge_lengths(corners).sum(axis=1)


def _cells(view: View, mirror_map: ReflectionMap, cameras: Cameras, size: float) -> tuple[Cameras, np.ndarray]:
    """The parts of the cameras in squares of `size` pixels of the picture, and which square (2, n) each lies in."""
    parts, camera = in_squares(view, cameras, size)
    polygon, weights = parts.triangles(len(camera), 0.0)
    cells, _ = with_pieces(mirror_map, cameras, np.zeros(len(cameras), dtype=bool), camera[polygon], weights)
    cells = cells.select(pixels_of(view, cells) > SMALLEST)
    middle = view.pixels(cells.places[:, cells.corners].mean(axis=2).T)
    return cells, np.floor(middle.T / size).astype(np.int64)
