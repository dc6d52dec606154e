"""Point and spot lamps as places in a ball, as much of which is seen across every way.

Cycles takes such a lamp for a ball that is as bright everywhere, or, with a soft falloff, for a disc that faces each
place that it lights (`point_light_intersect` of its kernel). A disc that faces one part of a mirror alone is seen from
the side by another. Places in the ball of the density 1 / sqrt(r^2 - s^2), at s from the middle, cover a disc evenly as
seen from anywhere, and light whatever lies outside as its middle does, as all balls do whose density goes by s alone.
"""
from __future__ import annotations

import bpy
import numpy as np

from .area_lamps import disc

GOLDEN = 0.6180339887498949
FAR = 1e4  # squared distances from a lamp, in squared radii: beyond that a disc is as bright as its middle


def ball(count: int) -> np.ndarray:
    """Return points (count, 3) in the unit ball. Seen along z they cover the disc like `disc` does, and from other
    directions nearly as evenly. For count 1, return the middle.
    """
    places, number = disc(count), np.arange(count)
    if count == 1:
        return np.zeros((1, 3))
    # neighbours lie on both sides, and pairs of them the other way round
    side = np.where((number % 4 == 0) | (number % 4 == 3), 1.0, -1.0)
    deep = side * np.sin(0.5 * np.pi * ((number // 2 * GOLDEN + 0.5) % 1.0)) * np.sqrt(1.0 - (places**2).sum(axis=1))
    # so that few have the middle and the depth of all
    deep -= deep.mean()
    return np.column_stack((places, deep * (0.5 / np.sqrt((deep**2).mean()))))


def falls_softly(data: bpy.types.Light, place: np.ndarray, towards: np.ndarray) -> bool:
    """Return True if the soft falloff of a point or spot lamp at `place` (3,) matters in the box of `towards` (n, 3),
    since the lamp counts as a disc.
    """
    if not data.use_soft_falloff:
        return False
    off = np.maximum(np.maximum(towards.min(axis=0) - place, place - towards.max(axis=0)), 0.0)
    return bool(off @ off < FAR * data.shadow_soft_size**2)
