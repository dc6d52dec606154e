"""Light that a mirror threw before something moved says so where Live is off, and one click makes it anew."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import scene_of
from live_scene import moved
from test_live_caustics import generated, scene, shape  # noqa: F401


@pytest.fixture
def told(room):
    """Why the light is stale."""
    def asked(light: bpy.types.Object) -> str:
        bpy.context.view_layer.update()
        return room("addon.freshness").why_light_is_stale(bpy.context, light)
    return asked


@pytest.mark.thorough
@pytest.mark.parametrize(("name", "word"), [("mirror", "mirror"), ("lamp", "lamp"), ("floor", "lit"), ("wall", "way")])
def test_stale_light_says_so_and_is_made_anew(scene, told, name, word):  # noqa: F811
    assert told(scene.light) == ""
    before, place = shape(scene.light), getattr(scene, name).location.copy()
    moved(getattr(scene, name), (0.05, 0.02, 0.05))
    assert word in told(scene.light)
    getattr(scene, name).location = place
    assert told(scene.light) == ""
    moved(getattr(scene, name), (0.05, 0.02, 0.05))
    assert bpy.ops.reflection_mesh.update("EXEC_DEFAULT") == {"FINISHED"}
    now = shape(scene.light)
    assert told(scene.light) == "" and now != before and now == generated(scene)
    bpy.context.scene.camera.location.x += 1.0
    assert told(scene.light) == ""


def test_lamps_materials_and_settings_count(scene, told):  # noqa: F811
    for change, word in ((lambda: setattr(scene.lamp.data, "energy", 50.0), "lamp"),
                         (lambda: scene.mirror.data.materials.clear(), "mirror"),
                         (lambda: scene.floor.data.materials.clear(), "lit"),
                         (lambda: setattr(bpy.context.scene.reflection_mesh, "tolerance", 2.0), "settings")):
        change()
        assert word in told(scene.light)
        generated(scene)
        assert told(scene.light) == ""
    white = parts.material("White", "DIFFUSE")
    scene.floor.data.materials.append(white)
    assert "lit" in told(scene.light)
    generated(scene)
    white.name = "Chalk"
    assert told(scene.light) == ""
    for obj in (scene.lamp, scene.mirror, scene.floor, scene.wall):
        obj.name = f"Another {obj.name}"
    assert told(scene.light) == ""


def test_a_file_that_is_opened_again_is_not_stale(blank, told, tmp_path, capfd, room):
    parts.select(*scene_of("SPOT")[:2], bpy.data.objects["Lamp"])
    bpy.context.view_layer.objects.active = bpy.data.objects["Mirror"]
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "lit.blend"))
    light = bpy.data.objects["Mirror Caustics"]
    assert light.reflection_mesh.made_from and told(light) == ""
    bpy.data.objects.remove(bpy.data.objects["Lamp"])
    assert "clear it" in told(light)
    # it told how many faces it had made
    capfd.readouterr()
    assert bpy.ops.reflection_mesh.update("EXEC_DEFAULT") == {"FINISHED"}
    said = "".join(capfd.readouterr())
    assert "'Mirror Caustics' cannot be made anew" in said and "faces of light" not in said
    assert room("addon.interface.prompts").prompt(bpy.context, light).text == (
        "Its mirror or its lamp is gone. Click Clear Reflections.")
    # what cannot be mended is left
    assert bpy.ops.reflection_mesh.update("EXEC_DEFAULT") == {"FINISHED"} and len(light.data.polygons)
