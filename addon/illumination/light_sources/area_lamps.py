"""Area lamps as Cycles' rays meet them, also those that are sheared, and places that are spread evenly.

The lamp lies across its own -z, within half its size along its x and its y (`area_light_intersect` of Cycles'
kernel). Of one that is sheared, where these are not at right angles, that is another shape than its corners tell:
mirrors show it so, and Cycles' own caustics are of it.
"""
from __future__ import annotations

import bpy
import numpy as np

SPREAD_LEAST = 1e-3  # radians: narrower area lamps are taken for as wide
SHEARED = 1e-2  # cosine of two axes of a lamp: with more of it they are not at right angles


def is_sheared(lamp: bpy.types.Object) -> bool:
    """Return True for an area lamp whose axes are not at right angles. Cycles' samples of such a lamp fit no shape, and
    its direct light differs from what its rays meet.
    """
    if lamp.type != "LIGHT" or lamp.data.type != "AREA":
        return False
    axes = np.array(lamp.matrix_world, dtype=np.float64)[:3, :3]
    axes = axes / np.maximum(np.linalg.norm(axes, axis=0), 1e-300)
    return bool(np.abs(axes.T @ axes - np.diag((axes**2).sum(axis=0))).max() > SHEARED)


def across_area(data: bpy.types.AreaLight, axes: np.ndarray, scale: np.ndarray,
                count: int) -> tuple[np.ndarray, float]:
    """Return points (count, 3) on an area lamp relative to its middle, and the area that Cycles assumes for it. `axes`
    (3, 3) are its unit axes as columns, `scale` (3,) the scale along them.
    """
    size = np.array((data.size, data.size_y if data.shape in {"RECTANGLE", "ELLIPSE"} else data.size)) * scale[:2]
    is_round = data.shape in {"DISK", "ELLIPSE"}
    spots = 0.5 * disc(count) if is_round else _square(count)
    return (spots * size) @ np.linalg.inv(axes)[:2], size.prod() * (np.pi / 4.0 if is_round else 1.0)


def rays_meet(axes: np.ndarray) -> float:
    """Return the ratio, at least 1, of the area in which rays meet an area lamp to the area that Cycles assumes for it.

    Both are equal unless the lamp is sheared. Of a rectangle, Cycles assumes the product of the side lengths. Rays meet
    all points in the plane perpendicular to its z axis whose distances from the middle, measured along the unit axes x
    and y by scalar products, are at most half of these lengths.

    Parameters
    ----------
    axes : (3, 3) float64
        Unit axes x, y and z of the lamp in world space, as columns.
    """
    return 1.0 / abs(np.linalg.det(axes))


def spread_of(spread: float) -> tuple[float, float]:
    """Return the cotangent of half an area lamp's spread, and the factor that restores its power."""
    half = 0.5 * max(float(spread), SPREAD_LEAST)
    if half >= 0.5 * np.pi - 1e-6:
        return 0.0, 1.0
    # so that the power stays what it is (`AreaLight` in Cycles' scene/light.cpp)
    return 1.0 / np.tan(half), np.tan(half) / max(np.tan(half) - half, 1e-12)


def disc(count: int) -> np.ndarray:
    """Return points (count, 2) spread evenly over the unit disc, by the golden angle; the middle if count is 1."""
    number = np.arange(count)
    radius, angle = np.sqrt((number + 0.5) / count) * (count > 1), number * np.pi * (3.0 - np.sqrt(5.0))
    return np.stack((radius * np.cos(angle), radius * np.sin(angle)), axis=1)


def _square(count: int) -> np.ndarray:
    """Return points (count, 2) spread evenly over the square from -1/2 to 1/2, a rank-1 lattice."""
    number = np.arange(count)
    return np.stack((((number + 0.5) / count) - 0.5, (number * 0.6180339887498949 + 0.5) % 1.0 - 0.5), axis=1)
