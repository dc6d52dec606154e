"""What mirrors hide in a mirror: its own body and that of others, cut away exactly.

Of the triangles of mirrors that a camera sees, only outlines bound what they hide: sides over which no mirror goes on,
or over which it folds back. All polygons of the camera are cut along these lines, and every piece is then hidden
as a whole, or not at all. Where something passes through a mirror, the line of their contact cuts it too.
"""
from __future__ import annotations

import numpy as np

from ..culling import Candidates, SceneAndMirrors
from ..geometry import dot, groups, ranges, shares
from ..polygons import Line, Polygons, clip, scene_edges
from ..support import breathe

LINES = 32  # outlines that cut one camera; with more, what is left of a polygon is hidden or not by its middle
NEARER = 1e-9  # of the distance: what is nearer by less is the same surface
CONTACTS = 8  # triangles of mirrors that one polygon passes through
CROSSING = 1e-6  # of the largest depth in a camera: a smaller one is none
PAIRS_AT_ONCE = 1 << 19
INWARD = 0.05  # how far from its corners towards its middle a polygon is asked


def cut_behind_mirrors(met: SceneAndMirrors, polygons: Polygons) -> tuple[Polygons, int, int]:
    """The polygons without what mirrors hide from the cameras; how many were hidden or cut; and how many cameras hold
    more outlines or contacts of mirrors than are cut along."""
    candidates = polygons.candidates
    mirror = np.flatnonzero(met.are_mirrors(candidates))
    if not len(mirror):
        return polygons, 0, 0
    touched = np.zeros(len(candidates.cameras), dtype=bool)
    touched[candidates.camera[mirror]] = True
    asked = touched[polygons.camera]
    if not asked.any():
        return polygons, 0, 0
    lines = _outlines(met, candidates.select(mirror))
    many = np.unique(polygons.camera[asked])
    many = many[np.bincount(lines[0], minlength=len(candidates.cameras))[many] > LINES]
    pieces, hidden, left = _before_mirrors(mirror, _along_outlines(lines, polygons.select(asked)))
    undecided = len(np.union1d(many, left))
    if not hidden:
        return polygons, 0, undecided
    return Polygons.joined((polygons.select(~asked), pieces)), hidden, undecided


def _along_outlines(lines: tuple[np.ndarray, np.ndarray, np.ndarray], polygons: Polygons) -> Polygons:
    """The polygons in pieces, cut along the outlines of the mirrors in their cameras."""
    first = np.searchsorted(lines[0], np.arange(len(polygons.candidates.cameras) + 1))
    count = np.diff(first)[polygons.camera]
    for number in range(min(LINES, int(count.max(initial=0)))):
        breathe()
        crossed = np.flatnonzero(count > number)
        line = first[polygons.camera[crossed]] + number
        low, high = (bound.reduceat(polygons.weights, polygons.start[:-1], axis=1)[:, crossed]
                     for bound in (np.minimum, np.maximum))
        near = ((low <= lines[2][1][:, line]) & (high >= lines[2][0][:, line])).all(axis=0)
        values = lines[1][:, line[near]]
        divided = np.isin(np.arange(len(count)), crossed[near])
        sides = [polygons.select(divided).left(sign * values)[0] for sign in (1.0, -1.0)]
        polygons = Polygons.joined((polygons.select(~divided), *sides))
        count = np.diff(first)[polygons.camera]
    return polygons


