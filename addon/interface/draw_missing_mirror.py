"""What makes a mirror, where the scene has none, and the button that makes the active object one."""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

from ..operators.polls import has_mirror
from ..reading import RESULTS, can_take_part
from .draw_lines import draw_sentence


def lacks_mirror(context: bpy.types.Context, obj: bpy.types.Object | None) -> bool:
    """Return True where Generate finds no mirror while an object is active."""
    return (obj is None or obj.reflection_mesh.role not in RESULTS) and bool(has_mirror(context))


def draw_missing_mirror(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """Say what makes a mirror, and offer to make the active object one."""
    draw_sentence(layout, context, pgettext_iface("The scene has no mirror. A mirror is metal with a Roughness up to "
                                                  "0.1, or has the role Mirror."), icon="INFO")
    if obj is not None and can_take_part(obj):
        layout.operator("reflection_mesh.make_mirror", icon="MOD_MIRROR",
                        text=pgettext_iface("Make '{name}' a Mirror").format(name=obj.name), translate=False)
