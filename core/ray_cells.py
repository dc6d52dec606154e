"""Cells: what clipping cannot cover is shown in cells of less than a pixel, each with the triangle that its rays meet.

The cameras beside openings are halved, on shared corners, until their parts are cells; parts that lie far from every
opening are dropped on the way. A ray through each corner and each middle tells what should be seen there. A cell stays
where one of these triangles is missing and shows it, so that the cells end only where polygons go on: no crack is
left between them, and where they overlap, the order of paths decides as everywhere.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .backward_rays import first_hits
from .camera_splitting import edge_middles, in_picture, split_at
from .cameras import Cameras
from .candidates import Candidates
from .clipping import Polygons
from .coverage import covered
from .mirror_map import MirrorMap
from .openings import Openings
from .scene_frames import SceneFrames
from .scene_tree import SceneTree
from .subdivision import shared_edges
from .vectors import ranges
from .view import View

LEVELS = 16
LONGEST_EDGE = 1.0  # pixels, of a cell
REACHES = 16.0, 8.0, 4.0, 2.0  # pixels round an opening within which cells are made: the first that is not too many
MOST_CELLS = 200_000


@dataclass(frozen=True)
class Cells:
    """Cells (m).

    Attributes
    ----------
    cells : Cameras
    camera : (m,) int64, the camera that each lies in
    column : (m,) int64, the triangle in the frames that it shows
    rays : int, how many were traced
    rim : Openings, where the cells reach as far from the openings as they may, and more may be open
    large : bool, whether the bound on depth or count left cells larger than they should be
    """

    cells: Cameras
    camera: np.ndarray
    column: np.ndarray
    rays: int
    rim: Openings
    large: bool


def ray_cells(view: View, mirror_map: MirrorMap, cameras: Cameras, tree: SceneTree, frames: SceneFrames,
              candidates: Candidates, polygons: Polygons, corner_pixels: np.ndarray, openings: Openings) -> Cells:
    """Cells round the openings that show what no polygon does; `corner_pixels` (k, 2) of the polygons' corners."""
    cells, camera, last, large = _small_cells(view, mirror_map, cameras, openings)
    used, corner = np.unique(cells.corners, return_inverse=True)
    corner = corner.reshape(-1, 3)
    owner = np.empty(len(used), dtype=np.int64)
    owner[corner.ravel()] = np.repeat(camera, 3)
    middle = cells.places[:, cells.corners].mean(axis=2)
    places = np.concatenate((cells.places[:, used], middle), axis=1)
    middle_rays = mirror_map.rays(cells.face, mirror_map.coordinates(cells.face, middle))
    column = first_hits(tree, frames, places, np.concatenate((cells.rays[:, used], middle_rays), axis=1))
    pixel = view.pixels(places.T)
    missing = (column >= 0) & ~covered(cameras, frames, candidates, polygons, corner_pixels,
                                       np.concatenate((owner, camera)), column, pixel)
    # the middle first, then the corners
    probe = np.concatenate((len(used) + np.arange(len(cells))[:, None], corner), axis=1)
    kept = np.flatnonzero(missing[probe].any(axis=1))
    first = np.argmax(missing[probe[kept]], axis=1)
    shown, last = column[probe[kept, first]], last[kept]
    rim = Openings(camera[kept][last], pixel[len(used):][kept][last], shown[last], 0, 0)
    return Cells(cells.select(kept), camera[kept], shown, len(column), rim, large)


def _small_cells(view: View, mirror_map: MirrorMap, cameras: Cameras,
                 openings: Openings) -> tuple[Cameras, np.ndarray, np.ndarray, bool]:
    """The parts of the open cameras near openings; the camera of each; whether it is among the last ones within reach;
    and whether a bound left them too large."""
    # openings close together stand for one another
    spot = np.floor(openings.pixel / REACHES[-1]).astype(np.int64)
    _, once = np.unique(np.stack((openings.camera, *spot.T)), axis=1, return_index=True)
    opening_camera, opening_pixel = openings.camera[once], openings.pixel[once]  # sorted by camera
    camera, count = np.unique(opening_camera, return_counts=True)
    cells = cameras.select(camera)
    reach = _reach(view.pixels(cells.places.T)[cells.corners], count)
    for level in range(LEVELS + 1):
        pixels = view.pixels(cells.places.T)[cells.corners]
        middle = pixels.mean(axis=1)
        radius = np.linalg.norm(pixels - middle[:, None], axis=2).max(axis=1)
        start, stop = (np.searchsorted(opening_camera, camera, side=side) for side in ("left", "right"))
        opening, cell = ranges(start, stop - start)
        away = np.full(len(cells), np.inf)
        np.minimum.at(away, cell, np.linalg.norm(opening_pixel[opening] - middle[cell], axis=1))
        near = (away <= radius + reach) & in_picture(view, cells)
        cells, camera, pixels = cells.select(near), camera[near], pixels[near]
        long = np.linalg.norm(pixels - np.roll(pixels, -1, axis=1), axis=2) > LONGEST_EDGE
        if not long.any() or level == LEVELS or len(cells) > MOST_CELLS:
            break
        ends, first, edge = shared_edges(cells.corners)
        marked = np.zeros(len(ends), dtype=bool)
        marked[edge[long]] = True
        cells, parent = split_at(cells, marked, edge, *edge_middles(mirror_map, cells, ends, first))
        camera = camera[parent]
    return cells, camera, away[near] > reach - radius[near], bool(long.any())


def _reach(corners: np.ndarray, openings: np.ndarray) -> float:
    """The first of `REACHES` that makes no more than about `MOST_CELLS` in cameras with corners (n, 3, 2) in the
    picture and so many openings (n,) each."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    area = 0.5 * np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    for reach in REACHES:
        if np.minimum(area, 4.0 * openings * reach**2).sum() < 0.125 * LONGEST_EDGE**2 * MOST_CELLS:
            break
    return reach
