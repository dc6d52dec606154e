"""Shapes of discs, which represent in the picture the diffuse surface around one vertex.

The true map takes a small circle on the diffuse surface to an ellipse in the picture: its inverse derivative is the
local magnification. The disc fills that ellipse. It is parallel to the mirror's triangle and moves towards the eye with
its centre, so that no part of it lies behind the mirror and layers keep the order of their paths.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm, unit
from ..views import View

SMALLEST = 0.75  # pixels: a disc with a radius of half a pixel's diagonal covers a pixel centre wherever it lies
LARGEST = 16.0  # pixels: largest half axis of a disc
MAGNIFIED = 16.0  # largest magnification relative to a mirror without focusing: near a caustic the linear map fails
LEAST_FALL = 0.25  # smallest sine between a ray and a surface: vertex normals at sharp edges are not reliable
STEEPEST = 8.0  # largest depth of a disc along the view direction, in multiples of its visible half axis


def picture_ellipses(view: View, seen: tuple, s: np.ndarray, normal: np.ndarray,
                     reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the images of circles around diffuse points, as half axes in pixels.

    Parameters
    ----------
    seen : tuple, result of `MirrorMap.linearise` along `ALONG_UV` at the images of the centres
    s : (n,) float64, distances of the centres along the rays
    normal : (3, n) float64, unit normal of the circle's plane; zero for circles that face the ray
    reach : (n,) float64, radius of the circle, in scene units

    Returns
    -------
    axes : (2, 2, n) float64
        Perpendicular half axes as [x or y, longer or shorter], with lengths between `SMALLEST` and `LARGEST`.
    wanted : (n,) float64, length of the longer half axis before clamping
    """
    place, ray, moves = seen
    (a, b), (c, d) = ([dot(gradient, move) for move, _ in moves] for gradient in view.pixel_gradients(place))
    area = a * d - b * c
    area = np.where(np.abs(area) > 1e-14 * (np.abs(a * d) + np.abs(b * c)) + 1e-150, area, 1e-150)
    # moves in (u, v) by one pixel to the right and by one pixel up
    ways = (d / area, -c / area), (-b / area, a / area)
    ahead = unit(ray)
    normal = np.where(dot(normal, normal) > 0.0, normal, ahead)
    fall = dot(normal, ahead)
    fall = np.copysign(np.maximum(np.abs(fall), LEAST_FALL), fall)
    across = []
    for still, moving in moves:
        free = still + s * moving
        across.append(free - dot(normal, free) / fall * ahead)
    with np.errstate(over="ignore", invalid="ignore"):
        uu, uv, vv = dot(across[0], across[0]), dot(across[0], across[1]), dot(across[1], across[1])
        (x, y), (z, w) = ways
        gram = np.nan_to_num([x * (x * uu + 2.0 * y * uv) + y * y * vv, x * (z * uu + w * uv) + y * (z * uv + w * vv),
                              z * (z * uu + 2.0 * w * uv) + w * w * vv], posinf=1e300, neginf=-1e300)
        direction, motion = _principal(gram)
        # near a caustic the motion of the ray's origin and of its direction cancel: bound the magnification
        u, v = (direction[0, 0] * right + direction[1, 0] * up for right, up in zip(*ways))
        still, moving = (u * moves[0][k] + v * moves[1][k] for k in (0, 1))
        apart = sum(norm(part - dot(part, ahead) * ahead) for part in (still, s * moving))
        motion[0] = np.maximum(motion[0], apart / MAGNIFIED)
        length = reach / np.maximum(motion, 1e-300)
    wanted = length.max(axis=0)
    return direction * np.clip(length, SMALLEST, LARGEST), wanted


def flat_discs(view: View, axes: np.ndarray, slope: np.ndarray | None,
               positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute discs in space that look like given ellipses from the eye.

    Parameters
    ----------
    axes : (2, 2, n) float64, from `picture_ellipses`
    slope : (3, n) float64 or None, normals of the discs' planes; None for discs that face the eye
    positions : (3, n) float64, centres of the discs in world space

    Returns
    -------
    axes : (n, 2, 3) float64, half axes in world space
    radius : (n,) float64, longer half axis perpendicular to the view direction, in scene units
    """
    ahead = unit(view.directions(positions.T).T)
    depth = 1.0 if view.orthographic else view.depths(positions.T)
    rotation, (width, height) = view.camera_to_world[:3, :3], view.resolution
    right = 2.0 / (width * view.projection[0, 0]) * rotation[:, :1]
    up = 2.0 / (height * view.projection[1, 1]) * rotation[:, 1:2]
    facing = [depth * (right * axes[0, k] + up * axes[1, k]) for k in (0, 1)]
    radius = np.maximum(norm(facing[0]), norm(facing[1]))
    if slope is not None:
        upright = dot(slope, ahead)
        upright = np.where(np.abs(upright) > 1e-12, upright, 1e-12)
        tilted = []
        for axis in facing:
            sideways = dot(axis, ahead)
            forth = -dot(slope, axis) / upright + sideways
            most = STEEPEST * norm(axis)
            tilted.append(axis + (np.clip(forth, -most, most) - sideways) * ahead)
        facing = tilted
    first, second = facing
    direction, _ = _principal(np.stack((dot(first, first), dot(first, second), dot(second, second))))
    found = [x * first + y * second for x, y in (direction[:, 1], direction[:, 0])]
    return np.stack(found).transpose(2, 0, 1), radius


def _principal(gram: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute the eigenvectors of symmetric 2 x 2 matrices, and the square roots of their eigenvalues.

    `gram` (3, n) holds the entries 00, 01 and 11. Return unit eigenvectors (2, 2, n) as [x or y, smaller or larger
    eigenvalue], and the roots (2, n).
    """
    half, off = 0.5 * (gram[0] - gram[2]), gram[1]
    spread = np.hypot(half, off)
    # half-angle formulas for the angle with cosine half / spread and sine off / spread
    some = np.maximum(spread, 1e-300)
    longer = np.sqrt(0.5 + 0.5 * np.where(spread > 0.0, np.abs(half) / some, 1.0))
    shorter = 0.5 * np.abs(off) / (some * longer)
    x, y = np.where(half < 0.0, (shorter, longer), (longer, shorter))
    y = np.copysign(y, off)
    direction = np.stack((np.stack((-y, x)), np.stack((x, y))))
    middle = 0.5 * (gram[0] + gram[2])
    larger = middle + spread
    # compute the smaller eigenvalue from the determinant, to avoid cancellation
    determinant = gram[0] * gram[2] - off * off
    smaller = np.divide(determinant, larger, out=np.zeros_like(larger), where=larger > 0.0)
    return direction, np.sqrt(np.maximum(np.stack((smaller, larger)), 0.0))
