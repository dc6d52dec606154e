"""Filling: cameras whose outlines no straight line can give are filled by one ray each.

Where rays cross, on a caustic or on a triangle seen exactly edge on, outlines stay bent however small a camera gets.
Refinement stops at cameras of a pixel; what clipping would leave of them is found open, one ray through the middle of
each says which triangle is seen, and the whole camera shows that triangle, on corners that it shares with its
neighbours.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .candidates import Candidates
from .clipping import Polygons
from .reflection_map import ReflectionMap
from .scene_frames import SceneFrames


def fill(mirror_map: ReflectionMap, cameras: Cameras, frames: SceneFrames, candidates: Candidates, polygons: Polygons,
         open_: np.ndarray) -> tuple[Polygons, int]:
    """Polygons in which each open camera shows the one triangle that the ray through its middle meets first.

    Parameters
    ----------
    open_ : (n,) bool
        Cameras to fill.

    Returns
    -------
    polygons : Polygons
    rays : int
        How many rays were traced.
    """
    pairs = np.flatnonzero(open_[candidates.camera])
    if not len(pairs):
        return polygons, 0
    camera, column = candidates.camera[pairs], candidates.column[pairs]
    face = cameras.face[camera]
    middle = np.take(cameras.places, cameras.corners[camera].T, axis=1).mean(axis=1)
    origin, ray = mirror_map.leave(face, mirror_map.coordinates(face, middle))
    distance = frames.distance(column, origin, ray)
    hit = (frames.weights(column, origin + distance * ray) >= 0.0).all(axis=0) & (distance > 0.0)
    order = np.lexsort((distance[hit], camera[hit]))
    _, first = np.unique(camera[hit][order], return_index=True)
    shown = pairs[hit][order[first]]

    size = np.diff(polygons.start)
    kept = ~open_[candidates.camera[polygons.pair]]
    corner = np.repeat(kept, size)
    whole = np.array([2, 0, 1], dtype=np.int8)
    size = np.concatenate((size[kept], np.full(len(shown), 3)))
    return Polygons(
        np.concatenate((polygons.pair[kept], shown)), np.append(0, np.cumsum(size)),
        np.concatenate((polygons.weights[:, corner], np.tile(np.eye(3), (1, len(shown)))), axis=1),
        np.concatenate((polygons.before[corner], np.tile(np.roll(whole, 1), len(shown)))),
        np.concatenate((polygons.after[corner], np.tile(whole, len(shown))))), len(np.unique(camera))
