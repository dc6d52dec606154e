"""Bounding volume hierarchy of boxes, built by binned surface areas, all nodes of a level at a time.

I. Wald, "On fast construction of SAH-based bounding volume hierarchies", IEEE Symposium on Interactive Ray Tracing
2007. Each node is cut along the widest axis of its triangles' middles, where the surface areas of the two boxes, each
times its number of triangles, are least.
"""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..geometry import TriangleMesh, areal, columns, cross, dot, ranges, rows
from ..support import breathe, portions

BINS = 12
LEAF = 8  # triangles that a leaf holds at most
FEW = 4  # triangles: as few are not split further
DEEPEST = 64
FRAMES_AT_ONCE = 32768
ROUNDING = 1e-9  # share of the tree's size: boxes are larger by this, so that no ray slips between two of them


@dataclass(frozen=True)
class BoxTree:
    """Boxes (n) around the triangles of a mesh that have an area.

    Attributes
    ----------
    middle : (3,) float64
        Of the mesh; boxes and triangles below are relative to it, which keeps their digits far from the origin.
    size : float, half the diagonal of the box around the mesh
    low, high : (3, n) float64
    child : (n,) int64, the first of a node's two children, which lie side by side; -1 for a leaf
    start, count : (n,) int64, a leaf's run in `order`
    order : (t,) int64, triangles of the mesh, leaf after leaf
    frames : (12, t) float64
        Of the triangles in that order: an affine map in which the triangle's plane is z = 0 and x and y are the
        barycentric coordinates of its second and third corner; rows x, y, z, four entries each (D. Baldwin, M. Weber,
        "Fast ray-triangle intersections by coordinate transformation", JCGT 2016).
    """

    middle: np.ndarray
    size: float
    low: np.ndarray
    high: np.ndarray
    child: np.ndarray
    start: np.ndarray
    count: np.ndarray
    order: np.ndarray
    frames: np.ndarray

    def __len__(self) -> int:
        return len(self.order)

    @classmethod
    def build(cls, mesh: TriangleMesh) -> BoxTree:
        middle, size, corners, kept = _about_middle(mesh)
        corners = corners[:, kept]
        levels, order = _levels(corners.min(axis=2), corners.max(axis=2))
        room = ROUNDING * size
        low, high, child, start, count = (np.concatenate(part, axis=-1) for part in zip(*levels))
        return cls(middle, size, low - room, high + room, child, start, count, kept[order], _frames(corners, order))

    @classmethod
    def of_one_leaf(cls, mesh: TriangleMesh) -> BoxTree:
        """Build a tree of one leaf without a box, with all triangles in their own order.

        It is for callers that find the triangles to test in another way. Frames of triangles without an area are NaN.
        """
        middle, size, corners, kept = _about_middle(mesh)
        frames = np.full((12, len(mesh.triangles)), np.nan)
        frames[:, kept] = _frames(corners, kept)
        infinite, zero, count = np.full((3, 1), np.inf), np.zeros(1, dtype=np.int64), len(mesh.triangles)
        return cls(middle, size, -infinite, infinite, zero - 1, zero, zero + count, np.arange(count), frames)


def _about_middle(mesh: TriangleMesh) -> tuple[np.ndarray, float, np.ndarray, np.ndarray]:
    """Centre a mesh at the origin.

    Returns
    -------
    middle : (3,) float64, centre of its bounding box
    size : float, half the diagonal of the box
    corners : (3, m, 3) float64, corners of the triangles relative to the centre
    kept : (k,) int64, triangles with an area
    """
    corners = rows(mesh.positions[mesh.triangles])
    used = corners.reshape(3, -1) if corners.size else np.zeros((3, 1))
    low, high = used.min(axis=1), used.max(axis=1)
    middle = 0.5 * (low + high)
    corners = corners - middle[:, None, None]
    return middle, 0.5 * float(np.linalg.norm(high - low)), corners, np.flatnonzero(areal(corners.swapaxes(1, 2)))


