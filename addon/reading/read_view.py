"""Scene camera -> `core.View`: lens, shift, sensor fit, pixel aspect and resolution of the render."""
from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...core import ReflectionError, View

LARGEST_SIDE = 1 << 16  # pixels of a view
NO_CAMERA = "The scene has no camera: add one (Add > Camera) and make it the scene's camera."


def read_view(context: bpy.types.Context, size: tuple[int, int] | None = None) -> View:
    """Return the view of the scene's camera in world space and scene units, at the render's resolution or at `size`.

    Raises
    ------
    ReflectionError
        If the scene has no camera, or a panoramic one.
    """
    scene = context.scene
    camera = scene.camera
    if camera is None:
        raise ReflectionError(NO_CAMERA)
    if camera.type != "CAMERA":
        raise ReflectionError(f"The scene's camera '{camera.name}' is no camera object: choose one in the scene's "
                              "properties.")
    if camera.data.type not in {"PERSP", "ORTHO"}:
        raise ReflectionError(f"The camera '{camera.name}' is panoramic: set its type to Perspective or Orthographic.")
    depsgraph = context.evaluated_depsgraph_get()
    camera = camera.evaluated_get(depsgraph)
    render = scene.render
    width, height = size or render_size(scene)
    projection = camera.calc_matrix_camera(depsgraph, x=width, y=height, scale_x=render.pixel_aspect_x,
                                           scale_y=render.pixel_aspect_y)
    placement = np.array(camera.matrix_world, dtype=np.float64)
    # like a render, ignore the camera's scale
    length = np.linalg.norm(placement[:3, :3], axis=0)
    if not np.isfinite(placement).all() or (length == 0.0).any():
        raise ReflectionError(f"The camera '{camera.name}' has a scale of zero or a position that is no number: clear "
                              "its transform.")
    placement[:3, :3] /= length
    placement[3] = 0.0, 0.0, 0.0, 1.0
    return View(placement, np.array(projection, dtype=np.float64), (width, height))


def with_square_pixels(view: View, render: bpy.types.RenderSettings) -> View:
    """Return `view`, whose pixels have the aspect of `render`, with square pixels. The shorter side of a pixel stays as
    it is, so that the resolution grows.
    """
    sides = np.array((render.pixel_aspect_x, render.pixel_aspect_y))
    size = np.array(view.resolution) * sides / sides.min()
    size *= min(1.0, LARGEST_SIDE / size.max())
    return replace(view, resolution=tuple(max(1, round(side)) for side in size.tolist()))


def render_size(scene: bpy.types.Scene) -> tuple[int, int]:
    """Return the width and the height of the render in pixels."""
    render = scene.render
    return tuple(max(1, size * render.resolution_percentage // 100)
                 for size in (render.resolution_x, render.resolution_y))
