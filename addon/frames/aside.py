"""Results that the file already has, out of the way while frames are made, and as they were afterwards."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy

from ..faults import still_there
from ..reading import mirrors_of
from ..writing import as_shown

RECORD = ("mirror", "camera", "window")


@contextmanager
def set_aside(context: bpy.types.Context, mirrors: list, role: str = "REFLECTION") -> Iterator[None]:
    """Within, `mirrors` have no results of a role and renders show none; the frame and the camera may change."""
    scene = context.scene
    parts = set(mirrors)
    frame, subframe, camera = scene.frame_current, scene.frame_subframe, scene.camera
    results = [obj for obj in scene.objects if obj.reflection_mesh.role == role and obj.library is None
               and not parts.isdisjoint(mirrors_of(obj))]
    shown = as_shown(scene)
    hidden = [(obj, obj.hide_render) for obj in results]
    known = [(obj, {name: getattr(obj.reflection_mesh, name) for name in RECORD}) for obj in results]
    windows = [(obj, obj.visible_camera, obj.reflection_mesh.camera_hidden) for obj in mirrors if obj.library is None]
    for obj in results:
        # first hidden: nothing without a mirror is to be rendered
        obj.hide_render = True
        obj.reflection_mesh.mirror = None
    try:
        yield
    finally:
        scene.frame_set(frame, subframe=subframe)
        scene.camera = camera
        for obj, was in hidden:
            if still_there([obj]):
                obj.hide_render = was
        # baked cameras have put others' results aside
        shown()
        for obj, record in known:
            if still_there([obj]):
                for name, value in record.items():
                    setattr(obj.reflection_mesh, name, value)
        for obj, visible, hidden in windows:
            if still_there([obj]):
                obj.visible_camera, obj.reflection_mesh.camera_hidden = visible, hidden
