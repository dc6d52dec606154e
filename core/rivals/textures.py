"""Pictures of the scene from elsewhere, whose texels hold a triangle and a point on it, looked up between texels."""
from __future__ import annotations

import numpy as np

from ..geometry import TriangleMesh
from ..views import View, draw

Texture = tuple[np.ndarray, np.ndarray]


def texture_of(view: View, scene: TriangleMesh, chosen: np.ndarray | None = None) -> Texture:
    """Draw the scene, or its triangles `chosen`, as seen in `view` without any mirror.

    Returns
    -------
    triangle : (height, width) int64
        Triangle at each pixel, -1 if there is none.
    position : (3, height, width) float64
        Point on it, zero if there is none.
    """
    triangles = scene.triangles if chosen is None else scene.triangles[chosen]
    drawn = draw(view, scene.positions, triangles)
    shown = np.flatnonzero(drawn.triangle >= 0)
    width, height = view.resolution
    triangle, position = np.full(width * height, -1), np.zeros((3, width * height))
    position[:, shown] = drawn.interpolate(scene.positions, triangles, shown)
    triangle[shown] = drawn.triangle[shown] if chosen is None else chosen[drawn.triangle[shown]]
    return triangle.reshape(height, width), position.reshape(3, height, width)


def looked_up(texture: Texture, pixels: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Look up the triangle (n,) and the position (3, n) at `pixels` (n, 2) of a texture.

    The position is interpolated between four texels if all show one triangle, else it is the nearest texel's.
    """
    triangle, position = texture
    height, width = triangle.shape
    position = position.reshape(3, -1)
    x, y = pixels.T - 0.5
    left = np.clip(np.floor(x), 0, max(width - 2, 0)).astype(np.int64)
    bottom = np.clip(np.floor(y), 0, max(height - 2, 0)).astype(np.int64)
    right, top = np.minimum(left + 1, width - 1), np.minimum(bottom + 1, height - 1)
    across, upward = np.clip(x - left, 0.0, 1.0), np.clip(y - bottom, 0.0, 1.0)
    texels = [line * width + column for line in (bottom, top) for column in (left, right)]
    weights = ((1.0 - across) * (1.0 - upward), across * (1.0 - upward), (1.0 - across) * upward, across * upward)
    nearest = np.where(upward < 0.5, bottom, top) * width + np.where(across < 0.5, left, right)
    found = triangle.ravel()[nearest]
    same = np.logical_and.reduce([triangle.ravel()[texel] == found for texel in texels])
    between = sum(weight * np.take(position, texel, axis=1) for weight, texel in zip(weights, texels))
    return found, np.where(same, between, np.take(position, nearest, axis=1))
