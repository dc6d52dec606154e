"""Results that are stale say so, and why."""
from __future__ import annotations

import json
from types import SimpleNamespace

import bpy
import parts
import pytest
from drawn_lines import add_line_art
from live_scene import generated, shape


def test_a_stale_result_says_so(scene, room):
    why = room("addon.freshness").why_stale
    told = lambda: (bpy.context.view_layer.update(), why(bpy.context, scene.result))[1]  # noqa: E731
    assert told() == ""
    for obj, word in ((scene.camera, "camera"), (scene.ball, "mirror"), (scene.leaf, "object")):
        obj.location.y += 1.5
        assert word in told()
        obj.location.y -= 1.5
        assert told() == ""
    for mend in (parts.generate, bpy.ops.reflection_mesh.update):
        scene.camera.location.y -= 0.5
        assert told()
        parts.select(scene.leaf, scene.ball)
        mend()
        assert told() == ""
    # whatever is selected, and nothing that is right as it is
    parts.select(scene.camera)
    before = shape(scene.result)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and shape(scene.result) == before
    scene.camera.location.y += 0.5
    assert told() and bpy.ops.reflection_mesh.update() == {"FINISHED"} and told() == ""
    assert shape(scene.result) == generated(scene.leaf, scene.ball)
    scene.leaf.data.vertices[0].co.z += 0.1
    scene.leaf.data.update()
    assert "object" in told()
    scene.camera.data.lens = 35.0
    assert "camera" in told()
    scene.result.reflection_mesh.made_from = "{}"
    assert told() == ""


def test_what_live_leaves_coarse_is_stale(scene, clock, room):
    scene.camera.location.x += 0.1
    assert clock.run() == ["followed"]
    bpy.context.window_manager.reflection_mesh_live.on = False
    bpy.context.view_layer.update()
    assert room("addon.freshness").why_stale(bpy.context, scene.result)


def told(room, result) -> str:
    """Why a result is stale."""
    bpy.context.view_layer.update()
    return room("addon.freshness").why_stale(bpy.context, result)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["tolerance", "placement", "hidden_faces"])
@pytest.mark.parametrize("own", [False, True])
def test_other_settings_make_it_stale(scene, room, name, own):
    """Those that hold for its mirror; what was given to one run, and what only bounds the work, do not."""
    record = scene.ball.reflection_mesh if own else bpy.context.scene.reflection_mesh
    scene.ball.reflection_mesh.own_settings = own
    assert told(room, scene.result) == ""
    before = getattr(record, name)
    setattr(record, name, {"tolerance": 3.0, "placement": "SURFACE", "hidden_faces": True}[name])
    record.memory = 1.0
    assert "settings" in told(room, scene.result)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and told(room, scene.result) == ""
    setattr(record, name, before)
    assert told(room, scene.result)
    parts.select(scene.leaf, scene.ball)
    parts.generate(tolerance=7.0)
    assert told(room, scene.result) == ""


def test_settings_that_no_longer_hold_do_not_count(scene, room):
    """The scene's, where the mirror has its own."""
    scene.ball.reflection_mesh.own_settings = True
    bpy.context.scene.reflection_mesh.tolerance = 3.0
    assert told(room, scene.result) == ""
    scene.ball.reflection_mesh.own_settings = False
    assert "settings" in told(room, scene.result)


@pytest.mark.parametrize("how", ["line art", "freestyle"])
def test_lines_that_are_drawn_now_make_it_stale(scene, room, how):
    """And no longer drawn ones do not; the frames of an animation are no other matter."""
    render, freshness = bpy.context.scene.render, room("addon.freshness")
    chosen = room("addon.reading").Participants([scene.ball], [scene.leaf], [])
    frame = lambda: freshness.frame_origin(bpy.context, chosen, False)  # noqa: E731
    without = frame()
    if how == "line art":
        drawn, _ = add_line_art(scene.result)
    else:
        render.use_freestyle = True
    assert told(room, scene.result) == "lines are drawn now"
    assert freshness.frame_difference(without, frame()) == "lines are drawn now"
    assert freshness.frame_difference(frame(), without) == ""
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and told(room, scene.result) == ""
    if how == "line art":
        bpy.data.objects.remove(drawn)
    else:
        render.use_freestyle = False
    assert told(room, scene.result) == ""


def test_of_an_old_file_lines_are_told_only_where_some_are_drawn(scene, room):
    """Whose records know nothing of them."""
    known = json.loads(scene.result.reflection_mesh.made_from)
    del known["lines"]
    scene.result.reflection_mesh.made_from = json.dumps(known)
    assert told(room, scene.result) == ""
    add_line_art(scene.result)
    assert told(room, scene.result) == "lines are drawn now"


def test_exchanged_materials_make_it_stale(scene, room):
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    assert "materials" in told(room, scene.result)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"} and told(room, scene.result) == ""
    assert [material.name for material in scene.result.data.materials] == ["Green"]
    # what a result without previews shows is the material itself
    scene.leaf.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)
    assert told(room, scene.result) == ""
    # what lets light through keeps the faces that it hides
    scene.leaf.data.materials[0].node_tree.nodes.new("ShaderNodeBsdfTransparent")
    assert "materials" in told(room, scene.result)


