"""Live: the switch, and for whom it works. What it does at the moment is told as a prompt."""
from __future__ import annotations

import bpy

from ..live import present


def draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the button that starts or stops Live, and below it Seen From: the view that Live updates reflections for."""
    column = layout.column(align=True)
    if present() is None:
        column.operator("reflection_mesh.live", text="Live", icon="PLAY")
    else:
        column.operator("reflection_mesh.live", text="Stop Live", icon="PAUSE")
    column.prop(context.window_manager.reflection_mesh_live, "eye")
