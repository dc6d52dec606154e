"""Rounding of places far from the origin to single precision, in a sentence for the user.

Cycles adds up an object's place and a vertex's in single precision. Millions of units from the origin the sum is
rounded to half a unit, and renders of anything are noise, with a reflection and without.
"""
from __future__ import annotations

import bpy
import numpy as np

from ...core import View
from ..reading import read_view, vectors

COARSE = 0.125  # pixels: at 0.05 the errors against Cycles are as beside the origin, at 0.2 a tenth larger


def rounding_remarks(context: bpy.types.Context, results: list) -> list[str]:
    """Return a sentence if positions of `results` are rounded to more than a fraction of the camera's pixels."""
    if context.scene.camera is None:
        return []
    points = np.concatenate([np.zeros((0, 3)), *map(_places, results)])
    spacing, pixels = rounding(read_view(context), points)
    if not pixels > COARSE:
        return []
    return [f"Blender rounds places so far from the origin to {spacing:.2g} units, or {pixels:.2g} pixels, and renders "
            "are noisy. Move the whole scene to the origin, or import it with an offset."]


def rounding(view: View, points: np.ndarray) -> tuple[float, float]:
    """Return the spacing of single precision at `points` (n, 3), in scene units and in pixels of the view.

    Medians over all points; zero if none is seen.
    """
    largest = np.maximum(np.abs(points).max(axis=1), np.abs(view.eye).max())
    spacing = np.spacing(largest.astype(np.float32)).astype(np.float64)
    pixels = spacing * np.linalg.norm(view.pixel_gradients(points.T), axis=1).max(axis=0)
    seen = np.isfinite(pixels)
    return (float(np.median(spacing[seen])), float(np.median(pixels[seen]))) if seen.any() else (0.0, 0.0)


def _places(obj: bpy.types.Object) -> np.ndarray:
    """Return the vertices (n, 3) of an object in world space."""
    matrix = np.array(obj.matrix_world, dtype=np.float64)
    return vectors(obj.data, "position") @ matrix[:3, :3].T + matrix[:3, 3]
