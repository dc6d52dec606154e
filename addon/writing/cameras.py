"""Results of several cameras: where the camera that looks has results of its own, those of others are put aside.

To Blender an object is there for every camera alike; a handler hides and shows them when another camera becomes the
scene's, be it by markers in the middle of a render. What the user hides stays hidden, what the user shows stays shown
until the camera changes again.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy
from bpy.app.handlers import persistent

from ..faults import still_there
from ..reading import camera_of, is_result, mirrors_of, redraw_lines
from ..registration import Handlers
from .windows import close_window, open_window

SWITCHES = ("hide_render", "hide_viewport")


def show_for_camera(scene: bpy.types.Scene) -> None:
    """Show the results of the scene's camera and hide those of other cameras, once for each change of the camera. Do
    nothing if the camera has no results.
    """
    camera = scene.camera
    if camera is None or scene.reflection_mesh.seen_by == camera or scene.library is not None:
        return
    # leave results without a camera as they are: they fit any camera, or someone else manages them
    results = [obj for obj in scene.objects if is_result(obj) and obj.library is None
               and obj.reflection_mesh.mirror is not None and camera_of(obj) is not None]
    own = [obj for obj in results if camera_of(obj) == camera]
    if not own:
        return
    scene.reflection_mesh.seen_by = camera
    for obj in results:
        if camera_of(obj) == camera:
            bring_back(obj)
        elif not any(obj.reflection_mesh.aside):
            _put_aside(obj)
    for mirror in {mirror for obj in own for mirror in mirrors_of(obj)}:
        windows = [obj.reflection_mesh.window for obj in own if mirror in mirrors_of(obj)]
        (open_window if any(windows) else close_window)(mirror)
    redraw_lines(scene)


def _put_aside(obj: bpy.types.Object) -> None:
    aside = [not getattr(obj, switch) for switch in SWITCHES]
    for switch, shown in zip(SWITCHES, aside):
        if shown:
            setattr(obj, switch, True)
    obj.reflection_mesh.aside = aside


def bring_back(obj: bpy.types.Object) -> None:
    """Show a reflection object again where `_put_aside` has hidden it; what the user hid stays hidden."""
    for switch, aside in zip(SWITCHES, obj.reflection_mesh.aside):
        if aside:
            setattr(obj, switch, False)
    obj.reflection_mesh.aside = (False, False)


def as_shown(scene: bpy.types.Scene) -> Callable[[], None]:
    """Return a function that restores which results a scene shows now, and which of their mirrors are windows."""
    results = [obj for obj in scene.objects if is_result(obj) and obj.library is None]
    mirrors = {mirror for obj in results for mirror in mirrors_of(obj)}
    shown = [(obj, tuple(getattr(obj, switch) for switch in SWITCHES), tuple(obj.reflection_mesh.aside))
             for obj in results]
    windows = [(obj, obj.visible_camera, obj.reflection_mesh.camera_hidden) for obj in mirrors if obj.library is None]
    seen_by = scene.reflection_mesh.seen_by

    def back() -> None:
        for obj, hidden, aside in shown:
            if still_there([obj]):
                obj.hide_render, obj.hide_viewport = hidden
                obj.reflection_mesh.aside = aside
        for obj, visible, hidden in windows:
            if still_there([obj]):
                obj.visible_camera, obj.reflection_mesh.camera_hidden = visible, hidden
        if still_there([scene]):
            scene.reflection_mesh.seen_by = next(iter(still_there([] if seen_by is None else [seen_by])), None)
    return back


def forget_deleted(scene: bpy.types.Scene) -> None:
    """Remove deleted cameras from a scene and its markers. Blender would do it if results did not refer to the cameras.
    """
    markers = [marker for marker in scene.timeline_markers if marker.camera is not None]
    looking = {scene.camera, *(marker.camera for marker in markers)} - {None}
    gone = {camera for camera in looking if not camera.users_scene}
    if not gone or scene.library is not None:
        return
    known = {obj.reflection_mesh.camera for obj in scene.objects if is_result(obj)}
    for marker in markers:
        if marker.camera in gone & known:
            marker.camera = None
    # do not touch a camera that was never in a scene: the user chose it
    if scene.camera in gone and scene.reflection_mesh.seen_by == scene.camera:
        scene.camera = scene.reflection_mesh.seen_by = None


@persistent
def _after_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    # a render's depsgraph reports no changes of the file
    if depsgraph.mode != "VIEWPORT":
        return
    if depsgraph.id_type_updated("COLLECTION"):
        forget_deleted(scene)
    if depsgraph.id_type_updated("SCENE"):
        show_for_camera(scene)


@persistent
def _before_frame(scene: bpy.types.Scene, *_) -> None:
    # in a render markers have chosen the camera by now, and objects are read next; a render that the window does not
    # wait for works beside it, where nothing may be hidden under Blender's hands
    if bpy.app.background or scene.render.use_lock_interface:
        show_for_camera(scene)


@persistent
def _after_opening(*_) -> None:
    for scene in bpy.data.scenes:
        show_for_camera(scene)


HANDLERS = Handlers((_after_change, "depsgraph_update_post", "frame_change_post"), (_before_frame, "frame_change_pre"),
                    (_after_opening, "load_post"))
register, unregister = HANDLERS.register, HANDLERS.unregister
