"""What a mirror that is a window is without: seen by the camera and, since Line Art asks no camera, by that."""
from __future__ import annotations

import bpy


def window_state(mirror: bpy.types.Object) -> tuple:
    """All that making a window of a mirror changes."""
    record = mirror.reflection_mesh
    return mirror.visible_camera, record.camera_hidden, mirror.lineart.usage, record.lines_hidden


def bring_back_window(mirror: bpy.types.Object, state: tuple) -> None:
    """Let a mirror be the window, or the mirror, that it was."""
    record = mirror.reflection_mesh
    mirror.visible_camera, record.camera_hidden, usage, record.lines_hidden = state
    if mirror.lineart.usage != usage:
        mirror.lineart.usage = usage
