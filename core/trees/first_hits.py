"""First hits of many rays at once with the triangles of a `BoxTree`: nearer boxes first, all rays together.

What is left to do lies on a stack of batches of (ray, node); a batch is opened into the nearer and the farther child of
each of its nodes, so that most rays have found their triangle before farther boxes are looked at. Small batches go on
undivided: there a call of NumPy costs more than what is saved.
"""
from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from ..geometry import ranges
from ..support import breathe, in_parallel
from .box_tree import BoxTree

RAYS_AT_ONCE = 32768
WORTH_DIVIDING = 8192  # pairs of a batch
EDGE = 1e-10  # barycentric: a ray may miss a triangle by this, so that it does not slip between two


@dataclass(frozen=True)
class Hits:
    """First hits of rays (n).

    Attributes
    ----------
    triangle : (n,) int64, -1 where a ray meets none
    distance : (n,) float64, in lengths of the direction, infinite where none
    intersections, nodes : int, tests of a ray against a triangle and against a box
    """

    triangle: np.ndarray
    distance: np.ndarray
    intersections: int
    nodes: int


def first_hits(tree: BoxTree, origins: np.ndarray, directions: np.ndarray, *, least: float = 0.0,
               limit: np.ndarray | None = None,
               asked: Callable[[np.ndarray, np.ndarray], np.ndarray] | None = None) -> Hits:
    """The first triangle that each ray meets, from either side.

    Parameters
    ----------
    origins, directions : (3, n) float64
    least : float, hits nearer than this are the surface that the ray starts on
    limit : (n,) float64, optional, hits from this distance on do not count
    asked : callable, optional
        Which pairs (p,) of a ray and a triangle count; not, for one, those of a ray and what it starts on.
    """
    count = origins.shape[1]
    triangle, distance = np.full(count, -1), np.full(count, np.inf)
    parts = [slice(start, min(start + RAYS_AT_ONCE, count))
             for start in range(0, count if len(tree) else 0, RAYS_AT_ONCE)]

    def trace(part: slice) -> _Trace:
        own = _Trace(tree, origins[:, part], directions[:, part], least, None if limit is None else limit[part],
                     None if asked is None else partial(_later, asked, part.start))
        own.run()
        return own

    traces = in_parallel(trace, parts)
    for part, own in zip(parts, traces):
        triangle[part], distance[part] = own.triangle, np.where(own.triangle >= 0, own.nearest, np.inf)
    return Hits(triangle, distance, sum(own.intersections for own in traces), sum(own.nodes for own in traces))


def _later(asked: Callable[[np.ndarray, np.ndarray], np.ndarray], start: int, ray: np.ndarray,
           triangle: np.ndarray) -> np.ndarray:
    return asked(start + ray, triangle)


class _Trace:
    """One part of the rays on its way through the tree."""

    def __init__(self, tree: BoxTree, origins, directions, least, limit, asked) -> None:
        self.tree, self.least, self.asked = tree, least, asked
        self.origin = origins - tree.middle[:, None]
        self.direction = directions
        with np.errstate(divide="ignore"):
            # a huge number instead of infinity: 0 times it is 0, as a ray along a box's side needs
            self.inverse = np.clip(1.0 / directions, -1e30, 1e30)
        self.shift = self.origin * self.inverse
        count = origins.shape[1]
        self.nearest = np.full(count, np.inf) if limit is None else limit.copy()
        self.triangle = np.full(count, -1)
        self.intersections = self.nodes = 0

    def run(self) -> None:
        ray = np.arange(len(self.nearest))
        node = np.zeros(len(ray), dtype=np.int64)
        stack = [_entering(ray, node, self._enter(ray, node))]
        while stack:
            breathe()
            ray, node, entry = stack.pop()
            ahead = entry < self.nearest[ray]
            ray, node = ray[ahead], node[ahead]
            child = self.tree.child[node]
            leaf = child < 0
            if leaf.any():
                self._meet(ray[leaf], node[leaf])
                ray, child = ray[~leaf], child[~leaf]
            if not len(ray):
                continue
            first, second = self._enter(ray, child), self._enter(ray, child + 1)
            nearer = first <= second
            near = np.where(nearer, first, second), np.where(nearer, child, child + 1)
            far = np.where(nearer, second, first), np.where(nearer, child + 1, child)
            batches = [_entering(ray, node, entry) for entry, node in (far, near)]
            if len(ray) < WORTH_DIVIDING:
                batches = [tuple(np.concatenate(parts) for parts in zip(*batches))]
            stack.extend(batch for batch in batches if len(batch[0]))

    def _enter(self, ray: np.ndarray, node: np.ndarray) -> np.ndarray:
        """Return the distance at which each `ray` (n,) enters the box of its `node` (n,).

        It is infinite if the ray misses the box, or enters it behind its nearest hit so far.
        """
        self.nodes += len(ray)
        enter, leave = np.zeros(len(ray)), self.nearest[ray]
        for low, high, inverse, shift in zip(self.tree.low, self.tree.high, self.inverse, self.shift):
            inverse, shift = inverse[ray], shift[ray]
            one, other = low[node] * inverse - shift, high[node] * inverse - shift
            enter = np.maximum(enter, np.minimum(one, other))
            leave = np.minimum(leave, np.maximum(one, other))
        return np.where(enter <= leave, enter, np.inf)

    def _meet(self, ray: np.ndarray, node: np.ndarray) -> None:
        entry, pair = ranges(self.tree.start[node], self.tree.count[node])
        ray = ray[pair]
        self.intersections += len(ray)
        distance, inside = meet(self.tree, entry, self.origin, self.direction, ray)
        good = inside & (distance > self.least) & (distance < self.nearest[ray])
        good = np.flatnonzero(good)
        if self.asked is not None and len(good):
            good = good[self.asked(ray[good], self.tree.order[entry[good]])]
        # farthest first: of the hits of one ray the nearest is written last
        good = good[np.argsort(-distance[good], kind="stable")]
        self.nearest[ray[good]] = distance[good]
        self.triangle[ray[good]] = self.tree.order[entry[good]]


def _entering(ray: np.ndarray, node: np.ndarray, entry: np.ndarray) -> tuple[np.ndarray, ...]:
    hit = np.flatnonzero(entry < np.inf)
    return ray[hit], node[hit], entry[hit]


def meet(tree: BoxTree, entry: np.ndarray, origins: np.ndarray, directions: np.ndarray,
         ray: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Intersect rays with the planes of triangles.

    Parameters
    ----------
    entry : (p,) int64, triangles, as entries of the tree's `order`
    origins, directions : (3, n) float64, of all rays, relative to the tree's `middle`
    ray : (p,) int64, the ray of each pair

    Returns
    -------
    distance : (p,) float64, in lengths of the direction
    inside : (p,) bool, True if the ray meets the plane inside the triangle
    """
    origin, direction = np.take(origins, ray, axis=1), np.take(directions, ray, axis=1)

    def row(k):
        x, y, z, w = (tree.frames[4 * k + j][entry] for j in range(4))
        ahead = x * direction[0] + y * direction[1] + z * direction[2]
        return x * origin[0] + y * origin[1] + z * origin[2] + w, ahead

    height, rise = row(2)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = -height / rise
        here, there = row(0)
        second = here + distance * there
        here, there = row(1)
        third = here + distance * there
        return distance, (second >= -EDGE) & (third >= -EDGE) & (second + third <= 1.0 + EDGE)
