"""What mirrors hide in a mirror: its own body and that of others, cut away exactly.

Of the triangles of mirrors that a camera sees, only outlines bound what they hide: sides over which no mirror goes on,
or over which it folds back. All polygons of the camera are cut along these lines, and every piece is then hidden
as a whole, or not at all. Where something passes through a mirror, the line of their contact cuts it too.
"""
from __future__ import annotations

import numpy as np

from ..culling import Candidates, SceneAndMirrors
from ..geometry import between, columns, dot, groups, in_order, largest, mask, others, ranges, shares, smallest
from ..polygons import Line, Lines, Polygons, clip, divide, scene_edges

MOST_PIECES = 1 << 20  # what is not cut along all outlines is hidden or not by its middle
NEARER = 1e-9  # of the distance: what is nearer by less is the same surface
CONTACTS = 8  # triangles of mirrors that one polygon passes through
CROSSING = 1e-6  # of the largest depth in a camera: a smaller one is none
PAIRS_AT_ONCE = 32768  # fit the cache


def cut_behind_mirrors(met: SceneAndMirrors, polygons: Polygons) -> tuple[Polygons, int, int]:
    """The polygons without what mirrors hide from the cameras; how many were hidden or cut; and how many cameras hold
    more outlines or contacts of mirrors than are cut along."""
    candidates = polygons.candidates
    mirror = np.flatnonzero(met.are_mirrors(candidates))
    if not len(mirror):
        return polygons, 0, 0
    asked = mask(len(candidates.cameras), candidates.camera[mirror])[polygons.camera]
    if not asked.any():
        return polygons, 0, 0
    pieces, many = _along_outlines(_outlines(met, candidates.select(mirror)), polygons.select(asked))
    pieces, hidden, left = _before_mirrors(mirror, pieces)
    undecided = len(np.union1d(many, left))
    if not hidden:
        return polygons, 0, undecided
    return Polygons.joined((polygons.select(~asked), pieces)), hidden, undecided


def _along_outlines(lines: Lines, polygons: Polygons) -> tuple[Polygons, np.ndarray]:
    """The polygons in pieces, cut along the outlines of the mirrors in their cameras; and the cameras (k,) of those
    that are not cut along all of them."""
    first = np.searchsorted(lines.camera, np.arange(len(polygons.candidates.cameras) + 1))
    line, polygon = ranges(first[polygons.camera], np.diff(first)[polygons.camera])
    low, high = polygons.extents(polygons.weights)
    near = np.ones(len(line), dtype=bool)
    for k in range(3):
        near &= low[k][polygon] <= np.maximum(lines.start[k], lines.stop[k])[line]
        near &= high[k][polygon] >= np.minimum(lines.start[k], lines.stop[k])[line]
    pieces, left = divide(polygons, lines, line[near], polygon[near], MOST_PIECES)
    return pieces.select(pieces.real), np.unique(polygons.candidates.camera[left])


def _outlines(met: SceneAndMirrors, seen: Candidates) -> Lines:
    """Outlines of the mirrors `seen`, sorted by camera."""
    polygons = clip(seen)
    corner = np.flatnonzero(scene_edges(polygons.after))
    side = polygons.after[corner].astype(np.int64) - Line.SCENE_EDGE
    polygon = polygons.polygon[corner]
    pair = polygons.pair[polygon]
    outer = ~met.inner_sides(seen)[side, pair]
    corner, side, pair = corner[outer], side[outer], pair[outer]
    vertices, row = seen.frames.vertices[:, seen.column[pair]], np.arange(len(pair))
    ends = np.sort(np.stack([vertices[corner, row] for corner in others(side)]), axis=0)
    once, _ = groups(seen.camera[pair], *ends)
    corner, side, pair = corner[once], side[once], pair[once]
    return Lines(seen.camera[pair], seen.sides[side, :, pair].T, polygons.weights[:, corner],
                 polygons.weights[:, polygons.following[corner]])


def _before_mirrors(mirror: np.ndarray, polygons: Polygons) -> tuple[Polygons, int, np.ndarray]:
    """The polygons that no mirror hides, of the candidates `mirror`; those that pass through one are cut in the line of
    contact. How many were hidden or cut, and the cameras of those that pass through too many."""
    order = mirror[in_order(polygons.candidates.camera[mirror])]
    seen, hidden = [polygons.select(slice(0, 0))], 0
    for _ in range(CONTACTS):
        if not len(polygons):
            break
        passing, through, behind = _hidden(order, polygons)
        resting = ~behind
        resting[passing] = False
        seen.append(polygons.select(resting))
        hidden += len(resting) - int(resting.sum())
        polygons = Polygons.joined(_not_behind(through, polygons.select(passing)))
    return Polygons.joined((*seen, polygons)), hidden, np.unique(polygons.camera)


