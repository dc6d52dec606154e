"""What a ray tracer sees after several bounces from mirror to mirror: truth for mirrors in mirrors."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from core import TriangleMesh, View
from tests.oracles.ray_hits import first_hits
from tests.oracles.truth import reflected_rays

OFF = 0.02  # pixels between the rays whose difference tells the motion per pixel


@dataclass(frozen=True)
class BouncedTruth:
    """What each pixel shows, rows from the lower left corner, n = width x height.

    Attributes
    ----------
    seen : (n,) bool
        The pixel shows the mirror asked for.
    bounces : (n,) int64
        How many mirrors the ray met; it ended there, or met more than it was allowed to.
    source : (n,) int64
        The diffuse triangle it met, -1 where none, -2 where it met a mirror once too often.
    position : (n, 3) float64
        Where it met that.
    path_length : (n,) float64
        From the first mirror on; infinite where it met nothing.
    bent : (n,) bool
        Some mirror on the way bends its normal, as Cycles does where a ray would enter the flat triangle.
    motion : (n,) float64
        Of the position for one pixel, in scene units; not a number where neighbouring rays meet another triangle.
    """

    seen: np.ndarray
    bounces: np.ndarray
    source: np.ndarray
    position: np.ndarray
    path_length: np.ndarray
    bent: np.ndarray
    motion: np.ndarray


def trace_bounces(view: View, mirror: TriangleMesh, scene: TriangleMesh, mirrors: TriangleMesh,
                  depth: int) -> BouncedTruth:
    """Ray trace up to `depth` bounces at every pixel's centre; `mirrors` are all that reflect, `mirror` among them."""
    width, height = view.resolution
    pixels = np.stack(np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5), axis=-1).reshape(-1, 2)
    truth = _trace(view, mirror, scene, mirrors, depth, pixels)
    motion = np.zeros(len(pixels))
    for step in ((OFF, 0.0), (0.0, OFF)):
        ends = [_trace(view, mirror, scene, mirrors, depth, pixels + sign * np.array(step)) for sign in (-0.5, 0.5)]
        moved = np.linalg.norm(ends[1][3] - ends[0][3], axis=1) / OFF
        same = (ends[0][2] == truth[2]) & (ends[1][2] == truth[2]) & (ends[0][1] == truth[1]) & (ends[1][1] == truth[1])
        motion = np.maximum(motion, np.where(same, moved, np.nan))
    return BouncedTruth(*truth, motion)


def _trace(view, mirror, scene, mirrors, depth, pixels):
    everything = TriangleMesh.joined([scene, mirrors])
    count, diffuse = len(pixels), len(scene.triangles)
    origin, direction = view.rays(pixels)
    first, distance = first_hits(mirror, origin, direction)
    met, nearest = first_hits(everything, origin, direction)
    size = np.ptp(everything.positions, axis=0).max()
    seen = (first >= 0) & ((met < 0) | (distance < nearest + 1e-9 * size))
    bounces, source = np.zeros(count, dtype=np.int64), np.full(count, -1)
    position, path, bent = np.zeros((count, 3)), np.zeros(count), np.zeros(count, dtype=bool)
    ray, surface, triangle = np.flatnonzero(seen), mirror, first[seen]
    origin, direction = origin[seen], direction[seen]
    for _ in range(depth):
        direction_in = direction
        place, direction, _ = reflected_rays(surface, triangle, origin, direction_in)
        bounces[ray] += 1
        flat = surface.face_normals()[triangle]
        facing = -(flat * direction_in).sum(axis=1)
        rise = (flat * direction).sum(axis=1) * np.sign(facing)
        bent[ray] |= rise < np.minimum(0.9 * np.abs(facing), 0.01)
        if surface is mirror:
            # the mirror's triangle under the name that it has among all
            own, _ = first_hits(mirrors, origin, direction_in)
        else:
            own = triangle
        met, distance = first_hits(everything, place, direction, leaving=own + diffuse)
        hit = met >= 0
        path[ray] += np.where(hit, distance, np.inf)
        arrived = place + np.where(hit, distance, 0.0)[:, None] * direction
        position[ray[hit]] = arrived[hit]
        source[ray] = np.where(met >= diffuse, -2, met)
        on = met >= diffuse
        ray, origin, direction, triangle, surface = ray[on], place[on], direction[on], met[on] - diffuse, mirrors
        if not len(ray):
            break
    return seen, bounces, source, position, path, bent
