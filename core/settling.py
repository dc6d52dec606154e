"""Images settled on the mirror triangle that they truly lie on.

Newton's method knows one triangle's map, which goes on beyond its edges. An image that ends outside is looked for again
on the triangle across the edge that it left by; where there is none, it lies beside the mirror and is no image.
"""
from __future__ import annotations

import numpy as np

from .mirror_map import MirrorMap
from .subdivision import shared_edges
from .triangle_mesh import TriangleMesh

STEPS = 6
INSIDE = 1e-9  # of a triangle: rounding
BETWEEN = 1e-3  # of a triangle: what two triangles may each leave to the other at their edge


def neighbours(mirror: TriangleMesh) -> np.ndarray:
    """Triangle (m, 3) across the edge opposite to each corner; -1 where there is none, or more than one."""
    _, vertex = np.unique(mirror.positions, axis=0, return_inverse=True)
    _, _, edge = shared_edges(vertex.reshape(-1)[mirror.triangles])
    edge = edge.reshape(-1)
    order = np.argsort(edge, kind="stable")
    count = np.bincount(edge)
    first = (np.cumsum(count) - count)[count == 2]
    result = np.full(len(edge), -1)
    one, other = order[first], order[first + 1]
    result[one], result[other] = other // 3, one // 3
    # side k runs from corner k to the next: it lies opposite to the corner before
    return np.roll(result.reshape(-1, 3), -1, axis=1)


def settle(mirror_map: MirrorMap, across: np.ndarray, face: np.ndarray, uv: np.ndarray, s: np.ndarray,
           points: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Faces, places (u, v) and s of the images of `points` (3, n), and which of them are images at all."""
    face, uv, s = face.copy(), uv.copy(), s.copy()
    found = np.zeros(len(face), dtype=bool)
    least, corner = _outside(uv)
    found[least >= -INSIDE] = True
    wandering = np.flatnonzero(~found)
    came_from, before = np.full(len(face), -1), least
    for _ in range(STEPS):
        following = across[face[wandering], corner[wandering]]
        # left by either of two triangles to the other: on their edge, where the map has a kink
        back = (following == came_from[wandering]) & (np.minimum(least, before)[wandering] > -BETWEEN)
        found[wandering[back]] = True
        going = (following >= 0) & ~back
        wandering, following = wandering[going], following[going]
        if not len(wandering):
            break
        place = mirror_map.places(face[wandering], uv[:, wandering])
        came_from[wandering], before[wandering] = face[wandering], least[wandering]
        face[wandering] = following
        target = points[:, wandering]
        uv[:, wandering], s[wandering] = mirror_map.locate(following, mirror_map.coordinates(following, place),
                                                           s[wandering], target)
        least[wandering], corner[wandering] = _outside(uv[:, wandering])
        arrived = mirror_map.meets(following, uv[:, wandering], s[wandering], target)
        found[wandering[arrived & (least[wandering] >= -INSIDE)]] = True
        wandering = wandering[arrived & (least[wandering] < -INSIDE)]
    return face, uv, s, found


def _outside(uv: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The least barycentric coordinate (n,), and its corner."""
    weights = np.stack((1.0 - uv[0] - uv[1], uv[0], uv[1]))
    corner = np.argmin(weights, axis=0)
    return weights[corner, np.arange(len(corner))], corner
