"""Show the sequence of the active camera if several cameras have one each. It also works without this extension."""
from __future__ import annotations

import bpy

from .. import compat
from ..faults import AllOrNothing, keep_object
from ..reading import camera_of, every_result_of
from ..writing import show_for_camera
from .play import plays
from .sequence import keyed

SWITCHES = ("hide_render", "hide_viewport")


def show_by_camera(scene: bpy.types.Scene, players: list) -> None:
    """Show the `players` (object, name of the camera) of the active camera: the scene's camera, or the one that a
    marker binds. Hide the others.
    """
    bound = _cuts(scene)
    if not bound and len({name for _, name in players}) == 1:
        # a camera without results sees what is there
        scene.reflection_mesh.seen_by = None
        for obj, _ in players:
            if obj.hide_render and obj.hide_viewport:
                # hidden completely, as if by another camera: shown again when its own camera is active
                obj.reflection_mesh.aside = (True, True)
        show_for_camera(scene)
        return
    scene.reflection_mesh.seen_by = scene.camera
    for obj, name in players:
        if not bound:
            # shown again when its camera looks
            obj.reflection_mesh.aside = (scene.camera is None or scene.camera.name != name,) * 2
        for switch in SWITCHES:
            setattr(obj, switch, scene.camera is None or scene.camera.name != name)
            if bound:
                keyed(obj, obj, switch, {frame: camera.name != name for frame, camera in bound.items()})


def make_way(context: bpy.types.Context, players: list, whole: AllOrNothing) -> list:
    """Hide results for every camera while a camera of the `players` (object, name of the camera) of the same mirror is
    active, since both would overlap. Return the objects that are hidden now or at some of the cuts.
    """
    names = {name for _, name in players}
    mirrors = dict.fromkeys(obj.reflection_mesh.mirror for obj, _ in players)
    scene, bound = context.scene, _cuts(context.scene)
    looking = bound or {scene.frame_current: scene.camera}
    if not any(camera is not None and camera.name in names for camera in looking.values()):
        return []
    others = [other for mirror in mirrors for other in every_result_of(context, mirror, context.view_layer.objects)
              if plays(other) and camera_of(other) is None]
    for other in others:
        keep_object(other, whole)
        for switch in SWITCHES:
            setattr(other, switch, scene.camera is not None and scene.camera.name in names)
            if bound:
                keyed(other, other, switch, {frame: camera.name in names for frame, camera in bound.items()})
    return others


def show_always(context: bpy.types.Context, obj: bpy.types.Object, whole: AllOrNothing) -> list:
    """Show a result for every camera all the time, and hide the mirror's results for single cameras, which would
    overlap it. Return these.
    """
    if obj.animation_data is not None and obj.animation_data.action is not None:
        whole.after(_forget_keys, obj)
    for switch in SWITCHES:
        setattr(obj, switch, False)
    others = [other for other in every_result_of(context, obj.reflection_mesh.mirror, context.view_layer.objects)
              if other != obj and camera_of(other) is not None]
    for other in others:
        keep_object(other, whole)
        # and not shown again when their camera looks
        other.hide_render = other.hide_viewport = True
        other.reflection_mesh.aside = (False, False)
        if other.animation_data is not None and other.animation_data.action is not None:
            whole.after(_forget_keys, other)
    return others


def _cuts(scene: bpy.types.Scene) -> dict:
    """Return the cameras that markers bind, by frame. Blender ignores cameras that are hidden in renders."""
    return {marker.frame: marker.camera for marker in scene.timeline_markers
            if marker.camera and not marker.camera.hide_render}


def _forget_keys(obj: bpy.types.Object) -> None:
    """Remove the keys by which an object was shown to one camera."""
    shown = [getattr(obj, switch) for switch in SWITCHES]
    for curve in compat.curves_of(obj):
        if curve.data_path in SWITCHES:
            for time in [key.co.x for key in curve.keyframe_points]:
                obj.keyframe_delete(curve.data_path, frame=time)
    for switch, hidden in zip(SWITCHES, shown):
        setattr(obj, switch, hidden)
