"""The objects that a result shows, each with the switch of its matte."""
from __future__ import annotations

import bpy

LISTED = 20     # so many are all listed; of more those that are selected, or have a matte


def draw_mattes(layout: bpy.types.UILayout, result: bpy.types.Object) -> None:
    """Draw a switch for each source of a result."""
    shown = [source.object for source in result.reflection_mesh.sources if source.object is not None]
    if len(shown) > LISTED:
        shown = [obj for obj in shown if obj.reflection_mesh.matte or obj.select_get()]
        layout.label(text="Select objects to list them here", icon="INFO")
    column = layout.column(align=True)
    for obj in shown:
        column.prop(obj.reflection_mesh, "matte", text=obj.name, translate=False)
