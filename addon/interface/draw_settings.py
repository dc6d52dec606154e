"""Settings as they are drawn, in the sidebar and in the properties of an object alike."""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

from ..reading import can_take_part
from ..settings import holder_of, mirror_of

# settings in the subpanel "Limits"
SHOWN, LIGHT, LIMITS = ("tolerance", "placement", "method", "depth"), ("light_samples",), (
    "memory", "hidden_faces", "world_faces", "attributes", "join_parts")


def draw_settings(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """Draw the settings that apply to an object, and the switch for its own settings."""
    mirror = possible_mirror(obj)
    if mirror is not None:
        layout.prop(mirror.reflection_mesh, "own_settings")
    holder = holder_of(mirror, context.scene)
    for names in (SHOWN, LIGHT):
        column = layout.column()
        for name in names:
            if name == "depth" and holder.depth == 0:
                column.prop(holder, name, text=pgettext_iface("Bounces: Automatic"), translate=False)
            else:
                column.prop(holder, name)


def draw_limits(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """Draw the limits on memory and on the contents of results."""
    holder = holder_of(possible_mirror(obj), context.scene)
    for name in LIMITS:
        layout.prop(holder, name)


def possible_mirror(obj: bpy.types.Object | None) -> bpy.types.Object | None:
    """Return the object that may have its own settings: a result's mirror, or an object that may be a mirror."""
    mirror = mirror_of(obj)
    if mirror is not None and len(obj.reflection_mesh.parts):
        # the root of a hierarchy may be an empty
        return mirror
    if mirror is None or mirror.reflection_mesh.role == "DIFFUSE" or not can_take_part(mirror):
        return None
    return mirror
