"""Presets of settings, by Blender's own mechanism: those that come with the extension, and those that users save.

A preset sets what the panels show: the scene's settings, or those of the active mirror where it has its own.
"""
from __future__ import annotations

import os

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel

from ..settings import LIGHT_SETTINGS, SETTINGS, WRITTEN_SETTINGS

FOLDER = "reflection_mesh"


class REFLECTION_MESH_PT_presets(PresetPanel, bpy.types.Panel):
    """Settings that were saved under a name"""

    bl_label = "Reflection Presets"
    preset_subdir = FOLDER
    preset_operator = "script.execute_preset"
    preset_add_operator = "reflection_mesh.preset_add"


class REFLECTION_MESH_OT_preset_add(AddPresetBase, bpy.types.Operator):
    """Save these settings as a preset or remove a preset"""

    bl_idname = "reflection_mesh.preset_add"
    bl_label = "Add Reflection Preset"
    preset_menu = "REFLECTION_MESH_PT_presets"
    preset_subdir = FOLDER
    # the settings that hold for the active object, as `settings.holder_of` tells; no method of a property group, since
    # 4.2 as a module crashes at its end where a group has any
    preset_defines = [
        "active = bpy.context.view_layer.objects.active",
        'made = active and active.reflection_mesh.role in {"REFLECTION", "CAUSTICS"}',
        "mirror = active.reflection_mesh.mirror if made else active",
        "settings = (mirror if mirror and mirror.reflection_mesh.own_settings else bpy.context.scene).reflection_mesh"]
    # Memory belongs to the machine
    preset_values = [f"settings.{name}" for name in SETTINGS + LIGHT_SETTINGS + WRITTEN_SETTINGS
                     if name != "memory"]


CLASSES = (REFLECTION_MESH_PT_presets, REFLECTION_MESH_OT_preset_add)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.utils.register_preset_path(_own_folder())


def unregister() -> None:
    bpy.utils.unregister_preset_path(_own_folder())
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)


def _own_folder() -> str:
    """Return the folder that contains `presets/reflection_mesh`."""
    return os.path.dirname(__file__)
