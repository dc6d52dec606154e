"""The panels: the tab "Reflection" of the 3D viewport's sidebar, and "Reflection Mesh" in an object's properties.

Both are drawn by the same functions; each class says where, and what of it.
"""
from __future__ import annotations

import bpy

from ..frames import plays
from ..reading import can_take_part, is_result
from .draw_live import draw_live
from .draw_mattes import draw_mattes
from .draw_object import draw_figures, draw_object, shown_result
from .draw_prompt import draw_prompt
from .draw_settings import draw_limits, draw_settings, possible_mirror
from .draw_work import TOOLS, WORK, draw_buttons, draw_comparison
from .preset_buttons import REFLECTION_MESH_PT_presets


class _Sidebar:
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Reflection"


class _Properties:
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = active(context)
        return obj is not None and (obj.reflection_mesh.role in {"REFLECTION", "CAUSTICS", "IGNORE"}
                                    or can_take_part(obj))


class _Main:
    bl_label = "Reflection Mesh"

    def draw(self, context: bpy.types.Context) -> None:
        layout = aligned(self.layout)
        draw_object(layout.box().column(), context, active(context))
        draw_buttons(layout, WORK)
        draw_live(layout, context)
        draw_prompt(layout, context, active(context))


class _Settings:
    bl_label = "Settings"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        REFLECTION_MESH_PT_presets.draw_panel_header(self.layout)

    def draw(self, context: bpy.types.Context) -> None:
        draw_settings(aligned(self.layout), context, active(context))


class _Limits:
    bl_label, bl_options = "Limits", {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_limits(aligned(self.layout), context, active(context))


class _Mattes:
    bl_label, bl_options = "Mattes", {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = shown_result(context, active(context))
        return obj is not None and is_result(obj)

    def draw(self, context: bpy.types.Context) -> None:
        draw_mattes(self.layout, shown_result(context, active(context)))


class _Figures:
    bl_label, bl_options = "Figures", {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = shown_result(context, active(context))
        return obj is not None and not plays(obj)

    def draw(self, context: bpy.types.Context) -> None:
        draw_figures(self.layout.column(align=True), context, shown_result(context, active(context)))


class REFLECTION_MESH_PT_main(_Sidebar, _Main, bpy.types.Panel):
    """What the active object is in reflections, and the work"""


class REFLECTION_MESH_PT_settings(_Sidebar, _Settings, bpy.types.Panel):
    """How reflections are made"""

    bl_parent_id = "REFLECTION_MESH_PT_main"


class REFLECTION_MESH_PT_limits(_Sidebar, _Limits, bpy.types.Panel):
    """What the work may take"""

    bl_parent_id = "REFLECTION_MESH_PT_settings"


class REFLECTION_MESH_PT_tools(_Sidebar, bpy.types.Panel):
    """Comparison with Cycles, and pictures that look right in a mirror alone"""

    bl_label, bl_options, bl_parent_id = "Compare and Print", {"DEFAULT_CLOSED"}, "REFLECTION_MESH_PT_main"

    def draw(self, context: bpy.types.Context) -> None:
        draw_buttons(self.layout, TOOLS)
        draw_comparison(self.layout, context)


class REFLECTION_MESH_PT_mattes(_Sidebar, _Mattes, bpy.types.Panel):
    """Passes for compositing, of single objects in the reflection"""

    bl_parent_id = "REFLECTION_MESH_PT_main"


class REFLECTION_MESH_PT_figures(_Sidebar, _Figures, bpy.types.Panel):
    """Numbers for engineers; last, so that no other panel moves when a result appears"""

    bl_parent_id = "REFLECTION_MESH_PT_main"


class REFLECTION_MESH_PT_object(_Properties, _Main, bpy.types.Panel):
    """What this object is in reflections"""

    bl_options = {"DEFAULT_CLOSED"}


class REFLECTION_MESH_PT_object_settings(_Properties, _Settings, bpy.types.Panel):
    """How this mirror's reflection is made"""

    bl_parent_id = "REFLECTION_MESH_PT_object"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return possible_mirror(active(context)) is not None


class REFLECTION_MESH_PT_object_limits(_Properties, _Limits, bpy.types.Panel):
    """What the work may take"""

    bl_parent_id = "REFLECTION_MESH_PT_object_settings"


class REFLECTION_MESH_PT_object_mattes(_Mattes, _Properties, bpy.types.Panel):
    """Passes for compositing, of single objects in the reflection"""

    bl_parent_id = "REFLECTION_MESH_PT_object"


class REFLECTION_MESH_PT_object_figures(_Figures, _Properties, bpy.types.Panel):
    """Numbers for engineers"""

    bl_parent_id = "REFLECTION_MESH_PT_object"


def active(context: bpy.types.Context) -> bpy.types.Object | None:
    """Return the active object; None if there is no view layer."""
    layer = getattr(context, "view_layer", None)
    return None if layer is None else layer.objects.active


def aligned(layout: bpy.types.UILayout) -> bpy.types.UILayout:
    """Return the layout with names beside their values, as in Blender's own panels."""
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


CLASSES = (REFLECTION_MESH_PT_main, REFLECTION_MESH_PT_settings, REFLECTION_MESH_PT_limits, REFLECTION_MESH_PT_tools,
           REFLECTION_MESH_PT_mattes, REFLECTION_MESH_PT_figures, REFLECTION_MESH_PT_object,
           REFLECTION_MESH_PT_object_settings, REFLECTION_MESH_PT_object_limits, REFLECTION_MESH_PT_object_mattes,
           REFLECTION_MESH_PT_object_figures)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
