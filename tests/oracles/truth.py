"""What a ray tracer sees in the mirror, at every pixel's centre: the truth that reflection meshes are judged by."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core import TriangleMesh, View
from tests.oracles.ray_hits import EMBREE, _dot, first_hits, plane_hits


@dataclass(frozen=True)
class Truth:
    """What each pixel shows; pixels run along the rows from the lower left corner, n = width x height.

    Attributes
    ----------
    mirror_triangle : (n,) int64
        The mirror's triangle that the eye sees, -1 where it sees none or the diffuse scene stands before it.
    mirror_position : (n, 3) float64
        Q on the mirror; zero where no mirror is seen, like `direction`.
    direction : (n, 3) float64
        Unit reflected direction.
    source_triangle : (n,) int64
        The diffuse triangle that the reflected ray meets first, -1 where it meets none or none is asked for.
    position : (n, 3) float64
        P on it, zero where none.
    path_length : (n,) float64
        |P - Q|, infinite where none.
    sees_itself : (n,) bool
        The reflected ray meets the mirror again before the scene.
    bent : (n,) bool
        Cycles would bend the normal here, since the reflected ray would enter the flat triangle.
    jacobian : (n, 3, 2) float64
        Motion of P along its triangle's plane for one pixel to the right and one up.
    motion : (n,) float64
        The larger length of the two, in scene units a pixel.
    mirror_depth, scene_depth : (n,) float64
        Distances from the eye's plane of the mirror and of the diffuse scene as seen without a mirror, infinite
        where the ray meets none.
    resolution : (width, height)
    """

    mirror_triangle: np.ndarray
    mirror_position: np.ndarray
    direction: np.ndarray
    source_triangle: np.ndarray
    position: np.ndarray
    path_length: np.ndarray
    sees_itself: np.ndarray
    bent: np.ndarray
    jacobian: np.ndarray
    motion: np.ndarray
    mirror_depth: np.ndarray
    scene_depth: np.ndarray
    resolution: tuple[int, int]


def reflected_rays(mirror: TriangleMesh, triangle: np.ndarray, origins: np.ndarray,
                   directions: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The mirror of Cycles: Q on the flat triangle, the ray about the normalised interpolated normal.

    Parameters
    ----------
    triangle : (n,) int64
        The mirror's triangle of each ray; its plane and normals go on beyond its edges.
    origins, directions : (n, 3) float64
        Rays from the eye, directions of length one.

    Returns
    -------
    mirror_position : (n, 3)
    reflected : (n, 3)
        Unit directions.
    weights : (n, 3)
        Barycentric coordinates of Q.
    """
    distance, weights = plane_hits(mirror, triangle, origins, directions)
    normal = np.einsum("nk,nkx->nx", weights, mirror.corner_normals[triangle])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    reflected = directions - 2.0 * _dot(directions, normal)[:, None] * normal
    return origins + distance[:, None] * directions, reflected, weights


def trace(view: View, mirror: TriangleMesh, scene: TriangleMesh, *, embree: bool = EMBREE) -> Truth:
    """Ray trace the reflection of `scene` in `mirror` at every pixel's centre, one bounce, no anti-aliasing."""
    width, height = view.resolution
    pixels = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1).reshape(-1, 2)
    origins, directions = view.rays(pixels)
    along = directions @ view.forward
    mirror_triangle, mirror_distance = first_hits(mirror, origins, directions, embree=embree)
    _, scene_distance = first_hits(scene, origins, directions, embree=embree)
    mirror_triangle = np.where(mirror_distance < scene_distance, mirror_triangle, -1)

    seen = np.flatnonzero(mirror_triangle >= 0)
    triangle = mirror_triangle[seen]
    q, reflected, _ = reflected_rays(mirror, triangle, origins[seen], directions[seen])
    source, length = first_hits(scene, q, reflected, embree=embree)
    _, again = first_hits(mirror, q, reflected, leaving=triangle, embree=embree)
    to_eye, flat = -directions[seen], mirror.face_normals()[triangle]
    flat = np.where(_dot(flat, to_eye)[:, None] < 0.0, -flat, flat)
    bent = _dot(reflected, flat) < np.minimum(0.9 * _dot(flat, to_eye), 0.01)

    met = np.flatnonzero(source >= 0)
    position = np.zeros_like(q)
    position[met] = q[met] + length[met, None] * reflected[met]
    jacobian = np.zeros((len(seen), 3, 2))
    jacobian[met] = _jacobian(view, mirror, scene, pixels[seen[met]], triangle[met], source[met])
    return Truth(
        mirror_triangle=mirror_triangle, mirror_position=_spread(q, seen, len(pixels), 0.0),
        direction=_spread(reflected, seen, len(pixels), 0.0),
        source_triangle=_spread(source, seen, len(pixels), -1), position=_spread(position, seen, len(pixels), 0.0),
        path_length=_spread(length, seen, len(pixels), np.inf),
        sees_itself=_spread(again < length, seen, len(pixels), False), bent=_spread(bent, seen, len(pixels), False),
        jacobian=_spread(jacobian, seen, len(pixels), 0.0),
        motion=_spread(np.linalg.norm(jacobian, axis=1).max(axis=1), seen, len(pixels), 0.0),
        mirror_depth=mirror_distance * along, scene_depth=scene_distance * along, resolution=view.resolution)


def _jacobian(view, mirror, scene, pixels, triangle, source):
    columns = [_motion(view, (mirror, triangle), (scene, source), pixels, np.array(step)) for step in ((1, 0), (0, 1))]
    return np.stack(columns, axis=2)


def _motion(view, mirror_seen, scene_seen, pixels, step):
    """Motion of P from half a pixel before to half a pixel behind, or the derivative where that passes a horizon."""
    (mirror, triangle), (scene, source) = mirror_seen, scene_seen
    motion = np.zeros((len(pixels), 3))
    left = np.arange(len(pixels))
    for half in (0.5, 0.5e-3):
        ends, in_front = [], np.ones(len(left), dtype=bool)
        for side in (-half, half):
            origins, directions = view.rays(pixels[left] + side * step)
            q, reflected, _ = reflected_rays(mirror, triangle[left], origins, directions)
            length, _ = plane_hits(scene, source[left], q, reflected)
            ends.append(q + length[:, None] * reflected)
            in_front &= length > 0.0
        motion[left] = (ends[1] - ends[0]) / (2.0 * half)
        left = left[~in_front]
    return motion


def _spread(values: np.ndarray, where: np.ndarray, count: int, empty) -> np.ndarray:
    spread = np.full((count, *values.shape[1:]), empty, dtype=values.dtype)
    spread[where] = values
    return spread
