"""The menu Object > Reflection Mesh of the 3D viewport, by which F3 finds every operator too, and that of roles."""
from __future__ import annotations

import bpy

from .draw_work import TOOLS, WORK

CHOSEN = ("AUTO", "MIRROR", "DIFFUSE", "IGNORE")  # roles that users give; those of results come with the making


class VIEW3D_MT_reflection_mesh(bpy.types.Menu):
    """What mirrors show, as objects"""

    bl_label = "Reflection Mesh"

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        # otherwise menu items would run without a file browser and without progress
        layout.operator_context = "INVOKE_REGION_WIN"
        for name, icon in WORK:
            layout.operator(name, icon=icon)
        layout.operator("reflection_mesh.make_mirror", icon="MOD_MIRROR")
        layout.operator("reflection_mesh.live", icon="PLAY")
        layout.operator("reflection_mesh.select", icon="RESTRICT_SELECT_OFF")
        layout.separator()
        for name, icon in TOOLS:
            layout.operator(name, icon=icon)


class REFLECTION_MESH_MT_role(bpy.types.Menu):
    """What this object is in reflections"""

    bl_label = "Role"

    def draw(self, context: bpy.types.Context) -> None:
        active = context.view_layer.objects.active
        for role in CHOSEN if active is not None else ():
            self.layout.prop_enum(active.reflection_mesh, "role", role)


def _draw_entry(self, context: bpy.types.Context) -> None:
    self.layout.separator()
    self.layout.menu(VIEW3D_MT_reflection_mesh.__name__, icon="MOD_MIRROR")


CLASSES = (VIEW3D_MT_reflection_mesh, REFLECTION_MESH_MT_role)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.VIEW3D_MT_object.append(_draw_entry)


def unregister() -> None:
    bpy.types.VIEW3D_MT_object.remove(_draw_entry)
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
