"""Discs: what stands in the picture for a piece of the diffuse surface round one of its vertices.

The true map takes a small circle on the diffuse surface to an ellipse in the picture: its inverse derivative is the
local magnification. The disc fills that ellipse, flat on the mirror's triangle and slid with its middle, so that no
part of it sinks behind the mirror and layers stay in the order of their paths.
"""
from __future__ import annotations

import numpy as np

from ..geometry import dot, norm, unit
from ..views import View

SMALLEST = 0.75  # pixels: a disc of half a pixel's diagonal holds the middle of a pixel wherever it lies
LARGEST = 16.0  # pixels: no disc stands for more
MAGNIFIED = 16.0  # times what the mirror would show without focusing; more is close to a caustic, where maps bend
LEAST_FALL = 0.25  # sine at which a ray meets a surface at least: at an edge of it the vertex has but one normal
STEEPEST = 8.0  # depth over breadth of a disc, as the eye sees it


def picture_ellipses(view: View, seen: tuple, s: np.ndarray, normal: np.ndarray,
                     reach: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Images of circles round diffuse points, as half axes in pixels.

    Parameters
    ----------
    seen : tuple, what `MirrorMap.linearise` tells along `ALONG_UV` where on the mirror the middles are seen
    s : (n,) float64, how far along the rays they lie
    normal : (3, n) float64, unit normal of the circle's plane; zero where it faces the ray
    reach : (n,) float64, radius of the circle, in scene units

    Returns
    -------
    axes : (2, 2, n) float64, [x or y, longer or shorter], at right angles, between `SMALLEST` and `LARGEST`
    wanted : (n,) float64, length of the longer one without the bound above
    """
    place, ray, moves = seen
    (a, b), (c, d) = ([dot(gradient, move) for move, _ in moves] for gradient in view.pixel_gradients(place))
    area = a * d - b * c
    area = np.where(np.abs(area) > 1e-14 * (np.abs(a * d) + np.abs(b * c)) + 1e-150, area, 1e-150)
    # a pixel to the right and one up, in (u, v)
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
        # near a caustic what the mirror's place and its ray's turning move the point by cancel
        u, v = (direction[0, 0] * right + direction[1, 0] * up for right, up in zip(*ways))
        still, moving = (u * moves[0][k] + v * moves[1][k] for k in (0, 1))
        apart = sum(norm(part - dot(part, ahead) * ahead) for part in (still, s * moving))
        motion[0] = np.maximum(motion[0], apart / MAGNIFIED)
        length = reach / np.maximum(motion, 1e-300)
    wanted = length.max(axis=0)
    return direction * np.clip(length, SMALLEST, LARGEST), wanted


def flat_discs(view: View, axes: np.ndarray, slope: np.ndarray | None,
               positions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Discs in space that look from the eye like ellipses.

    Parameters
    ----------
    axes : (2, 2, n) float64, from `picture_ellipses`
    slope : (3, n) float64 or None, normals of the planes to lie in; None for discs that face the eye
    positions : (3, n) float64, where the middles of the ellipses are drawn

    Returns
    -------
    axes : (n, 2, 3) float64
    radius : (n,) float64, the longer half axis as the eye sees it
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
    """Of symmetric 2 x 2 matrices by their entries 00, 01, 11: unit eigenvectors (2, 2, n) as [x or y, which], that of
    the smaller eigenvalue first, and the roots (2, n) of the eigenvalues."""
    half, off = 0.5 * (gram[0] - gram[2]), gram[1]
    spread = np.hypot(half, off)
    # half the angle whose cosine and sine are half and off over spread
    some = np.maximum(spread, 1e-300)
    longer = np.sqrt(0.5 + 0.5 * np.where(spread > 0.0, np.abs(half) / some, 1.0))
    shorter = 0.5 * np.abs(off) / (some * longer)
    x, y = np.where(half < 0.0, (shorter, longer), (longer, shorter))
    y = np.copysign(y, off)
    direction = np.stack((np.stack((-y, x)), np.stack((x, y))))
    middle = 0.5 * (gram[0] + gram[2])
    larger = middle + spread
    # the product of both is the determinant, which keeps its digits where the smaller one cancels
    determinant = gram[0] * gram[2] - off * off
    smaller = np.divide(determinant, larger, out=np.zeros_like(larger), where=larger > 0.0)
    return direction, np.sqrt(np.maximum(np.stack((smaller, larger)), 0.0))