def _outlines(met: SceneAndMirrors, seen: Candidates) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Outlines of the mirrors `seen`, sorted by camera: the camera (k,), the values (3, k) at its corners of a function
    that is zero on the line, and the least and the largest weights (2, 3, k) on it."""
    polygons = clip(seen)
    corner = np.flatnonzero(scene_edges(polygons.after))
    side = polygons.after[corner].astype(np.int64) - Line.SCENE_EDGE
    polygon = polygons.polygon[corner]
    pair = polygons.pair[polygon]
    outer = ~met.inner_sides(seen)[side, pair]
    corner, side, polygon, pair = corner[outer], side[outer], polygon[outer], pair[outer]
    vertices, row = seen.frames.vertices[:, seen.column[pair]], np.arange(len(pair))
    ends = np.sort(np.stack((vertices[(side + 1) % 3, row], vertices[(side + 2) % 3, row])), axis=0)
    once, _ = groups(seen.camera[pair], *ends)
    corner, side, polygon, pair = corner[once], side[once], polygon[once], pair[once]
    along = np.stack((polygons.weights[:, corner], polygons.weights[:, polygons.following[corner]]))
    return seen.camera[pair], seen.sides[side, :, pair].T, np.stack((along.min(axis=0), along.max(axis=0)))


def _before_mirrors(mirror: np.ndarray, polygons: Polygons) -> tuple[Polygons, int, np.ndarray]:
    """The polygons that no mirror hides, of the candidates `mirror`; those that pass through one are cut in the line of
    contact. How many were hidden or cut, and the cameras of those that pass through too many."""
    candidates = polygons.candidates
    order = mirror[np.argsort(candidates.camera[mirror], kind="stable")]
    seen, hidden = [], 0
    for _ in range(CONTACTS):
        asked, parts = polygons, []
        camera = asked.camera
        start, stop = (np.searchsorted(candidates.camera[order], camera, side=side) for side in ("left", "right"))
        for part in shares(stop - start, PAIRS_AT_ONCE):
            breathe()
            entry, polygon = ranges(start[part], (stop - start)[part])
            some = asked.select(np.arange(part.start, part.stop))
            covered, middle = _behind(order[entry], polygon, some)
            other, polygon = order[entry][covered], polygon[covered]
            crossing = _changes_sign(some.select(polygon), _depth_order(candidates, other, some.pair[polygon]))
            passing, first = np.unique(polygon[crossing], return_index=True)
            resting = np.ones(len(some.pair), dtype=bool)
            resting[passing] = False
            seen.append(some.select(resting & ~middle))
            hidden += int((middle | ~resting).sum())
            parts += _not_behind(other[crossing][first], some.select(passing))
        polygons = Polygons.joined(parts) if parts else asked.select(slice(0, 0))
        if not len(polygons.pair):
            break
    return Polygons.joined((*seen, polygons)), hidden, np.unique(polygons.camera)


def _not_behind(other: np.ndarray, polygons: Polygons) -> list[Polygons]:
    """The parts of polygons beside the mirror triangles `other` and before them; others may hide them still."""
    candidates = polygons.candidates
    parts, rest, own = [], polygons, np.arange(len(other))
    for side in range(3):
        values = candidates.sides[side][:, other]
        outside, _ = rest.left(-values[:, own])
        parts.append(outside)
        rest, kept = rest.left(values[:, own])
        own = own[kept]
    parts.append(rest.left(_depth_order(candidates, other[own], rest.pair))[0])
    return parts


def _behind(other: np.ndarray, polygon: np.ndarray, polygons: Polygons) -> tuple[np.ndarray, np.ndarray]:
    """Which pairs of a polygon and a mirror's candidate `other` that may cross have a place where the mirror hides it,
    of the corners, a little inward; and which polygons (q,) are hidden in their middles."""
    candidates, size = polygons.candidates, polygons.size
    near = _near(other, polygon, polygons)
    other, polygon = other[near], polygon[near]
    middle = polygons.middles
    own, middle_hidden = polygons.pair[polygon], np.zeros(len(size), dtype=bool)
    middle_hidden[polygon[_hides(candidates, other, own, middle[:, polygon])]] = True
    # only where the planes meet in the camera may one side of a polygon lie before the mirror, and one behind
    order = _depth_order(candidates, other, own)
    mixed = np.flatnonzero((order < 0.0).any(axis=0) & (order > 0.0).any(axis=0))
    found = np.zeros(len(other), dtype=bool)
    covered = np.zeros(len(near), dtype=bool)
    for corner in range(int(size.max(initial=0))):
        spot = polygons.weights[:, polygons.start[:-1] + np.minimum(corner, size - 1)]
        at = (1.0 - INWARD) * spot + INWARD * middle
        found[mixed] |= _hides(candidates, other[mixed], own[mixed], at[:, polygon[mixed]])
    covered[near] = found
    return covered, middle_hidden


def _near(other: np.ndarray, polygon: np.ndarray, polygons: Polygons) -> np.ndarray:
    """Which mirror triangles have no side that keeps the box of the polygon's weights outside."""
    if not len(other):
        return np.zeros(0, dtype=bool)
    low, high = (bound.reduceat(polygons.weights, polygons.start[:-1], axis=1)[:, polygon]
                 for bound in (np.minimum, np.maximum))
    near = np.ones(len(other), dtype=bool)
    for side in polygons.candidates.sides:
        values = side[:, other]
        near &= np.maximum(values * low, values * high).sum(axis=0) >= 0.0
    return near


def _changes_sign(polygons: Polygons, corner_values: np.ndarray) -> np.ndarray:
    """Whether a function, given at the corners of the cameras (3, q), is positive and negative on each polygon."""
    if not len(polygons.pair):
        return np.zeros(0, dtype=bool)
    value = (polygons.weights * np.repeat(corner_values, polygons.size, axis=1)).sum(axis=0)
    low, high = (bound.reduceat(value, polygons.start[:-1]) for bound in (np.minimum, np.maximum))
    least = CROSSING * np.abs(corner_values).max(axis=0)
    return (low < -least) & (high > least)


def _hides(candidates: Candidates, other: np.ndarray, own: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """Whether rays at `weights` (3, n) of the cameras meet the mirror triangles of the candidates `other` (n,) before
    they meet the planes of the candidates `own`."""
    sides = [dot(side[:, other], weights) for side in candidates.sides]
    inside = (sides[0] >= 0.0) & (sides[1] >= 0.0) & (sides[2] >= 0.0) & (other != own)
    met = np.flatnonzero(inside)
    other, own, weights = other[met], own[met], weights[:, met]
    rate = sides[0][met] + sides[1][met] + sides[2][met]
    own_rate = dot(candidates.rate[:, own], weights)
    reach, own_reach = dot(candidates.ahead[:, other], weights), dot(candidates.ahead[:, own], weights)
    inside[met] = (reach >= 0.0) & (reach * own_rate * (1.0 + NEARER) < own_reach * rate * (1.0 - NEARER))
    return inside


def _depth_order(candidates: Candidates, other: np.ndarray, own: np.ndarray) -> np.ndarray:
    """(3, n): at the cameras' corners, positive where the planes of `own` are met before those of `other`."""
    return (candidates.ahead[:, other] * candidates.rate[:, own]
            - candidates.ahead[:, own] * candidates.rate[:, other])
