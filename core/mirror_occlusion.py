"""What mirrors hide in a mirror: its own body and that of others, cut away exactly.

Of the triangles of mirrors that a camera sees, only outlines bound what they hide: sides over which no mirror goes on,
or over which it folds back. All polygons of the camera are cut along these lines, and every piece is then hidden
as a whole, or not at all. Where something passes through a mirror, the line of their contact cuts it too.
"""
from __future__ import annotations

import numpy as np

from .cameras import Cameras
from .candidates import Candidates
from .clipping import CONTACT, HIDDEN, SCENE_EDGE, Polygons, clip
from .met_surfaces import MetSurfaces
from .scene_frames import SceneFrames
from .vectors import groups, ranges

LINES = 16  # outlines that cut one camera; with more, what is left of a polygon is hidden or not by its middle
NEARER = 1e-9  # of the distance: what is nearer by less is the same surface
INWARD = 0.05  # how far from its corners towards its middle a polygon is asked


def cut_behind_mirrors(cameras: Cameras, frames: SceneFrames, met: MetSurfaces, candidates: Candidates,
                       polygons: Polygons) -> tuple[Polygons, int]:
    """The polygons without what mirrors hide from the cameras, and how many were hidden or cut."""
    mirror = np.flatnonzero(met.shows_mirror(frames)[candidates.column])
    if not len(mirror):
        return polygons, 0
    touched = np.zeros(len(cameras), dtype=bool)
    touched[candidates.camera[mirror]] = True
    asked = touched[candidates.camera[polygons.pair]]
    if not asked.any():
        return polygons, 0
    pieces = _along_outlines(cameras, frames, met, candidates, mirror, polygons.select(asked))
    pieces, hidden = _before_mirrors(candidates, mirror, pieces)
    return Polygons.joined((polygons.select(~asked), pieces)), hidden


def _along_outlines(cameras: Cameras, frames: SceneFrames, met: MetSurfaces, candidates: Candidates,
                    mirror: np.ndarray, polygons: Polygons) -> Polygons:
    """The polygons in pieces, cut along the outlines of the mirrors in their cameras."""
    lines = _outlines(cameras, frames, met, candidates, mirror)
    first = np.searchsorted(lines[0], np.arange(len(cameras) + 1))
    count = np.diff(first)[candidates.camera[polygons.pair]]
    for number in range(min(LINES, int(count.max(initial=0)))):
        crossed = count > number
        values = np.take(lines[1], first[candidates.camera[polygons.pair[crossed]]] + number, axis=1)
        sides = [polygons.select(crossed).cut(sign * values, HIDDEN) for sign in (1.0, -1.0)]
        polygons = Polygons.joined((polygons.select(~crossed), *sides))
        count = np.diff(first)[candidates.camera[polygons.pair]]
    return polygons


def _outlines(cameras: Cameras, frames: SceneFrames, met: MetSurfaces, candidates: Candidates,
              mirror: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Outlines of the mirrors, sorted by camera: the camera (k,), and the values (3, k) at its corners of a function
    that is zero on the line."""
    seen = candidates.select(mirror)
    polygons = clip(seen)
    bounding = np.zeros((3, len(seen)), dtype=bool)
    corner = np.flatnonzero((polygons.after >= SCENE_EDGE) & (polygons.after < CONTACT))
    side = polygons.after[corner] - SCENE_EDGE
    polygon = np.repeat(np.arange(len(polygons.pair)), np.diff(polygons.start))[corner]
    bounding[side, polygons.pair[polygon]] = True
    bounding &= ~met.inner_sides(cameras, frames, seen)
    side, pair = np.nonzero(bounding)
    vertices = frames.vertices[:, seen.column[pair]]
    row = np.arange(len(pair))
    ends = np.sort(np.stack((vertices[(side + 1) % 3, row], vertices[(side + 2) % 3, row])), axis=0)
    once, _ = groups(seen.camera[pair], *ends)
    side, pair = side[once], pair[once]
    return seen.camera[pair], seen.sides[side, :, pair].T


def _before_mirrors(candidates: Candidates, mirror: np.ndarray, polygons: Polygons) -> tuple[Polygons, int]:
    """The polygons that no mirror hides; those that pass through one are cut in the line of contact."""
    order = mirror[np.argsort(candidates.camera[mirror], kind="stable")]
    camera = candidates.camera[polygons.pair]
    start = np.searchsorted(candidates.camera[order], camera)
    stop = np.searchsorted(candidates.camera[order], camera, side="right")
    entry, polygon = ranges(start, stop - start)
    other, own = order[entry], polygons.pair[polygon]

    size = np.diff(polygons.start)
    middle = np.add.reduceat(polygons.weights, polygons.start[:-1], axis=1) / size
    hider, some, every = (np.full(len(polygons.pair), value) for value in (-1, False, True))
    for corner in range(-1, int(size.max(initial=0))):
        at = middle if corner < 0 else (
            (1.0 - INWARD) * polygons.weights[:, polygons.start[:-1] + np.minimum(corner, size - 1)] + INWARD * middle)
        inside, nearer = _ahead_of(candidates, other, own, at[:, polygon])
        hidden = np.zeros(len(polygons.pair), dtype=bool)
        hidden[polygon[inside & nearer]] = True
        hider[polygon[inside & nearer]] = other[inside & nearer]
        some |= hidden
        every &= hidden
    passing = np.flatnonzero(some & ~every)
    kept = polygons.select(~some)
    if len(passing):
        part = polygons.select(passing)
        kept = Polygons.joined((kept, part.cut(_depth_order(candidates, hider[passing], part.pair), HIDDEN)))
    return kept, int(some.sum())


def _ahead_of(candidates: Candidates, other: np.ndarray, own: np.ndarray,
              weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Whether rays at `weights` (3, n) of the cameras meet the mirror triangles of the candidates `other` (n,), and
    whether they do before they meet the planes of the candidates `own`."""
    sides = (candidates.sides[:, :, other] * weights).sum(axis=1)
    reach, own_reach = (((candidates.ahead[:, pair] * weights).sum(axis=0)) for pair in (other, own))
    rate, own_rate = (((candidates.sides[:, :, pair].sum(axis=0)) * weights).sum(axis=0) for pair in (other, own))
    nearer = reach * own_rate * (1.0 + NEARER) < own_reach * rate * (1.0 - NEARER)
    return (sides >= 0.0).all(axis=0) & (reach >= 0.0), nearer & (other != own)


def _depth_order(candidates: Candidates, other: np.ndarray, own: np.ndarray) -> np.ndarray:
    """(3, n): at the cameras' corners, positive where the planes of `own` are met before those of `other`."""
    rate, own_rate = (candidates.sides[:, :, pair].sum(axis=0) for pair in (other, own))
    return candidates.ahead[:, other] * own_rate - candidates.ahead[:, own] * rate
