"""Light in the pixels of a picture: where on a result it lies, and the view that it is for."""
from __future__ import annotations

import hashlib
import json

import bpy
import numpy as np

from ...core import View
from ..baking import UV_MAP, corner_vertices, vectors
from ..blender_data import LONGEST_RECORD
from .light_material import POSITION
from .light_scene import Window


def record_of(view: View, window: Window) -> str:
    """What a result remembers of its light."""
    return json.dumps({"kind": "PICTURE", "view": _fingerprint(view),
                       "window": [window.column, window.row, window.width, window.height]})


def window_of(record: str, view: View) -> Window | None:
    """The window of the picture that light was made for; None where that was another view's."""
    try:
        known = json.loads(record[:LONGEST_RECORD])
        column, row, width, height = (int(side) for side in known["window"])
        same = known["view"] == _fingerprint(view)
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return Window(column, row, width, height, view.resolution) if same and width > 0 and height > 0 else None


def lay_out_picture(result: bpy.types.Object, view: View, window: Window) -> None:
    """Tell each point of a result where in the window the view sees it: homogeneous, and as a UV map for engines that
    know nothing else."""
    mesh = result.data
    matrix = np.array(result.matrix_world, dtype=np.float64)
    places = vectors(mesh, "position") @ matrix[:3, :3].T + matrix[:3, 3]
    clip = view.clip(places)
    depth = clip[:, 3:]
    corner = np.array((window.column, window.row))
    across = (0.5 * (clip[:, :2] + depth) * view.resolution - corner * depth) / (window.width, window.height)
    homogeneous = np.concatenate((across, depth), axis=1).astype(np.float32)
    attribute = mesh.attributes.get(POSITION) or mesh.attributes.new(POSITION, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", homogeneous.reshape(-1))
    layer = mesh.uv_layers.get(UV_MAP) or mesh.uv_layers.new(name=UV_MAP, do_init=False)
    if layer is not None and len(mesh.loops):
        with np.errstate(divide="ignore", invalid="ignore"):
            spots = np.nan_to_num(homogeneous[:, :2] / homogeneous[:, 2:])
        layer.uv.foreach_set("vector", spots[corner_vertices(mesh)].reshape(-1))
        layer.active = True


def _fingerprint(view: View) -> str:
    """What tells one view from another, to single precision."""
    numbers = np.concatenate((view.camera_to_world.ravel(), view.projection.ravel(), view.resolution))
    return hashlib.sha256((numbers.astype(np.float32) + np.float32(0.0)).tobytes()).hexdigest()
