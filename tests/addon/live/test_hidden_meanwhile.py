"""What is hidden from renders or from mirrors after it was reflected or lit, and shown again."""
from __future__ import annotations

import bpy
import parts
import pytest
from caustic_scene import scene_of
from live_scene import add_leaf, shape


def told(room, result) -> str:
    """Why a result is stale."""
    bpy.context.view_layer.update()
    freshness = room("addon.freshness")
    why = freshness.why_light_is_stale if result.reflection_mesh.role == "CAUSTICS" else freshness.why_stale
    return why(bpy.context, result)


def in_collection(obj: bpy.types.Object) -> bpy.types.Collection:
    """A collection of an object's own, in place of those that it was in."""
    made = bpy.data.collections.new("Own")
    bpy.context.scene.collection.children.link(made)
    for other in obj.users_collection:
        other.objects.unlink(obj)
    made.objects.link(obj)
    return made


@pytest.fixture(params=["hide_render", "visible_glossy", "collection"])
def switch(request):
    """Hides an object, or shows it again: from renders, from mirrors, with its collection."""
    def switched(obj: bpy.types.Object, hidden: bool) -> None:
        if request.param == "collection":
            obj.users_collection[0].hide_render = hidden
        else:
            setattr(obj, request.param, hidden == (request.param == "hide_render"))
    return switched


def test_a_reflection_of_what_is_hidden_now_is_stale(scene, room, switch):
    """And right again where it is shown again; the mirror itself may be hidden, so that the result alone is seen."""
    in_collection(scene.leaf)
    other = parts.add("cube", "Other", size=0.3, location=(-1.5, -2.0, 0.5))
    parts.select(scene.leaf, other, scene.ball)
    parts.generate()
    both = shape(scene.result)
    assert told(room, scene.result) == ""
    switch(scene.leaf, True)
    assert told(room, scene.result) == "a reflected object has changed"
    switch(scene.leaf, False)
    assert told(room, scene.result) == ""
    scene.ball.hide_render = True
    assert told(room, scene.result) == ""
    scene.ball.hide_render = False
    switch(scene.leaf, True)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    assert told(room, scene.result) == "" and shape(scene.result) != both


def test_light_on_what_is_hidden_now_is_stale(blank, room, switch):
    floor, mirror, lamp = scene_of()
    leaf = add_leaf()
    in_collection(leaf)
    parts.select(floor, leaf, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    light = bpy.data.objects["Mirror Caustics"]
    assert told(room, light) == ""
    switch(leaf, True)
    # what no mirror shows is lit as ever, as Cycles has it
    assert told(room, light) == ("what is lit has changed" if leaf.visible_glossy else "")
    switch(leaf, False)
    assert told(room, light) == ""


@pytest.mark.parametrize("hidden", ["hide_render", "hide_viewport", "collection"])
def test_light_of_a_lamp_that_is_hidden_now_is_stale(blank, room, hidden):
    """Of a lamp that is hidden nothing is thrown, as in Cycles; it is there again when the lamp is shown."""
    floor, mirror, lamp = scene_of()
    holder, name = (in_collection(lamp), "hide_render") if hidden == "collection" else (lamp, hidden)
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    light = bpy.data.objects["Mirror Caustics"]
    bright = shape_of_light(light)
    parts.select()
    setattr(holder, name, True)
    assert told(room, light) == "the lamp has changed"
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    assert told(room, light) == "" and not len(light.data.polygons)
    setattr(holder, name, False)
    assert told(room, light) == "the lamp has changed"
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    assert told(room, light) == "" and shape_of_light(light) == bright


def test_what_was_hidden_is_lit_again_when_it_is_shown(blank, room):
    """As reflections show it again: light that was made anew meanwhile has not forgotten what it falls on."""
    floor, mirror, lamp = scene_of()
    box = parts.add("cube", "Box", size=0.4, location=(0.2, 0.0, 0.2))
    parts.select(floor, box, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    light = bpy.data.objects["Mirror Caustics"]
    whole = shape_of_light(light)
    box.hide_render = True
    assert told(room, light) and bpy.ops.reflection_mesh.update() == {"FINISHED"}
    assert told(room, light) == "" and shape_of_light(light) != whole
    box.hide_render = False
    assert told(room, light) == "what is lit has changed"
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and told(room, light) == ""
    assert shape_of_light(light) == whole


def shape_of_light(light: bpy.types.Object) -> tuple:
    return (parts.attribute(light, "position").tobytes(), parts.attribute(light, "caustic_light").tobytes(),
            parts.corners(light).tobytes(), parts.attribute(light, "source_object").tobytes())
