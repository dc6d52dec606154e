"""Results whose mirror is there no more, deleted or joined to another object, say so wherever they are asked."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import parts
import pytest

GONE = "its mirror is gone, deleted or joined to another object: clear it"


def joined(mirror: bpy.types.Object) -> None:
    other = parts.add("cube", "Other", location=(3.0, 3.0, 3.0))
    parts.select(mirror, other)
    bpy.ops.object.join()


def deleted(mirror: bpy.types.Object) -> None:
    parts.select(mirror)
    bpy.ops.object.delete()


WAYS = {"joined": joined, "deleted": deleted, "removed": lambda mirror: bpy.data.objects.remove(mirror)}


@pytest.fixture(params=WAYS)
def gone(scene, request) -> SimpleNamespace:
    """The scene, whose mirror has just gone in one of three ways."""
    WAYS[request.param](scene.ball)
    bpy.context.view_layer.update()
    parts.select()
    bpy.context.view_layer.objects.active = None
    return scene


def reported(capfd, operator) -> str:
    capfd.readouterr()
    assert operator("EXEC_DEFAULT") == {"FINISHED"}
    return "".join(capfd.readouterr())


def test_the_panel_says_so_and_offers_no_update(gone, room, blank):
    prompt = room("addon.interface.prompts").prompt
    assert room("addon.freshness").why_stale(blank, gone.result) == GONE
    assert prompt(blank, gone.result).text == "Its mirror or its lamp is gone. Click Clear Reflections."
    text = prompt(blank, None).text
    assert text.startswith("The mirror or the lamp of 'Ball Reflection' is gone.") and "Update" not in text


def test_update_says_so_and_clear_removes_it(gone, capfd):
    told = reported(capfd, bpy.ops.reflection_mesh.update)
    assert f"'Ball Reflection' cannot be made anew: {GONE}." in told and "No reflection is stale" not in told
    assert "cleared" in reported(capfd, bpy.ops.reflection_mesh.clear)
    assert "Ball Reflection" not in bpy.data.objects


def test_generate_and_light_say_so(gone):
    parts.select(gone.result)
    assert "is gone: clear it" in parts.refusal(bpy.ops.reflection_mesh.light)
    assert "clear" in parts.refusal()


def test_light_leaves_it_out(scene, blank):
    """It kept all others from being lit."""
    wall = parts.add("plane", "Wall", size=6.0, location=(0.0, 3.0, 1.0), rotation=(1.5708, 0.0, 0.0))
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    parts.select(scene.leaf, wall)
    other = parts.generate()
    deleted(scene.ball)
    parts.select()
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert other.reflection_mesh.light_material is not None and scene.result.reflection_mesh.light_material is None


@pytest.mark.parametrize(("change", "word"), [(lambda scene: deleted(scene.leaf), "'Leaf' is not in this scene"),
                                              (lambda scene: scene.ball.hide_set(True), "'Ball' is hidden")])
def test_update_says_why_what_is_stale_stays_so(scene, capfd, change, word):
    """It said that nothing was stale."""
    change(scene)
    bpy.context.view_layer.update()
    told = reported(capfd, bpy.ops.reflection_mesh.update)
    assert word in told and "No reflection is stale" not in told


def test_a_camera_that_cannot_be_read_is_no_reason_to_be_right(scene, room, blank):
    """Nothing was stale, since nothing could be told."""
    scene.camera.data.type = "PANO"
    blank.view_layer.update()
    assert room("addon.freshness").why_stale(blank, scene.result) == "the camera has changed"
    assert "panoramic" in parts.refusal(bpy.ops.reflection_mesh.update)
    scene.camera.data.type = "PERSP"
    blank.view_layer.update()
    assert room("addon.freshness").why_stale(blank, scene.result) == ""


def test_undo_brings_the_mirror_back(scene, room, blank):
    bpy.ops.ed.undo_push(message="before")
    joined(scene.ball)
    bpy.ops.ed.undo_push(message="joined")
    assert room("addon.freshness").why_stale(blank, bpy.data.objects["Ball Reflection"]) == GONE
    bpy.ops.ed.undo()
    assert room("addon.freshness").why_stale(bpy.context, bpy.data.objects["Ball Reflection"]) == ""
