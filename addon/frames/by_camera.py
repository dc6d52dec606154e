"""Which sequence is shown where several cameras have one each, without this extension too."""
from __future__ import annotations

import bpy

from .sequence import keyed


def show_by_camera(scene: bpy.types.Scene, players: list) -> None:
    """Of several cameras' players (object, name of the camera) show those of the one that looks: the scene's, or the
    one that a marker binds."""
    bound = {marker.frame: marker.camera for marker in scene.timeline_markers if marker.camera}
    scene.reflection_mesh.seen_by = scene.camera
    for obj, name in players:
        if not bound:
            # shown again when its camera looks
            obj.reflection_mesh.aside = (scene.camera is None or scene.camera.name != name,) * 2
        for switch in ("hide_render", "hide_viewport"):
            setattr(obj, switch, scene.camera is None or scene.camera.name != name)
            if bound:
                keyed(obj, obj, switch, {frame: camera.name != name for frame, camera in bound.items()})
