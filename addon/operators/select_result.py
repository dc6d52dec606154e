"""The operator that selects the reflection in the active mirror, which clicks in the viewport pass by."""
from __future__ import annotations

import bpy

from ..faults import in_one_sentence
from ..reading import known_results, result_of
from . import polls

IN_OBJECT_MODE = "Reflections are selected in Object Mode: leave the present mode first."
NO_RESULT = "The active object has no reflection: make a mirror that has one the active object."


class REFLECTION_MESH_OT_select(bpy.types.Operator):
    """Select the reflection in the active mirror, to edit it. From then on clicks in the viewport select it too"""

    bl_idname = "reflection_mesh.select"
    bl_label = "Select Reflection"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return polls.passes(cls, context, polls.in_object_mode(IN_OBJECT_MODE), _has_result)

    @in_one_sentence
    def execute(self, context: bpy.types.Context) -> set:
        result = _result(context)
        for obj in context.selected_objects:
            obj.select_set(False)
        if result.library is None:
            result.hide_select = False
        result.select_set(True)
        context.view_layer.objects.active = result
        return {"FINISHED"}


def _result(context: bpy.types.Context) -> bpy.types.Object | None:
    known = known_results(context.scene, context.view_layer)
    return result_of(context, context.view_layer.objects.active, known)


def _has_result(context: bpy.types.Context) -> str:
    result = _result(context)
    return "" if result is not None and result.name in context.view_layer.objects else NO_RESULT


def register() -> None:
    bpy.utils.register_class(REFLECTION_MESH_OT_select)


def unregister() -> None:
    bpy.utils.unregister_class(REFLECTION_MESH_OT_select)