def _hidden(mirror: np.ndarray, polygons: Polygons) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The polygons (k,) that pass through a mirror, of the candidates `mirror`, sorted by camera; which one (k,) they
    pass through; and which polygons (q,) are hidden in their middles."""
    camera = polygons.candidates.camera[mirror]
    start, count = between(camera, polygons.camera, polygons.camera)
    answers = []
    for part in shares(count, PAIRS_AT_ONCE):
        entry, polygon = ranges(start[part], count[part])
        passing, through, behind = _behind(mirror[entry], polygon, polygons.select(part))
        answers.append((part.start + passing, through, behind))
    passing, through, behind = (np.concatenate(side) for side in zip(*answers))
    return passing, through, behind


def _not_behind(other: np.ndarray, polygons: Polygons) -> list[Polygons]:
    """The parts of polygons beside the mirror triangles `other` and before them; others may hide them still."""
    candidates = polygons.candidates
    parts, rest, own = [], polygons, np.arange(len(other))
    # a triangle whose plane crosses the camera's mirror lies behind it for a part of the rays
    for function in (*candidates.sides, candidates.ahead):
        values = function[:, other]
        outside, _ = rest.left(-values[:, own])
        parts.append(outside)
        rest, kept = rest.left(values[:, own])
        own = own[kept]
    parts.append(rest.left(_depth_order(candidates, other[own], rest.pair))[0])
    return parts


def _behind(other: np.ndarray, polygon: np.ndarray,
            polygons: Polygons) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Of pairs of a mirror's candidate `other` and a polygon, rising: the polygons that pass through one, each once,
    and the first that they pass through; and which polygons (q,) are hidden in their middles."""
    candidates = polygons.candidates
    own, hidden = polygons.pair[polygon], np.zeros(len(polygons), dtype=bool)
    hidden[polygon[_hides(candidates, other, own, columns(polygons.middles, polygon))]] = True
    # only where the planes meet in the camera may a polygon pass through the mirror, and only where both are
    order = _depth_order(candidates, other, own)
    mixed = np.flatnonzero((smallest(order) < 0.0) & (largest(order) > 0.0))
    mixed = mixed[_changes_sign(polygons.select(polygon[mixed]), order[:, mixed])]
    both, kept = polygons.select(polygon[mixed]), mixed
    for side in candidates.sides:
        both, left = both.left(side[:, other[kept]])
        kept = kept[left]
    kept = kept[_changes_sign(both, order[:, kept])]
    passing, first = np.unique(polygon[kept], return_index=True)
    return passing, other[kept[first]], hidden


def _changes_sign(polygons: Polygons, corner_values: np.ndarray) -> np.ndarray:
    """Whether a function, given at the corners of the cameras (3, q), is positive and negative on each polygon."""
    low, high = polygons.extents((polygons.weights * np.repeat(corner_values, polygons.size, axis=1)).sum(axis=0))
    least = CROSSING * np.abs(corner_values).max(axis=0)
    return (low < -least) & (high > least)


def _hides(candidates: Candidates, other: np.ndarray, own: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Whether rays at `weights` (3, n) of the cameras meet the mirror triangles of the candidates `other` (n,) before
    they meet the planes of the candidates `own`."""
    sides = [dot(columns(side, other), weights) for side in candidates.sides]
    inside = (sides[0] >= 0.0) & (sides[1] >= 0.0) & (sides[2] >= 0.0) & (other != own)
    met = np.flatnonzero(inside)
    other, own, weights = other[met], own[met], columns(weights, met)
    rate = sides[0][met] + sides[1][met] + sides[2][met]
    own_rate = dot(columns(candidates.rate, own), weights)
    reach, own_reach = (dot(columns(candidates.ahead, pair), weights) for pair in (other, own))
    inside[met] = (reach >= 0.0) & (reach * own_rate * (1.0 + NEARER) < own_reach * rate * (1.0 - NEARER))
    return inside


def _depth_order(candidates: Candidates, other: np.ndarray, own: np.ndarray) -> np.ndarray:
    """(3, n): at the cameras' corners, positive where the planes of `own` are met before those of `other`."""
    return (columns(candidates.ahead, other) * columns(candidates.rate, own)
            - columns(candidates.ahead, own) * columns(candidates.rate, other))
