"""Live, while what it works on is renamed, removed, hidden, undone, or seen by another camera."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import parts
import pytest
from live_scene import TICK, generated, shape


def test_renaming_is_harmless(scene, clock):
    for obj, name in ((scene.result, "R"), (scene.ball, "B"), (scene.leaf, "L"), (scene.camera, "C")):
        obj.name = name
    scene.camera.location.x += 0.1
    assert clock.run() == ["followed"]
    assert clock.rest()[-1] == "exact"


@pytest.mark.parametrize("name", ["leaf", "ball", "result"])
@pytest.mark.parametrize("working", [False, True])
def test_removing_is_harmless(scene, clock, name, working, room, monkeypatch):
    if working:
        # new results are under way, and hold what goes
        monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
        clock.updater.following.tracks = []
        scene.camera.location.x += 0.2
        assert clock.run(2 * TICK) and clock.updater._work is not None
    bpy.data.objects.remove(getattr(scene, name))
    clock.rest()
    assert clock.updater.told
    assert ("Ball Reflection" in bpy.data.objects) == (name != "result")


@pytest.mark.parametrize("name", ["leaf", "ball", "result"])
def test_removing_what_follows_is_harmless(scene, clock, name, room, monkeypatch):
    """Between two turns of vertices that are on their way."""
    monkeypatch.setattr(room("core.support.stepping"), "INTERVAL", -1.0)
    monkeypatch.setattr(room("core.following"), "AT_ONCE", 4)
    scene.camera.location.x += 0.1
    assert clock.run() == ["working"] and clock.updater.following.is_under_way
    bpy.data.objects.remove(getattr(scene, name))
    clock.rest()
    assert clock.updater.told and "unexpected" not in clock.updater.told.lower()
    assert ("Ball Reflection" in bpy.data.objects) == (name != "result")


def test_a_camera_that_is_removed_is_told(scene, clock):
    bpy.data.objects.remove(scene.camera)
    clock.rest()
    assert "camera" in clock.updater.told


def coarse_work_begun(scene, clock, room, monkeypatch) -> None:
    """The camera has moved, nothing can follow, and a look at a time is taken at new results."""
    monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
    clock.updater.following.tracks = []
    scene.camera.location.x += 0.2
    assert clock.run(2 * TICK) and not clock.updater._work.exact


@pytest.mark.parametrize("working", [False, True])
def test_results_of_another_camera_stay_what_they_are(scene, clock, room, monkeypatch, working):
    """Each camera's results show its own view and its own objects, also where it becomes the scene's on the way."""
    first = bpy.context.scene.camera
    cube = parts.add("cube", "Box", size=0.5, location=(-1.5, -2.0, 1.0))
    bpy.ops.object.camera_add(location=(0.4, -6.0, 1.0), rotation=(1.45, 0.0, 0.0))
    bpy.context.scene.camera = second = bpy.context.object
    # on the way what has other triangles could not follow anyway
    parts.select(cube if working else scene.leaf, scene.ball)
    other = parts.generate()
    bpy.context.scene.camera = first
    parts.select()
    clock.rest()
    before = shape(scene.result), scene.result.reflection_mesh.made_from
    if working:
        coarse_work_begun(scene, clock, room, monkeypatch)
    bpy.context.scene.camera = second
    clock.rest()
    assert [source.object for source in other.reflection_mesh.sources] == [cube if working else scene.leaf]
    assert (shape(scene.result), scene.result.reflection_mesh.made_from) == before


def test_what_cannot_follow_is_made_anew_on_the_way_by_a_coarse_files_settings_too(scene, clock, room, monkeypatch):
    monkeypatch.setattr(room("addon.live.track").Track, "of", classmethod(lambda cls, *arguments: None))
    bpy.context.scene.reflection_mesh.tolerance = 4.0
    scene.camera.location.x += 0.1
    clock.rest()
    assert not clock.updater.following.tracks
    monkeypatch.setattr(room("addon.live.work"), "BUDGET", 0.0)
    before = sum(clock.updater.updates.values())
    for _ in range(60):
        scene.camera.location.x += 0.002
        clock.run()
    assert sum(clock.updater.updates.values()) > before


@pytest.mark.thorough
def test_what_is_hidden_for_a_while_comes_back(scene, clock, room):
    """In Live and with the button that mends what is stale."""
    box = parts.add("cube", "Box", size=0.5, location=(-1.5, -2.0, 1.0))
    parts.select(box, scene.leaf, scene.ball)
    parts.generate()
    parts.select()
    clock.rest()
    whole = shape(scene.result)
    for switch in ("hide_viewport", "hide_render"):
        setattr(box, switch, True)
        clock.rest()
        assert shape(scene.result) != whole
        setattr(box, switch, False)
        clock.rest()
        assert shape(scene.result) == whole
    bpy.context.window_manager.reflection_mesh_live.on = False
    why = room("addon.freshness").why_stale
    for hidden in (True, False):
        box.hide_viewport = hidden
        bpy.context.view_layer.update()
        assert "object" in why(bpy.context, scene.result)
        assert bpy.ops.reflection_mesh.update() == {"FINISHED"}
        assert (shape(scene.result) == whole) != hidden and not why(bpy.context, scene.result)
    # what is deleted is not waited for
    bpy.data.objects.remove(box)
    bpy.ops.reflection_mesh.update()
    assert [source.object for source in scene.result.reflection_mesh.sources] == [scene.leaf]


@pytest.mark.thorough
@pytest.mark.parametrize("way", ["Live", "button", "script"])
def test_what_loses_its_light_shows_a_preview_where_somebody_looks(scene, clock, way, room, monkeypatch):
    """Check the case that Update cannot light the result again."""
    def refused(*_):
        raise room("core").ReflectionError("Cycles is not available.")
        yield
    if way != "Live":
        bpy.context.window_manager.reflection_mesh_live.on = False
    scene.leaf.data.materials.append(parts.material("Green", "DIFFUSE"))
    parts.select(scene.leaf, scene.ball)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=1)
    bpy.context.view_layer.update()
    scene.camera.location.x += 0.3
    # as in a file that was opened again: no texel is found again by the point that it shows
    room("addon.lighting.known_texels")._known.clear()
    if way == "Live":
        clock.rest()
    else:
        monkeypatch.setattr(room("addon.live.update"), "lit_again", refused)
        # in the background none is pressed
        operator = room("addon.live.update").REFLECTION_MESH_OT_update
        pressed = SimpleNamespace(execute=lambda context: {"FINISHED"})
        operator.invoke(pressed, bpy.context, None)
        monkeypatch.setattr(operator, "_pressed", pressed._pressed if way == "button" else operator._pressed)
        bpy.ops.reflection_mesh.update()
    shown, = [slot.material.name for slot in scene.result.material_slots]
    assert shown.split(".")[0] == ("Green" if way == "script" else "Green Preview")


def test_undo_and_redo_bring_the_right_results(scene, clock):
    bpy.context.preferences.edit.use_global_undo = True
    bpy.ops.ed.undo_push(message="before")
    clock.rest()
    scene.camera.location.x += 0.5
    bpy.ops.ed.undo_push(message="moved")
    assert clock.run() == ["followed"]
    for back in (bpy.ops.ed.undo, bpy.ops.ed.redo):
        back()
        clock.rest()
        objects = bpy.context.scene.objects
        parts.select()
        assert shape(objects["Ball Reflection"]) == generated(objects["Leaf"], objects["Ball"])


@pytest.mark.parametrize("way", ["new results", "following"])
def test_opening_a_file_in_the_middle_ends_it(scene, clock, room, monkeypatch, tmp_path, way):
    """While new results are made, or vertices are on their way; the file that is opened is as it was saved."""
    path, before = str(tmp_path / "scene.blend"), shape(scene.result)
    bpy.ops.wm.save_as_mainfile(filepath=path)
    if way == "new results":
        coarse_work_begun(scene, clock, room, monkeypatch)
    else:
        monkeypatch.setattr(room("core.support.stepping"), "INTERVAL", -1.0)
        monkeypatch.setattr(room("core.following"), "AT_ONCE", 4)
        scene.camera.location.x += 0.1
        assert clock.run() == ["working"] and clock.updater.following.is_under_way
    bpy.ops.wm.open_mainfile(filepath=path)
    switch = room("addon.live.switch")
    assert not bpy.context.window_manager.reflection_mesh_live.on and switch.updater is None
    assert switch._tick() is None and shape(bpy.data.objects["Ball Reflection"]) == before


def test_removing_the_extension_in_the_middle_ends_it(scene, room, clock):
    scene.camera.location.x += 0.1
    clock.updater.following.tracks = []
    clock.run()
    live = room("addon.live")
    live.unregister()
    try:
        assert not hasattr(bpy.context.window_manager, "reflection_mesh_live")
        scene.camera.location.x += 0.1
        bpy.context.view_layer.update()
        assert room("addon.live.switch")._tick() is None
    finally:
        live.register()
    assert not bpy.context.window_manager.reflection_mesh_live.on
