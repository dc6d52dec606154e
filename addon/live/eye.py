"""For whom Live keeps results right: the scene's camera, or whoever looks through the largest 3D viewport."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import ReflectionError, View
from ..reading import read_view


def read_eye(context: bpy.types.Context, of_viewport: bool) -> View:
    """Return the view of the scene's camera. If `of_viewport`, return the view of the largest 3D viewport of the scene,
    which is the camera's while it looks through the camera.

    Raises
    ------
    ReflectionError
        See `read_view`.
    """
    region = largest_viewport(context) if of_viewport else None
    if region is None or region[0].view_perspective == "CAMERA":
        return read_view(context)
    return view_of(*region)


def view_of(region_3d: bpy.types.RegionView3D, size: tuple[int, int]) -> View:
    """Return the view through a 3D viewport with the given number of pixels."""
    placement = np.array(region_3d.view_matrix, dtype=np.float64)
    try:
        placement = np.linalg.inv(placement)
        # single precision leaves the last row a little off what it is
        placement[3] = 0.0, 0.0, 0.0, 1.0
        projection = np.array(region_3d.window_matrix, dtype=np.float64)
        if projection[3, 2] == 0.0:
            # without perspective Blender has the eye in the middle of what it sees: back to the near plane with it
            back = max(0.0, -(1.0 + projection[2, 3]) / projection[2, 2])
            placement[:3, 3] += back * placement[:3, 2]
            projection[:, 3] += back * projection[:, 2]
        return View(placement, projection, size)
    except (ValueError, np.linalg.LinAlgError) as error:
        raise ReflectionError(f"The 3D viewport's view cannot be reflected: {error}") from error


def largest_viewport(context: bpy.types.Context) -> tuple | None:
    """Return the view and the size in pixels of the largest 3D viewport of the scene; None if there is none."""
    found, most = None, 0
    for window in context.window_manager.windows:
        if window.scene != context.scene:
            continue
        for area in window.screen.areas:
            if area.type != "VIEW_3D":
                continue
            region = next((region for region in area.regions if region.type == "WINDOW"), None)
            view = area.spaces.active.region_3d
            if region is not None and view is not None and region.width * region.height > most:
                found, most = (view, (region.width, region.height)), region.width * region.height
    return found
