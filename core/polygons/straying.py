"""Deviation of drawn edges from the true reflection map, in pixels.

A drawn edge shows a point of a diffuse triangle's plane beside its true image. The offset between the point drawn and
the point truly seen there, divided by the true map's derivative, is that displacement in pixels.
"""
from __future__ import annotations

import numpy as np

from ..cameras import ALONG_UV, Cameras
from ..geometry import SceneFrames, columns, dot, falling, norm
from ..support import portions

EDGES_AT_ONCE = 32768
STRETCH = 4.0


def straying(cameras: Cameras, frames: SceneFrames, face: np.ndarray, uv: np.ndarray, column: np.ndarray,
             shown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Compare drawn points with the points that the true map shows at the same places on the mirror.

    Near a caustic the image is stretched in one direction, and a shift in that direction is invisible: `error` is at
    most `STRETCH` times the pixels that the shift would be along the least stretched direction.

    Parameters
    ----------
    face : (e,) int64, mirror face of each place
    uv : (2, e) float64, its coordinates (u, v) in that face
    column : (e,) int64, column in the `frames` of the diffuse triangle that is drawn there
    shown : (3, e) float64, point of that triangle's plane that is drawn there

    Returns
    -------
    drift : (e,) float64, pixels between the place where `shown` is drawn and its true image
    error : (e,) float64, the part of `drift` that is visible inside a face, in pixels
    point : (3, e) float64, point of the triangle's plane that is truly seen there
    s : (e,) float64, its ray parameter
    """
    parts = [_straying(cameras, frames, face[part], uv[:, part], column[part], shown[:, part])
             for part in portions(max(len(column), 1), EDGES_AT_ONCE)]
    drift, error, point, s = (np.concatenate(side, axis=-1) for side in zip(*parts))
    return drift, error, point, s


def _straying(cameras: Cameras, frames: SceneFrames, face: np.ndarray, uv: np.ndarray, column: np.ndarray,
              shown: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Compute `straying` for a portion that fits the cache."""
    mirror_map = cameras.mirror_map
    origin, ray, moves = mirror_map.linearise(face, uv, *ALONG_UV)
    base, first, second, normal = (columns(row, column) for row in
                                   (frames.origin, frames.first, frames.second, frames.normal))
    speed = falling(normal, ray)
    s = np.maximum(dot(normal, base - origin) / speed, 0.0)
    point = origin + s * ray
    moving = []
    for move, change in moves:
        free = move + s * change
        moving.append(free - dot(normal, free) / speed * ray)
    off = shown - point
    (a, c), (b, d), right = ((dot(first, along), dot(second, along)) for along in (*moving, off))
    x, y = _solve(a, b, c, d, *right)
    place = mirror_map.places(face, uv)
    gradients = cameras.view.pixel_gradients(place)
    seen_u, seen_v = (np.stack([dot(gradient, span) for gradient in gradients]) for span in mirror_map.spans(face))
    drift = np.hypot(*(x * seen_u + y * seen_v))
    motion = [norm(x * moving[0] + y * moving[1]) for x, y in
              (_solve(seen_u[0], seen_v[0], seen_u[1], seen_v[1], *step) for step in ((1.0, 0.0), (0.0, 1.0)))]
    with np.errstate(over="ignore"):
        coarse = norm(off) / np.maximum(np.maximum(*motion), 1e-300)
        return drift, np.minimum(drift, STRETCH * coarse), point, s


def _solve(a, b, c, d, right_x, right_y):
    """Solve a x + b y = right_x, c x + d y = right_y for x and y; both are zero if a, b, c and d are."""
    straight, crossed = a * d, b * c
    determinant = straight - crossed
    # a map that rounding cannot tell from singular moves far, but not infinitely far
    least = 1e-14 * (np.abs(straight) + np.abs(crossed))
    determinant = np.where(np.abs(determinant) > least, determinant, least)
    inverse = np.divide(1.0, determinant, out=np.zeros_like(determinant), where=np.abs(determinant) > 1e-150)
    return (d * right_x - b * right_y) * inverse, (a * right_y - c * right_x) * inverse
