"""Line Art and Freestyle in a scene: whether they draw lines, and drawing these again."""
from __future__ import annotations

import bpy

from .. import compat


def lines_drawn(scene: bpy.types.Scene) -> bool:
    """Return True if an enabled Line Art modifier or an enabled Freestyle view layer draws lines in the scene."""
    return _has_freestyle(scene) or any(map(_has_line_art, scene.objects))


def redraw_lines(scene: bpy.types.Scene) -> None:
    """Let all Line Art of a scene be drawn again after objects were added or removed.

    Blender does not do so by itself: 4.2 not after objects were removed, later versions not after objects were added.
    """
    for obj in scene.objects:
        if obj.library is None and compat.line_art_of(obj):
            obj.update_tag()


def _has_freestyle(scene: bpy.types.Scene) -> bool:
    return scene.render.use_freestyle and any(layer.use and layer.use_freestyle for layer in scene.view_layers)


def _has_line_art(obj: bpy.types.Object) -> bool:
    # neither seen now nor rendered, as where it was switched off for good
    if obj.hide_viewport and obj.hide_render:
        return False
    return any(modifier.show_viewport or modifier.show_render for modifier in compat.line_art_of(obj))
