"""A complete tree with spheres round what its nodes hold, and how cones descend it, a level at a time.

J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 1975.
"""
from __future__ import annotations

from collections.abc import Callable, Generator
from dataclasses import dataclass

import numpy as np

from ..geometry import Order, TriangleMesh, columns
from ..support import breathe, portions
from .cones import Balls, Cones
from .shafts import Shafts

FIRST_LEVEL = 4
STRIDE = 2
CONES_AT_ONCE, NODES_AT_ONCE = 8192, 1 << 16
CURVE_BITS = 21  # bits of each coordinate: three coordinates fit one integer
_SPREADING = ((32, 0x1f00000000ffff), (16, 0x1f0000ff0000ff), (8, 0x100f00f00f00f00f), (4, 0x10c30c30c30c30c3),
              (2, 0x1249249249249249))


@dataclass(frozen=True)
class NodeTree:
    """Common base of the trees of bounding spheres over triangles and over vertices.

    Attributes
    ----------
    mesh : TriangleMesh, the scene in its canonical order; all indices below refer to it
    given : Order, indices of its vertices and triangles in the mesh that was given
    depth : int, the leaves are the 2**depth nodes of the last level
    spheres : list of (4, 2**level) float64
        Centre and radius of the bounding sphere of each node of each level; the radius of an empty node is -inf.
    leaf_start : (2**depth + 1,) int64, leaf i holds order[leaf_start[i]:leaf_start[i + 1]]
    order : (n,) int64, triangles or vertices, leaf after leaf; triangles without an area are left out
    """

    mesh: TriangleMesh
    given: Order
    depth: int
    spheres: list
    leaf_start: np.ndarray
    order: np.ndarray

    def __len__(self) -> int:
        return len(self.order)

    def descended(self, cones: Cones | Balls | Shafts, wanted: np.ndarray, resting: Callable | None = None
                  ) -> Generator[tuple[np.ndarray, np.ndarray, int], None, None]:
        """Find pairs of cones (n) and leaves that touch, in shares that fit the memory.

        Parameters
        ----------
        wanted : (n,) bool, a cone descends only while its entry is True; the caller may change it between shares
        resting : callable, optional, returns True (p,) for pairs (level, cone, node) that are not to descend further

        Yields
        ------
        cone, leaf : (p,) int64
        visited : int, number of nodes tested
        """
        level, first = self.top()
        for part in portions(len(cones), CONES_AT_ONCE):
            cone = np.arange(part.start, part.stop)
            waiting = [(level, np.repeat(cone, len(first)), np.tile(first, len(cone)))]
            while waiting:
                yield self._step(cones, wanted, resting, waiting)

    def _step(self, cones: Cones | Balls | Shafts, wanted: np.ndarray, resting: Callable | None,
              waiting: list) -> tuple[np.ndarray, np.ndarray, int]:
        """Descend one level with the pairs of cones and nodes pushed last to the stack `waiting`.

        Push the pairs of the next level, or return those of leaves, as `descended` does.
        """
        level, cone, node = waiting.pop()
        sphere, visited = self.spheres[level], len(cone)
        touching = wanted[cone] & cones.touch(cone, columns(sphere[:3], node), columns(sphere[3], node))
        cone, node = cone[touching], node[touching]
        if resting is not None:
            going = ~resting(level, cone, node)
            cone, node = cone[going], node[going]
        if level == self.depth:
            return cone, node, visited
        for start in reversed(range(0, max(len(cone), 1), NODES_AT_ONCE)):
            part = slice(start, start + NODES_AT_ONCE)
            below, inner, parent = self.below(level, node[part])
            waiting.append((below, cone[part][parent], inner))
        return cone[:0], node[:0], visited

    def top(self) -> tuple[int, np.ndarray]:
        """Return the level at which a descent begins, and its nodes."""
        level = min(FIRST_LEVEL, self.depth)
        return level, np.arange(2**level)

    def below(self, level: int, node: np.ndarray) -> tuple[int, np.ndarray, np.ndarray]:
        """Return the next level of a descent from nodes `node` (n,), their descendants, and the ancestors of these.

        Descendants (m,) are nodes of the next level; ancestors (m,) are indices into `node`.
        """
        step = min(STRIDE, self.depth - level)
        fan = np.arange(2**step)
        return level + step, (node[:, None] * len(fan) + fan).ravel(), np.repeat(np.arange(len(node)), len(fan))

    def runs(self, level: int, node: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return begin and end (n,) of the entries of `order` that nodes `node` (n,) of a level contain."""
        fan = 2 ** (self.depth - level)
        return self.leaf_start[node * fan], self.leaf_start[(node + 1) * fan]


def depth_for(count: int, bucket: int) -> int:
    """Return the depth of a complete tree over `count` points with about `bucket` points in a leaf."""
    return max(0, int(np.ceil(np.log2(max(count, 1) / bucket))))


def along_curve(points: np.ndarray) -> np.ndarray:
    """Return the order (n,) that sorts `points` (n, 3), at least one, along a Z curve.

    It is the order of a tree that halves the bounding cube along x, y and z in turn, and needs only one sort
    (C. Lauterbach et al., "Fast BVH Construction on GPUs", Eurographics 2009).
    """
    count = len(points)
    low, size = points.min(axis=0), np.ptp(points, axis=0).max()
    most = 2.0**CURVE_BITS - 1.0
    code = np.zeros(count, dtype=np.uint64)
    for axis in range(3):
        breathe()
        cell = np.minimum((points[:, axis] - low[axis]) * (most / (size if size > 0.0 else 1.0)), most)
        code |= _spread(cell.astype(np.uint64)) << np.uint64(axis)
    return np.argsort(code, kind="stable")


def curve_leaves(points: np.ndarray, depth: int) -> np.ndarray:
    """Return the leaf (n,) of each point (n, 3) in a complete tree whose leaves are equal parts of a Z curve."""
    leaf = np.empty(len(points), dtype=np.int64)
    leaf[along_curve(points)] = np.arange(len(points)) * 2**depth // len(points)
    return leaf


def _spread(number: np.ndarray) -> np.ndarray:
    """Insert two zeros between neighbouring bits of integers `number` (n,) of 21 bits."""
    for shift, mask in _SPREADING:
        number = (number | (number << np.uint64(shift))) & np.uint64(mask)
    return number


def node_spheres(low: np.ndarray, high: np.ndarray, leaf_start: np.ndarray, depth: int) -> list:
    """Compute the bounding spheres of all nodes, level by level, as in `NodeTree.spheres`.

    `low` and `high` (3, t) are corners of the triangles' boxes, in the order of the leaves.
    """
    leaves = 2**depth
    box_low, box_high = np.full((3, leaves), np.inf), np.full((3, leaves), -np.inf)
    filled = np.flatnonzero(leaf_start[1:] > leaf_start[:-1])
    if len(filled):
        box_low[:, filled] = np.minimum.reduceat(low, leaf_start[filled], axis=1)
        box_high[:, filled] = np.maximum.reduceat(high, leaf_start[filled], axis=1)
    spheres = []
    for level in range(depth, -1, -1):
        empty = box_low[0] > box_high[0]
        with np.errstate(invalid="ignore"):
            centre = np.where(empty, 0.0, 0.5 * (box_low + box_high))
            radius = np.where(empty, -np.inf, np.sqrt(((0.5 * (box_high - box_low)) ** 2).sum(axis=0)))
        spheres.append(np.concatenate((centre, radius[None])))
        if level:
            box_low = box_low.reshape(3, -1, 2).min(axis=2)
            box_high = box_high.reshape(3, -1, 2).max(axis=2)
    return spheres[::-1]
