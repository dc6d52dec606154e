"""First hits of rays with triangles: Embree names the triangle, float64 then finds the point on it."""
from __future__ import annotations

import importlib.util

import numpy as np

from core import TriangleMesh

EMBREE = importlib.util.find_spec("embreex") is not None
# A hit nearer than this part of the mesh's size is the surface that the ray starts on.
TOUCHING = 1e-7
# Surfaces that do not count and lie between the start of a ray and its first hit: of more, as where a ray leaves along
# its own triangle and Embree meets that over and over, all is asked.
PASSES = 8
RAYS_TIMES_TRIANGLES = 1_000_000


def plane_hits(mesh: TriangleMesh, triangle: np.ndarray, origins: np.ndarray,
               directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Where rays meet the planes of the triangles named.

    Parameters
    ----------
    triangle : (n,) int64
    origins, directions : (n, 3) float64

    Returns
    -------
    distance : (n,) float64
        In lengths of `directions`; not finite where the ray is parallel to the plane.
    weights : (n, 3) float64
        Barycentric coordinates, outside 0..1 where the ray misses the triangle.
    """
    a, b, c = (mesh.positions[mesh.triangles[triangle, k]] for k in range(3))
    ab, ac, start = b - a, c - a, origins - a
    normal = np.cross(ab, ac)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = -_dot(start, normal) / _dot(directions, normal)
        point = start + distance[:, None] * directions
        area = _dot(normal, normal)
        second = _dot(np.cross(point, ac), normal) / area
        third = _dot(np.cross(ab, point), normal) / area
    return distance, np.stack([1.0 - second - third, second, third], axis=1)


def first_hits(mesh: TriangleMesh, origins: np.ndarray, directions: np.ndarray, *, leaving: np.ndarray | None = None,
               embree: bool = EMBREE) -> tuple[np.ndarray, np.ndarray]:
    """The first triangle that each ray meets, seen from either side.

    Parameters
    ----------
    origins, directions : (n, 3) float64
        Directions of length one.
    leaving : (n,) int64, optional
        The triangle that the ray starts on and cannot hit. Hits must then lie inside their triangle to rounding, so
        that a neighbour is not met across the edge both share.
    embree : bool
        Embree, or brute force in NumPy.

    Returns
    -------
    triangle : (n,) int64
        -1 where the ray meets none.
    distance : (n,) float64
        Infinite where the ray meets none.
    """
    if not len(mesh.triangles) or not len(origins):
        return np.full(len(origins), -1), np.full(len(origins), np.inf)
    own = np.full(len(origins), -1) if leaving is None else leaving
    touching = TOUCHING * _size(mesh)[1]
    if not embree:
        return _brute_force(mesh, origins, directions, own, touching)
    return _embree(mesh, origins, directions, own, touching, strict=leaving is not None)


def _embree(mesh, origins, directions, own, touching, strict):
    from embreex.mesh_construction import TriangleMesh as EmbreeMesh
    from embreex.rtcore_scene import EmbreeScene

    centre, radius = _size(mesh)
    # Embree counts in float32: everything is moved to the mesh first, the start of a distant ray included.
    tree = EmbreeScene(robust=True)
    EmbreeMesh(tree, (mesh.positions - centre).astype(np.float32), mesh.triangles.astype(np.int32))
    skip = np.maximum(0.0, _dot(centre - origins, directions) - 1.01 * radius)
    triangle, distance = np.full(len(origins), -1), np.full(len(origins), np.inf)
    left = np.arange(len(origins))
    for _ in range(PASSES):
        start = origins[left] + skip[left, None] * directions[left] - centre
        found = tree.run(start.astype(np.float32), directions[left].astype(np.float32), output=True)
        hit = np.asarray(found["primID"]) >= 0
        left = left[hit]
        if not len(left):
            break
        candidate = np.asarray(found["primID"])[hit].astype(np.int64)
        along, weights = plane_hits(mesh, candidate, origins[left], directions[left])
        good = (along > touching) & (candidate != own[left])
        if strict:
            good &= weights.min(axis=1) >= -1e-9
        triangle[left[good]], distance[left[good]] = candidate[good], along[good]
        skip[left] += np.asarray(found["tfar"], dtype=np.float64)[hit] + touching
        left = left[~good]
    if len(left):
        triangle[left], distance[left] = _brute_force(mesh, origins[left], directions[left], own[left], touching)
    return triangle, distance


def _brute_force(mesh, origins, directions, own, touching):
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    ab, ac = b - a, c - a
    normal = np.cross(ab, ac)
    triangle, distance = np.full(len(origins), -1), np.full(len(origins), np.inf)
    step = max(1, RAYS_TIMES_TRIANGLES // len(mesh.triangles))
    for first in range(0, len(origins), step):
        rays = slice(first, first + step)
        direction = directions[rays, None, :]
        start = origins[rays, None, :] - a
        turned = np.cross(start, direction)
        with np.errstate(divide="ignore", invalid="ignore"):
            facing = -_dot(direction, normal)
            along = _dot(start, normal) / facing
            second, third = _dot(turned, ac) / facing, _dot(turned, -ab) / facing
            inside = (second >= 0.0) & (third >= 0.0) & (second + third <= 1.0) & (along > touching)
        inside &= np.arange(len(a)) != own[rays, None]
        along = np.where(inside, along, np.inf)
        nearest = along.argmin(axis=1)
        distance[rays] = along[np.arange(len(along)), nearest]
        triangle[rays] = np.where(np.isfinite(distance[rays]), nearest, -1)
    return triangle, distance


def _size(mesh: TriangleMesh) -> tuple[np.ndarray, float]:
    used = mesh.positions[mesh.triangles.ravel()]
    low, high = used.min(axis=0), used.max(axis=0)
    return 0.5 * (low + high), 0.5 * float(np.linalg.norm(high - low))


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)
