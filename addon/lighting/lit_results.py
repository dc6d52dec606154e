"""Results that show light: where on them the picture of light lies, the material that shows it, and the way back."""
from __future__ import annotations

import hashlib
import json

import bpy
import numpy as np

from ...core import View
from ..blender_data import LONGEST_RECORD, show_own_materials
from ..faults import AllOrNothing, keep_data, keep_object, still_there
from .light_material import images_of, texels_shown
from .light_scene import Window
from .needs_light import needs_light
from .picture_layout import lay_out


def show_light(result: bpy.types.Object, view: View, window: Window, material: bpy.types.Material,
               whole: AllOrNothing) -> None:
    """Let a result show the light in a window of the picture; its mesh keeps the materials of what it shows."""
    record = result.reflection_mesh
    keep_object(result, whole)
    keep_data(result, whole)
    earlier = record.light_material
    lay_out(result, view, window, texels_shown(material))
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
        lay_out(result, view, window, texels_shown(material))
        _put_on(result, material)


def forget_light(material: bpy.types.Material) -> None:
    """Remove a material of light and its images, where nothing else uses them."""
    if not still_there([material]) or material.users or material.library is not None:
        return
    images = set(images_of(material))
    bpy.data.materials.remove(material)
    for image in images:
        if image.users == 0 and image.library is None:
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
    mesh = result.data
    places = np.empty((len(mesh.vertices), 3), dtype=np.float32)
    mesh.attributes["mirror_position"].data.foreach_get("vector", places.reshape(-1))
    return places.astype(np.float64)


def _put_on(result: bpy.types.Object, material: bpy.types.Material) -> None:
    for slot in result.material_slots:
        slot.link, slot.material = "OBJECT", material


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
