"""Which triangles lie beyond each other's sides, told by place: flat faces may have vertices of their own."""
from __future__ import annotations

import numpy as np

from .distinct import in_order
from .subdivision import shared_edges
from .triangle_mesh import TriangleMesh


def neighbours(mesh: TriangleMesh) -> np.ndarray:
    """Triangle (m, 3) across the side opposite to each corner; -1 where there is none, or more than one."""
    return _corners_beyond(mesh) // 3


def opposite_corners(mesh: TriangleMesh) -> np.ndarray:
    """(m, 3, 3): the vertex beyond the side opposite to each corner; not a number where there is no triangle, or more
    than one."""
    beyond = _corners_beyond(mesh)
    return np.where(beyond[:, :, None] >= 0, mesh.positions[mesh.triangles.ravel()[beyond]], np.nan)


def _corners_beyond(mesh: TriangleMesh) -> np.ndarray:
    """As `corners_beyond`, of vertices that lie in one place as if they were one."""
    _, vertex = np.unique(mesh.positions, axis=0, return_inverse=True)
    return corners_beyond(vertex.reshape(-1)[mesh.triangles])


def corners_beyond(triangles: np.ndarray) -> np.ndarray:
    """For each corner of triangles (m, 3) the one beyond the opposite side, an entry of the flattened triangles, or -1
    where there is none, or more than one."""
    _, _, edge = shared_edges(triangles)
    # edge k runs from corner k to the next; the side opposite to corner j is edge j + 1
    edge = edge[:, [1, 2, 0]].ravel()
    order = in_order(edge)
    one, other = order[np.bincount(edge)[edge[order]] == 2].reshape(-1, 2).T
    beyond = np.full(len(edge), -1)
    beyond[one], beyond[other] = other, one
    return beyond.reshape(-1, 3)


def connected(triangles: np.ndarray) -> np.ndarray:
    """(m,) int64: triangles (m, 3) that hang together by shared vertices have the same number, from 0 on."""
    part = np.arange(int(triangles.max(initial=-1)) + 1)
    while True:
        # the lowest number of a triangle's corners spreads to all three, then each number's own number is followed
        low = part[triangles].min(axis=1)
        lower = part.copy()
        np.minimum.at(lower, triangles.ravel(), np.repeat(low, 3))
        np.minimum.at(lower, part[triangles].ravel(), np.repeat(low, 3))
        lower = lower[lower]
        if (lower == part).all():
            return np.unique(part[triangles[:, 0]], return_inverse=True)[1].reshape(-1)
        part = lower
