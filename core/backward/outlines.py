"""Outlines between the points of a lattice: places on lattice sides at which the visible triangle changes.

Between two points on the same part of a mirror, rays change linearly, as in a three-ray camera. So the place where a
ray leaves a triangle follows from the barycentric coordinates at both points, without more rays. At the mirror's border
and where rays jump, the side is bisected with a few more rays.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from ..culling import SceneAndMirrors
from ..geometry import SceneFrames, cross, distinct, dot, norm, others, unit
from .paths import NOTHING, Paths

HALVINGS = 4    # bisection steps on a side: the outline is exact to a thirtieth of its length
NEAREST = 0.01  # share of a side: smallest distance of outlines from lattice points, so that pixel centres stay right
LEAP = 4.0      # rays or places jump along a side if they change more than this multiple of the change beside it
LEVEL = 1e-3    # radians: rays that differ by less do not jump


@dataclass(frozen=True)
class Sides:
    """Sides (m) of a lattice between points with different keys.

    Attributes
    ----------
    start, end : (m,) int64, samples at the ends, -1 where the mirror is not seen
    before, behind : (m,) int64, the samples one step before the start and one after the end, -1 for none
    """

    start: np.ndarray
    end: np.ndarray
    before: np.ndarray
    behind: np.ndarray


def crossings(sides: Sides, paths: Paths, key: np.ndarray, met: SceneAndMirrors) -> tuple[np.ndarray, np.ndarray]:
    """Find where sides cross outlines.

    Parameters
    ----------
    paths : Paths
        The n samples.
    key : (n,) int64
        Key of each path: equal for the same source triangle and number of bounces.

    Returns
    -------
    share : (m,) float64
        Place of the outline along each side, 0 at the start, 1 at the end.
    doubtful : (m,) bool
        True for sides where it could not be computed.
    """
    doubtful = (sides.start < 0) | (sides.end < 0)
    doubtful |= paths.bounces[sides.start] != paths.bounces[sides.end]
    doubtful |= _leap(sides, paths)
    share, known = np.full(len(sides.start), 0.5), np.flatnonzero(~doubtful)
    start, end = paths.select(sides.start[known]), paths.select(sides.end[known])
    first, own_first, wrong_first, on_first = _left(start, end, met)
    second, own_second, wrong_second, on_second = _left(end, start, met)
    second = 1.0 - second
    # if one triangle is in front of the other, both overlap: the end of the nearer one is the outline
    middle = np.clip(0.5 * (first + second), 0.0, 1.0)
    with np.errstate(invalid="ignore"):
        nearer = own_first(middle) <= own_second(middle)
    shown_first, shown_second = start.source >= 0, end.source >= 0
    found = np.where(second < first, np.where(nearer, first, second), 0.5 * (first + second))
    found = np.where(~shown_second, first, np.where(~shown_first, second, found))
    unclear = (wrong_first & shown_first) | (wrong_second & shown_second) | ~np.isfinite(found)
    # if another triangle continues across the crossed side, the outline lies somewhere beyond
    unclear |= (on_first & ~shown_second) | (on_second & ~shown_first)
    with np.errstate(invalid="ignore"):
        apart = np.abs(own_first(found) - own_second(found))
        change = np.maximum(*(np.abs(own(np.ones(1)) - own(np.zeros(1))) for own in (own_first, own_second)))
    unclear |= (on_first | on_second) & ~(apart <= change)
    unclear |= (found <= 0.0) | (found >= 1.0)
    share[known] = np.clip(np.nan_to_num(found, nan=0.5), NEAREST, 1.0 - NEAREST)
    doubtful[known] = unclear
    return share, doubtful


def between(start: Paths, end: Paths, share: np.ndarray, met: SceneAndMirrors) -> Paths:
    """Interpolate paths at `share` (m,) from `start` to `end`; they end on the source triangles of the start."""
    def mixed(one: np.ndarray, other: np.ndarray) -> np.ndarray:
        return one + share * (other - one)

    origin, ray = mixed(start.origin, end.origin), unit(mixed(start.ray, end.ray))
    found, column = distinct(start.source)
    frames = SceneFrames.of(met, found)
    distance = np.maximum(frames.distance(column, origin, ray), 0.0)
    normal = mixed(start.normal, end.normal)
    size = norm(np.moveaxis(normal, 1, 0))
    normal = normal / np.where(size > 0.0, size, 1.0)[:, None]
    return replace(start, place=mixed(start.place, end.place), origin=origin, ray=ray, point=origin + distance * ray,
                   length=mixed(start.length, end.length), normal=normal)


def halved(start: Paths, end: Paths, keys: tuple[np.ndarray, np.ndarray],
           look: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, Paths, np.ndarray]]
           ) -> tuple[np.ndarray, Paths, Paths]:
    """Find outlines on sides by bisection with more rays.

    Parameters
    ----------
    start, end : Paths
        Paths at the ends of the m sides.
    keys : (m,) int64 each
        Keys at the start and at the end.
    look : callable
        Takes sides (k,) and places (k,) along them from 0 to 1. Returns the indices of rays that see the mirror, their
        paths, and the paths' keys.

    Returns
    -------
    share : (m,) float64
        Place of the outline along each side.
    first, second : Paths
        The last paths found before the outline with the key of the start, and after it with the key of the end.
    """
    count = len(keys[0])
    low, high, every = np.zeros(count), np.ones(count), np.arange(count)
    found = [[start], [end]]
    last = [every.copy(), every.copy()]
    total = [count, count]
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        seen, paths, key = look(every, middle)
        own = np.full(count, NOTHING)
        own[seen] = key
        # if one end sees nothing, any ray that sees something counts as being on the other end's side
        empty = np.minimum(*keys) < 0
        before = np.where(empty, (own >= 0) == (keys[0] >= 0), own == keys[0])
        # between two surfaces, a ray to a third triangle counts as being on the one that is about as far away
        third = np.flatnonzero(~empty[seen] & (key >= 0) & (key != keys[0][seen]) & (key != keys[1][seen]))
        at, length = seen[third], paths.total[third]
        before[at] = np.abs(length - start.total[at]) < np.abs(length - end.total[at])
        low, high = np.where(before, middle, low), np.where(before, high, middle)
        for which, chosen in enumerate((before & (own == keys[0]), ~before & (own == keys[1]))):
            some = np.flatnonzero(chosen[seen])
            found[which].append(paths.select(some))
            last[which][seen[some]] = total[which] + np.arange(len(some))
            total[which] += len(some)
    first, second = (joined(parts).select(index) for parts, index in zip(found, last))
    return 0.5 * (low + high), first, second


def joined(parts: list[Paths]) -> Paths:
    """Concatenate paths; arrays with one row per mirror are padded to the largest number of mirrors."""
    most = max(len(one.later) for one in parts)
    return Paths.joined([replace(
        one, later=np.pad(one.later, ((0, most - len(one.later)), (0, 0)), constant_values=-1),
        normal=np.pad(one.normal, ((0, most - len(one.later)), (0, 0), (0, 0)))) for one in parts])


def _left(start: Paths, end: Paths, met: SceneAndMirrors
          ) -> tuple[np.ndarray, Callable[[np.ndarray], np.ndarray], np.ndarray, np.ndarray]:
    """Find where rays, moved from `start` to `end`, leave the source triangle that they hit at the start.

    Returns
    -------
    share : (m,) float64
        Place from 0 to 1 at which the ray leaves the triangle; 1 if it hits it all the way.
    length : callable
        Takes places (m,) from 0 to 1 and returns the path lengths (m,) to the triangle's plane.
    wrong : (m,) bool
        True where these values are not valid.
    goes_on : (m,) bool
        True where another triangle continues across the crossed side.
    """
    shown = start.source >= 0
    source = np.maximum(start.source, 0)
    found, column = distinct(source)
    frames = SceneFrames.of(met, found)
    with np.errstate(divide="ignore", invalid="ignore"):
        near = dot(start.point - start.origin, start.ray)
        far = frames.distance(column, end.origin, end.ray)
        normal = frames.normal[:, column]
        here = np.maximum(frames.weights(column, start.point), 0.0) * np.abs(dot(normal, start.ray))
        there = frames.weights(column, end.origin + far * end.ray) * np.abs(dot(normal, end.ray))
        # times the cosine at which the ray meets the plane, weights change linearly with the ray, also where it grazes
        shares = np.where(there < 0.0, here / (here - there), 1.0)
        share = shares.min(axis=0)
    wrong = ~(far > 0.0) | ~np.isfinite(there).all(axis=0)
    mesh, corner = met.tree.mesh, np.argmin(shares, axis=0)
    beyond = mesh.beyond[source, corner]
    one, other = (mesh.positions[mesh.triangles[source, others(corner)[k]]].T - start.origin for k in range(2))
    plane = cross(one, other)
    own, far_corner = (dot(plane, mesh.positions[vertex].T - start.origin) for vertex in
                       (mesh.triangles[source, corner], mesh.triangles.ravel()[np.maximum(beyond, 0)]))
    goes_on = shown & (share < 1.0) & (beyond >= 0) & (own * far_corner < 0.0)
    return (np.clip(share, 0.0, 1.0),
            lambda way: start.length + near + way * (end.length + far - start.length - near), wrong, goes_on)


def _leap(sides: Sides, paths: Paths) -> np.ndarray:
    """Return True (m,) for sides along which rays, places or origins change far more than on neighbouring sides."""
    known = np.stack((sides.before, sides.start, sides.end, sides.behind)) >= 0
    found = np.zeros(len(sides.start), dtype=bool)
    for values, least in ((paths.ray, LEVEL), (paths.place, 0.0), (paths.origin, 0.0)):
        at = [values[:, number] for number in (sides.before, sides.start, sides.end, sides.behind)]
        first, own, last = (norm(other - one) for one, other in zip(at, at[1:]))
        beside = np.maximum(np.where(known[0], first, 0.0), np.where(known[3], last, 0.0))
        found |= (own > LEAP * beside + least) & (known[0] | known[3])
    return found
