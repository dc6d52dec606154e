"""Results that cannot be lit, since their mirror is hidden or they are no mesh any more, keep no others from it."""
from __future__ import annotations

import bpy
import parts
import pytest


def in_a_hidden_collection(obj: bpy.types.Object, name: str) -> None:
    bpy.context.scene.collection.children.link(bpy.data.collections.new("Away"))
    bpy.data.collections["Away"].objects.link(obj)
    bpy.context.scene.collection.objects.unlink(obj)
    layer = bpy.context.view_layer.layer_collection.children["Away"]
    setattr(layer if name == "exclude" else layer.collection, name, True)


HIDE = {"eye": lambda obj: obj.hide_set(True), "viewport": lambda obj: setattr(obj, "hide_viewport", True),
        "excluded": lambda obj: in_a_hidden_collection(obj, "exclude"),
        "collection": lambda obj: in_a_hidden_collection(obj, "hide_viewport")}


@pytest.mark.thorough
@pytest.mark.parametrize("how", HIDE)
def test_a_hidden_mirror_is_told_to_be_hidden(scene, how):
    """It was told to have no faces."""
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    wall = parts.add("plane", "Wall", size=6.0, location=(0.0, 3.0, 1.0), rotation=(1.5708, 0.0, 0.0))
    parts.select(scene.leaf, wall)
    other = parts.generate()
    HIDE[how](scene.ball)
    bpy.context.view_layer.update()
    parts.select(scene.result)
    assert parts.refusal(bpy.ops.reflection_mesh.light, samples=1) == (
        "The mirror 'Ball' is hidden: show it in the viewport and in renders.")
    parts.select()
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert other.reflection_mesh.light_material is not None and scene.result.reflection_mesh.light_material is None


def test_a_mirror_that_is_hidden_in_renders_is_lit(scene):
    """As whoever shows its reflection alone does."""
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    scene.ball.hide_render = True
    parts.select()
    assert bpy.ops.reflection_mesh.light(samples=1) == {"FINISHED"}
    assert scene.result.reflection_mesh.light_material is not None


def test_a_result_that_was_made_a_curve_is_told_so(scene, room, blank):
    """Every redraw of the panel filled the console with errors."""
    parts.select(scene.result)
    bpy.ops.object.convert(target="CURVE")
    blank.view_layer.update()
    told = room("addon.interface.prompts").prompt(blank, scene.result).text
    assert told == "This reflection is not a mesh any more. Click Generate Reflection."
    assert "is no mesh any more" in parts.refusal(bpy.ops.reflection_mesh.light, samples=1)
    made = parts.generate()
    assert made != scene.result and made.type == "MESH"
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert not [obj for obj in bpy.data.objects if "Reflection" in obj.name]
