"""A ray for each block of k x k pixels, with interpolation inside blocks whose four corners meet one triangle.

T. Whitted's adaptive sampling (CACM 1980) the other way round: not more rays than pixels where the picture is busy, but
fewer where it is not.
"""
from __future__ import annotations

from collections.abc import Callable

import numpy as np

from .primary_hits import PrimaryHits
from .rival_picture import ITSELF, NOTHING

Cast = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


def cast_by_blocks(hits: PrimaryHits, block: int, cast: Cast) -> tuple[np.ndarray, np.ndarray]:
    """Trace one ray per block of pixels, and interpolate or trace the others (n rays of the primary hits in all).

    Parameters
    ----------
    block : int
        Pixels along the side of a block; 1 traces every ray.
    cast : callable
        Takes indices (m,) of rays; returns the triangle (m,) that each meets, and the point (3, m).

    Returns
    -------
    triangle : (n,) int64, position : (3, n) float64
    """
    count = len(hits.pixel)
    if block <= 1:
        return cast(np.arange(count))
    height, width = hits.mirror_depth.shape
    ray_of = np.full(width * height, -1)
    ray_of[hits.pixel] = np.arange(count)
    x, y = hits.pixel % width, hits.pixel // width
    sampled = (x % block == 0) & (y % block == 0)
    triangle, position = np.full(count, NOTHING), np.zeros((3, count))
    first = np.flatnonzero(sampled)
    triangle[first], position[:, first] = cast(first)

    between = np.flatnonzero(~sampled)
    left, bottom = x[between] // block * block, y[between] // block * block
    inside = (left + block < width) & (bottom + block < height)
    corners = np.stack([np.where(inside, ray_of[np.where(inside, (bottom + up) * width + left + right, 0)], -1)
                        for up in (0, block) for right in (0, block)])
    met = np.where(corners >= 0, triangle[corners], ITSELF)
    # a mirror that is seen in itself has no position to interpolate
    same = (met == met[0]).all(axis=0) & (met[0] != ITSELF) & (corners >= 0).all(axis=0)
    ray, corners = between[same], corners[:, same]
    triangle[ray] = met[0, same]
    across, upward = (x[between] - left)[same] / block, (y[between] - bottom)[same] / block
    weights = ((1.0 - across) * (1.0 - upward), across * (1.0 - upward), (1.0 - across) * upward, across * upward)
    position[:, ray] = sum(weight * position[:, corner] for weight, corner in zip(weights, corners))
    rest = between[~same]
    triangle[rest], position[:, rest] = cast(rest)
    return triangle, position