def _levels(low: np.ndarray, high: np.ndarray) -> tuple[list, np.ndarray]:
    """Build the tree over triangles with boxes from `low` to `high` (3, m), level by level.

    Returns
    -------
    levels : list of tuples (low, high, child, start, count), arrays of each level's nodes as in `BoxTree`
    order : (m,) int64, triangles, leaf after leaf
    """
    order = np.arange(low.shape[1])
    start, count = np.zeros(1, dtype=np.int64), np.full(1, len(order))
    nodes, levels = 1, []
    if not len(order):
        nothing = np.full((3, 1), np.inf), np.full((3, 1), -np.inf)
        return [(*nothing, np.full(1, -1), start, count)], order
    for depth in range(DEEPEST):
        breathe()
        # the boxes are those of the triangles of this level's nodes, in their order
        first = np.cumsum(count) - count
        node_low, node_high = np.minimum.reduceat(low, first, axis=1), np.maximum.reduceat(high, first, axis=1)
        left = np.zeros(len(start), dtype=np.int64)
        many = np.flatnonzero(count > FEW)
        if len(many) and depth + 1 < DEEPEST:
            if len(many) < len(count):
                part, _ = ranges(first[many], count[many])
                low, high = columns(low, part), columns(high, part)
            left[many], turn = _cut((low, high), count[many], (node_low[:, many], node_high[:, many]))
            entry, node = ranges(start[many], count[many])
            order[entry] = order[entry[turn]]
            turn = turn[left[many][node] > 0]
            low, high = columns(low, turn), columns(high, turn)
        inner = left > 0
        child = np.full(len(start), -1)
        child[inner] = nodes + 2 * np.arange(int(inner.sum()))
        levels.append((node_low, node_high, child, start, count))
        if not inner.any():
            break
        start, count, left = start[inner], count[inner], left[inner]
        start = np.stack((start, start + left), axis=1).ravel()
        count = np.stack((left, count - left), axis=1).ravel()
        nodes += len(start)
    return levels, order


def _cut(boxes: tuple[np.ndarray, np.ndarray], count: np.ndarray,
         node_boxes: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Split nodes (n) by the surface area heuristic, along the axis on which their triangles' centres spread most.

    Parameters
    ----------
    boxes : two (3, m) float64, low and high corners of the triangles' boxes, node after node
    count : (n,) int64, triangles of each node
    node_boxes : two (3, n) float64, low and high corners of the nodes' boxes

    Returns
    -------
    left : (n,) int64, number of triangles in the left child, 0 for a leaf
    turn : (m,) int64, order that sorts the boxes of each node along its axis
    """
    (low, high), (node_low, node_high) = boxes, node_boxes
    first, nodes = np.cumsum(count) - count, np.arange(len(count))
    node = np.repeat(nodes, count)
    centre = low + high
    least, most = np.minimum.reduceat(centre, first, axis=1), np.maximum.reduceat(centre, first, axis=1)
    axis = np.argmax(most - least, axis=0)
    begin, width = least[axis, nodes], (most - least)[axis, nodes]
    along = centre[axis[node], np.arange(len(node))]
    del centre
    bin_ = np.floor(BINS * (along - begin[node]) / np.where(width > 0.0, width, 1.0)[node]).astype(np.int64)
    key = node * BINS + np.minimum(bin_, BINS - 1)
    del along, bin_, node
    turn = np.argsort(key, kind="stable")
    held = np.bincount(key, minlength=len(first) * BINS)
    full = np.flatnonzero(held)
    at = np.cumsum(held)[full] - held[full]
    bin_low, bin_high = np.full((3, len(held)), np.inf), np.full((3, len(held)), -np.inf)
    bin_low[:, full] = np.minimum.reduceat(columns(low, turn), at, axis=1)
    bin_high[:, full] = np.maximum.reduceat(columns(high, turn), at, axis=1)
    shape = (3, -1, BINS)
    bin_low, bin_high, held = bin_low.reshape(shape), bin_high.reshape(shape), held.reshape(-1, BINS)
    before = np.cumsum(held, axis=1)[:, :-1]
    cost = before * _area(np.minimum.accumulate(bin_low, axis=2)[:, :, :-1],
                          np.maximum.accumulate(bin_high, axis=2)[:, :, :-1])
    cost = cost + (count[:, None] - before) * _area(
        np.minimum.accumulate(bin_low[:, :, ::-1], axis=2)[:, :, -2::-1],
        np.maximum.accumulate(bin_high[:, :, ::-1], axis=2)[:, :, -2::-1])
    cost = np.where((before > 0) & (before < count[:, None]), cost, np.inf)
    best = np.argmin(cost, axis=1)
    left, cost = before[nodes, best], cost[nodes, best]
    # if all centres are one point no plane separates them: split into halves
    left = np.where(np.isfinite(cost), left, count // 2)
    worth = cost + _area(node_low, node_high) < count * _area(node_low, node_high)
    left[(count <= LEAF) & ~worth] = 0
    return left, turn


def _area(low: np.ndarray, high: np.ndarray) -> np.ndarray:
    x, y, z = np.maximum(high - low, 0.0)
    return x * y + y * z + z * x


def _frames(corners: np.ndarray, order: np.ndarray) -> np.ndarray:
    """Return the frames (12, t) of the triangles `order` (t,), of all with `corners` (3, m, 3)."""
    frames = np.empty((12, len(order)))
    for part in portions(len(order), FRAMES_AT_ONCE):
        own = corners[:, order[part]]
        corner, u, v = own[:, :, 0], own[:, :, 1] - own[:, :, 0], own[:, :, 2] - own[:, :, 0]
        normal = cross(u, v)
        area = dot(normal, normal)
        ways = cross(v, normal) / area, cross(normal, u) / area, normal / np.sqrt(area)
        frames[:, part] = np.concatenate([row for way in ways for row in (way, -dot(way, corner)[None])])
    return frames
