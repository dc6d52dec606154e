"""Exact occlusion by mirrors of reflected polygons: by the mirror's own body and by other mirrors.

Of the mirror triangles that a camera sees, only outlines bound the hidden region: sides at which the mirror ends or
folds back. All polygons of the camera are cut along these lines; each piece is then hidden entirely, or not at all. If
something passes through a mirror, it is also cut along the line of contact.
"""
from __future__ import annotations

import numpy as np

from ..culling import Candidates, SceneAndMirrors
from ..geometry import between, columns, dot, groups, in_order, largest, mask, others, ranges, shares, smallest
from ..polygons import Line, Lines, Polygons, clip, divide, scene_edges

MOST_PIECES = 1 << 20  # pieces in all; one that is not cut along all outlines is hidden or not by its centre
NEARER = 1e-9  # share of the distance: a surface that is nearer by less is the same surface
CONTACTS = 8  # triangles of mirrors that one polygon passes through, at most
CROSSING = 1e-6  # share of the largest depth difference in a camera: smaller differences are no crossing
PAIRS_AT_ONCE = 32768  # fit the cache


def cut_behind_mirrors(met: SceneAndMirrors, polygons: Polygons) -> tuple[Polygons, int, int]:
    """Cut away the parts of polygons that mirrors hide from their cameras.

    Returns
    -------
    polygons : Polygons, the visible parts
    hidden : int, number of polygons that were hidden or cut
    undecided : int, number of cameras with too many outlines or contacts of mirrors to cut along all of them
    """
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
    """Cut polygons along the outlines of the mirrors in their cameras.

    Returns
    -------
    pieces : Polygons
    many : (k,) int64, cameras of polygons that were not cut along all their outlines
    """
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
    """Return the outlines of the mirror triangles in the candidates `seen`, sorted by camera."""
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
    """Drop polygons that mirrors hide; cut polygons that pass through a mirror along the line of contact.

    Parameters
    ----------
    mirror : (n,) int64, candidates whose triangles are mirrors

    Returns
    -------
    polygons : Polygons, the visible ones
    hidden : int, number of polygons that were hidden or cut
    left : (k,) int64, cameras of polygons that pass through too many mirror triangles
    """
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
    """Test polygons (q) against the mirror triangles in their cameras: the candidates `mirror`, sorted by camera.

    Returns
    -------
    passing : (k,) int64, polygons that pass through a mirror triangle
    through : (k,) int64, candidate of that triangle
    behind : (q,) bool, True for polygons whose centre is hidden
    """
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
    """Return the parts of polygons (k) outside their mirror triangle, candidate `other` (k,), and those before it.

    Other mirrors may still hide them.
    """
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
    """Test pairs of a mirror's candidate `other` (n,) and a `polygon` (n,), increasing; return as `_hidden` does.

    Each polygon that passes through mirror triangles is returned once, with the first of them.
    """
    candidates = polygons.candidates
    own, hidden = polygons.pair[polygon], np.zeros(len(polygons), dtype=bool)
    hidden[polygon[_hides(candidates, other, own, columns(polygons.middles, polygon))]] = True
    # a polygon can pass through a mirror only if their planes cross in the camera, within both of them
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
    """Return True (q,) for polygons on which a function is positive at one corner and negative at another.

    The function is linear in the weights, with `corner_values` (3, q) at the corners of the polygons' cameras.
    """
    low, high = polygons.extents((polygons.weights * np.repeat(corner_values, polygons.size, axis=1)).sum(axis=0))
    least = CROSSING * np.abs(corner_values).max(axis=0)
    return (low < -least) & (high > least)


def _hides(candidates: Candidates, other: np.ndarray, own: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Return True (n,) if a camera's ray meets the mirror triangle of `other` (n,) before the plane of `own` (n,).

    `other` and `own` are candidates in the same camera; `weights` (3, n) give the ray.
    """
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
    """Compare depths at the cameras' corners (3, n): positive where the plane of `own` is met before that of `other`.

    `other` and `own` (n,) are candidates in the same camera.
    """
    return (columns(candidates.ahead, other) * columns(candidates.rate, own)
            - columns(candidates.ahead, own) * columns(candidates.rate, other))
