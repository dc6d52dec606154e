"""A file that version 0.1 of this extension wrote, in Blender 4.2: what it holds is taken over by every Blender since.

It holds a box before a mirror and another one, both with a result of tolerance 4, the second one with the placement
VIRTUAL, and the settings of the scene. It was written by the zip of that version.
"""
from pathlib import Path

import bpy
import parts
import pytest

FILE = Path(__file__).parents[2] / "inputs" / "version_0_1.blend"
SETTINGS = {"tolerance": 4.0, "placement": "SURFACE", "method": "GENERAL", "depth": 2, "memory": 3.0}


@pytest.fixture
def earlier():
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    return bpy.context.scene


def test_settings_roles_and_results_are_taken_over(earlier):
    settings = earlier.reflection_mesh
    assert {name: getattr(settings, name) for name in SETTINGS} == SETTINGS
    # what that version did not have is as in a new file
    assert (settings.light_samples, settings.hidden_faces) == (64, False)
    assert [earlier.objects[name].reflection_mesh.role for name in ("Box", "Mirror", "Window")] == [
        "DIFFUSE", "MIRROR", "MIRROR"]
    for name in ("Mirror", "Window"):
        record = earlier.objects[f"{name} Reflection"].reflection_mesh
        assert record.role == "REFLECTION" and record.mirror == earlier.objects[name]
        assert [source.object.name for source in record.sources] == ["Box"]


def test_results_are_made_anew_in_place_by_the_files_settings(earlier):
    names = {obj.name for obj in earlier.objects}
    for name in ("Mirror Reflection", "Window Reflection"):
        result = earlier.objects[name]
        parts.select(result)
        assert bpy.ops.reflection_mesh.generate() == {"FINISHED"}
        assert {obj.name for obj in earlier.objects} == names
        assert len(result.data.polygons) == result.reflection_mesh.faces > 0
    # on the surface now, as the file says: the mirror is no window any more
    assert earlier.objects["Window"].visible_camera


def test_clear_restores_what_they_changed(earlier):
    window = earlier.objects["Window"]
    assert not window.visible_camera
    parts.select()
    bpy.context.view_layer.objects.active = None
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert window.visible_camera and {obj.name for obj in earlier.objects} == {"Camera", "Box", "Mirror", "Window"}
