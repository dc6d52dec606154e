"""The menu Object > Reflection Mesh of the 3D viewport, by which F3 finds every operator too."""
from __future__ import annotations

import bpy

from .draw_work import TOOLS, WORK


class VIEW3D_MT_reflection_mesh(bpy.types.Menu):
    """What mirrors show, as objects"""

    bl_label = "Reflection Mesh"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        # else a menu runs what stands in it without asking for a file or showing progress
        layout.operator_context = "INVOKE_REGION_WIN"
        for name, icon in WORK:
            layout.operator(name, icon=icon)
        layout.separator()
        for name, icon in TOOLS:
            layout.operator(name, icon=icon)


def _draw_entry(self, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_reflection_mesh.__name__, icon="MOD_MIRROR")


def register() -> None:
    bpy.utils.register_class(VIEW3D_MT_reflection_mesh)
    bpy.types.VIEW3D_MT_object.append(_draw_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_draw_entry)
    bpy.utils.unregister_class(VIEW3D_MT_reflection_mesh)