def test_renamed_materials_do_not_make_it_stale(scene, room):
    green = parts.material("Green", "DIFFUSE")
    scene.leaf.data.materials.append(green)
    assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
    green.name = "Grass"
    assert told(room, scene.result) == ""
    scene.leaf.material_slots[0].material = parts.material("Lamp", "EMISSION")
    assert told(room, scene.result) == "materials have been exchanged"
    scene.leaf.material_slots[0].material = None
    assert told(room, scene.result) == "materials have been exchanged"


@pytest.mark.parametrize("change", ["value", "ramp", "link", "tint", "nothing"])
def test_previews_go_stale_with_colours(scene, room, change):
    green, glass = parts.material("Green", "DIFFUSE"), parts.material("Glass", "GLOSSY")
    scene.leaf.data.materials.append(green)
    scene.ball.data.materials.append(glass)
    tree = green.node_tree
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    parts.select(scene.leaf, scene.ball)
    parts.generate(preview=True)
    assert told(room, scene.result) == ""
    if change == "value":
        tree.nodes[0].inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)
    elif change == "ramp":
        ramp.color_ramp.elements[0].color = (1.0, 0.0, 0.0, 1.0)
    elif change == "link":
        tree.links.new(ramp.outputs[0], tree.nodes[0].inputs["Color"])
    elif change == "tint":
        glass.node_tree.nodes[0].inputs["Color"].default_value = (1.0, 0.2, 0.2, 1.0)
    else:
        ramp.location.x += 30.0
    assert ("colours" in told(room, scene.result)) == (change != "nothing")
    bpy.ops.reflection_mesh.update()
    assert told(room, scene.result) == ""


def test_live_shows_other_materials_and_the_colours_of_previews(scene, clock):
    green = parts.material("Green", "DIFFUSE")
    scene.leaf.data.materials.append(green)
    assert clock.rest()[-1] == "exact"
    assert [material.name for material in scene.result.data.materials] == ["Green"]
    exact = clock.updater.updates["exact"]
    green.node_tree.nodes[0].inputs["Color"].default_value = (0.0, 1.0, 0.0, 1.0)
    clock.rest()
    assert clock.updater.updates["exact"] == exact
    parts.select(scene.leaf, scene.ball)
    parts.generate(preview=True)
    clock.rest()
    green.node_tree.nodes[0].inputs["Color"].default_value = (1.0, 0.0, 0.0, 1.0)
    exact = clock.updater.updates["exact"]
    clock.rest()
    assert clock.updater.updates["exact"] == exact + 1
    shown = scene.result.material_slots[0].material
    assert (1.0, 0.0, 0.0, 1.0) in [tuple(socket.default_value) for node in shown.node_tree.nodes
                                    for socket in node.inputs if socket.type == "RGBA"]


def searched(layer: bpy.types.ViewLayer) -> list:
    return [obj for obj in layer.objects if obj.reflection_mesh.role in {"REFLECTION", "CAUSTICS"}]


def test_results_are_known_without_a_search(scene, room, blank):
    """After whatever may bring one or take one away, they are those that a search finds."""
    reading, layer = room("addon.reading"), blank.view_layer
    found = []

    def same() -> None:
        # undo exchanges view layers
        now = bpy.context.view_layer
        now.update()
        assert reading.known_results(bpy.context.scene, now) == searched(now)
        found.append(len(searched(now)))
    same()
    parts.select(scene.result)
    bpy.ops.object.duplicate()
    copy = bpy.context.object
    same()
    copy.name = "Another name"
    same()
    collection = bpy.data.collections.new("Folder")
    blank.scene.collection.children.link(collection)
    collection.objects.link(copy)
    blank.scene.collection.objects.unlink(copy)
    same()
    layer.layer_collection.children["Folder"].exclude = True
    same()
    layer.layer_collection.children["Folder"].exclude = False
    same()
    copy.reflection_mesh.role = "IGNORE"
    same()
    copy.reflection_mesh.role = "REFLECTION"
    same()
    for role in ("REFLECTION", "DIFFUSE"):
        scene.leaf.reflection_mesh.role = role
        same()
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    bpy.data.objects.remove(copy)
    same()
    bpy.ops.ed.undo_push(message="removed")
    bpy.ops.ed.undo()
    same()
    bpy.ops.ed.redo()
    same()
    assert found == [1, 2, 2, 2, 1, 2, 1, 2, 3, 2, 1, 2, 1]
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert reading.known_results(bpy.context.scene, bpy.context.view_layer) == []


def test_a_result_that_was_removed_just_now_is_not_asked(scene, room, blank):
    reading = room("addon.reading")
    assert reading.known_results(blank.scene, blank.view_layer) == [scene.result]
    bpy.data.objects.remove(scene.result)
    assert reading.known_results(blank.scene, blank.view_layer) == []


def test_the_panel_and_live_search_nothing(scene, room, blank, monkeypatch):
    """Whatever number of objects there is, at redraws as at updates."""
    known = room("addon.reading.known_results")
    blank.view_layer.update()
    assert room("addon.live").kept_results(blank) == [scene.result]
    searches = []
    forget = known.forget_known
    monkeypatch.setattr(known, "forget_known", lambda *_: (searches.append(1), forget()))
    for _ in range(3):
        scene.camera.location.x += 0.1
        blank.view_layer.update()
        context = SimpleNamespace(scene=SimpleNamespace(session_uid=blank.scene.session_uid, camera=scene.camera),
                                  view_layer=SimpleNamespace(name=blank.view_layer.name))
        # nothing that this context does not have is asked
        assert room("addon.live").kept_results(context) == [scene.result]
    assert not searches
