"""Presets: those that come along, and those that users save."""
from __future__ import annotations

from pathlib import Path

import bpy
import parts
import pytest
from drawn_panels import pair

from tools.extension_zip import PACKAGE


@pytest.fixture
def scene(blank) -> bpy.types.Scene:
    return pair(blank)


def test_presets_that_come_along_set_what_is_shown(scene, room):
    paths = {Path(path).stem: path for folder in bpy.utils.preset_paths("reflection_mesh")
             for path in map(str, Path(folder).glob("*.py"))}
    assert {"Draft", "Standard", "Final"} <= set(paths)
    mirror, menu = bpy.data.objects["Mirror"].reflection_mesh, "REFLECTION_MESH_PT_presets"
    mirror.own_settings = True
    for holder, other in ((mirror, scene.reflection_mesh), (scene.reflection_mesh, mirror)):
        other.tolerance = 7.0
        for path in paths.values():
            holder.tolerance = 9.0
            assert bpy.ops.script.execute_preset(filepath=path, menu_idname=menu) == {"FINISHED"}
            assert holder.tolerance < 9.0 and other.tolerance == 7.0
        mirror.own_settings = False
    bpy.ops.script.execute_preset(filepath=paths["Standard"], menu_idname=menu)
    standard = {name: getattr(scene.reflection_mesh, name) for name in room("addon.settings").SETTINGS}
    for name in standard:
        scene.reflection_mesh.property_unset(name)
    assert standard == {name: getattr(scene.reflection_mesh, name) for name in standard}


@pytest.mark.parametrize("role", ["REFLECTION", "CAUSTICS"])
def test_a_preset_sets_the_mirrors_settings_from_what_was_made_of_it(scene, role):
    made, mirror = parts.add("plane", "Made"), bpy.data.objects["Mirror"]
    made.reflection_mesh.role, made.reflection_mesh.mirror, mirror.reflection_mesh.own_settings = role, mirror, True
    parts.select(made)
    add = bpy.ops.reflection_mesh.preset_add
    mirror.reflection_mesh.tolerance = 3.0
    try:
        assert add(name="My Look") == {"FINISHED"}
        for path in (bpy.utils.preset_find(name, "reflection_mesh") for name in ("My_Look", "Draft")):
            mirror.reflection_mesh.tolerance = 9.0
            bpy.ops.script.execute_preset(filepath=path, menu_idname="REFLECTION_MESH_PT_presets")
            assert mirror.reflection_mesh.tolerance < 9.0 and scene.reflection_mesh.tolerance == 0.5
    finally:
        assert add(name="My Look", remove_name=True) == {"FINISHED"}


def test_a_preset_of_the_users_own_is_saved_applied_and_removed(scene):
    settings = scene.reflection_mesh
    settings.tolerance, settings.method, settings.light_samples, settings.memory = 3.0, "PARALLEL", 11, 1.5
    add = bpy.ops.reflection_mesh.preset_add
    assert add(name="My Look") == {"FINISHED"}
    path = bpy.utils.preset_find("My_Look", "reflection_mesh")
    assert path and PACKAGE.rpartition(".")[2] in path
    settings.tolerance, settings.method, settings.light_samples, settings.memory = 0.5, "GENERAL", 64, 2.0
    bpy.ops.script.execute_preset(filepath=path, menu_idname="REFLECTION_MESH_PT_presets")
    assert (settings.tolerance, settings.method, settings.light_samples) == (3.0, "PARALLEL", 11)
    # which is the machine's
    assert settings.memory == 2.0
    assert add(name="My Look", remove_name=True) == {"FINISHED"} and not Path(path).exists()
