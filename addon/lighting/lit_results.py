"""Results that show light: where on them the picture of light lies, the material that shows it, and the way back."""
from __future__ import annotations

import hashlib
import json

import bpy
import numpy as np

from ...core import View
from ..blender_data import LONGEST_RECORD, show_own_materials
from ..faults import AllOrNothing, keep_data, keep_object, still_there
from .light_material import POSITION, UV_MAP, image_of
from .light_scene import Window
from .needs_light import needs_light


def show_light(result: bpy.types.Object, view: View, window: Window, material: bpy.types.Material,
               whole: AllOrNothing) -> None:
    """Let a result show the light in a window of the picture; its mesh keeps the materials of what it shows."""
    record = result.reflection_mesh
    keep_object(result, whole)
    keep_data(result, whole)
    earlier = record.light_material
    _lay_out(result, view, window)
    show_own_materials(result)
    _put_on(result, material)
    record.light = json.dumps({"view": _fingerprint(view), "window": [window.column, window.row, window.width,
                                                                      window.height]})
    record.light_material, record.light_stale = material, False
    if earlier is not None and earlier != material:
        whole.after(forget_light, earlier)


def keep_light(result: bpy.types.Object, view: View) -> None:
    """After a result's mesh was written anew: it goes on showing its light where that was made for the same view and
    nothing has changed since, else the light counts as stale."""
    record = result.reflection_mesh
    material = record.light_material
    window = None if record.light_stale or material is None else _window(record.light, view)
    if window is None:
        record.light_stale = bool(record.light)
    else:
        _lay_out(result, view, window)
        _put_on(result, material)


def forget_light(material: bpy.types.Material) -> None:
    """Remove a material of light and its image, where nothing else uses them."""
    if not still_there([material]) or material.users or material.library is not None:
        return
    image = image_of(material)
    bpy.data.materials.remove(material)
    if image is not None and image.users == 0 and image.library is None:
        bpy.data.images.remove(image)


def light_lines(result: bpy.types.Object) -> list[str]:
    """What there is to say of a result's light, in short sentences."""
    record = result.reflection_mesh
    if record.light_stale:
        return ["The scene has changed since it was lit:", "press Light Reflection again."]
    if record.light_material is not None:
        return ["Lit."]
    return ["Its light is still to come:", "press Light Reflection."] if needs_light(result) else []


def mirror_positions(result: bpy.types.Object) -> np.ndarray:
    """Where on the mirror the points of a result lie, (n, 3) float64 in world space."""
    return _vectors(result.data, "mirror_position").astype(np.float64)


def _put_on(result: bpy.types.Object, material: bpy.types.Material) -> None:
    for slot in result.material_slots:
        slot.link, slot.material = "OBJECT", material


def _lay_out(result: bpy.types.Object, view: View, window: Window) -> None:
    """Tell each point of a result where in the window the view sees it: homogeneous, and as a UV map for engines that
    know nothing else."""
    mesh = result.data
    matrix = np.array(result.matrix_world, dtype=np.float64)
    places = _vectors(mesh, "position").astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]
    clip = view.clip(places)
    depth = clip[:, 3:]
    corner = np.array((window.column, window.row))
    across = (0.5 * (clip[:, :2] + depth) * view.resolution - corner * depth) / (window.width, window.height)
    homogeneous = np.concatenate((across, depth), axis=1).astype(np.float32)
    attribute = mesh.attributes.get(POSITION) or mesh.attributes.new(POSITION, "FLOAT_VECTOR", "POINT")
    attribute.data.foreach_set("vector", homogeneous.reshape(-1))
    layer = mesh.uv_layers.get(UV_MAP) or mesh.uv_layers.new(name=UV_MAP, do_init=False)
    if layer is not None and len(mesh.loops):
        corners = np.empty(len(mesh.loops), dtype=np.int32)
        mesh.attributes[".corner_vert"].data.foreach_get("value", corners)
        with np.errstate(divide="ignore", invalid="ignore"):
            spots = np.nan_to_num(homogeneous[:, :2] / homogeneous[:, 2:])
        layer.uv.foreach_set("vector", spots[corners].reshape(-1))
        layer.active = True


def _vectors(mesh: bpy.types.Mesh, name: str) -> np.ndarray:
    values = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes[name].data.foreach_get("vector", values.reshape(-1))
    return values


def _window(record: str, view: View) -> Window | None:
    """The window of the picture that light was made for; None where that was another view's."""
    try:
        known = json.loads(record[:LONGEST_RECORD])
        column, row, width, height = (int(side) for side in known["window"])
        same = known["view"] == _fingerprint(view)
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return Window(column, row, width, height, view.resolution) if same and width > 0 and height > 0 else None


def _fingerprint(view: View) -> str:
    """What tells one view from another, to single precision."""
    numbers = np.concatenate((view.camera_to_world.ravel(), view.projection.ravel(), view.resolution))
    return hashlib.sha256((numbers.astype(np.float32) + np.float32(0.0)).tobytes()).hexdigest()
