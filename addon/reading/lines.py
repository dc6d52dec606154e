"""Whether lines are drawn in a scene: results that no lines are drawn of need no borders closed for them."""
from __future__ import annotations

import bpy

from .. import compat


def lines_drawn(scene: bpy.types.Scene) -> bool:
    """Whether an object of the scene has Line Art, or one of its view layers Freestyle, that viewports or renders
    show."""
    return _has_freestyle(scene) or any(map(_has_line_art, scene.objects))


def _has_freestyle(scene: bpy.types.Scene) -> bool:
    return scene.render.use_freestyle and any(layer.use and layer.use_freestyle for layer in scene.view_layers)


def _has_line_art(obj: bpy.types.Object) -> bool:
    # neither seen now nor rendered, as where it was switched off for good
    if obj.hide_viewport and obj.hide_render:
        return False
    return any(modifier.show_viewport or modifier.show_render for modifier in compat.line_art_of(obj))
