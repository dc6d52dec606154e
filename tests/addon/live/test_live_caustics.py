"""Live keeps the light that mirrors throw right: coarse on the way, at rest what *Generate Caustics* makes."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import parts
import pytest
from caustic_scene import add_lamp, scene_of
from live_scene import PAUSE, TICK, moved, switched_on

MOST_LOOKS = 500    # a light of this scene is made in some twenty


@pytest.fixture
def scene(blank):
    floor, mirror, lamp = scene_of()
    wall = parts.add("cube", "Wall", size=0.2, location=(0.3, 0.0, 1.1))
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    parts.select()
    return SimpleNamespace(floor=floor, mirror=mirror, lamp=lamp, wall=wall, light=bpy.data.objects["Mirror Caustics"])


@pytest.fixture
def clock(scene, room):
    with switched_on(room) as clock:
        yield clock


def shape(obj: bpy.types.Object) -> tuple:
    return (parts.attribute(obj, "position").tobytes(), parts.attribute(obj, "caustic_light").tobytes(),
            parts.corners(obj).tobytes(), tuple(obj.location))


def generated(scene, *lamps) -> tuple:
    parts.select(scene.floor, *(lamps or (scene.lamp,)), scene.mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    parts.select()
    return shape(scene.light)


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["mirror", "lamp", "floor", "wall"])
def test_it_is_right_at_rest(scene, clock, name):
    """One change: light on the way and light at rest, and nothing for what Live itself writes."""
    before, updates = shape(scene.light), dict(clock.updater.updates)
    moved(getattr(scene, name), (0.05, 0.02, 0.05))
    clock.rest()
    assert clock.updater.updates["exact"] == updates["exact"] + 1
    assert clock.updater.updates["coarse"] <= updates["coarse"] + 1
    at_rest = shape(scene.light)
    assert at_rest != before and at_rest == generated(scene)


@pytest.mark.thorough
def test_a_lamp_without_a_move(scene, clock):
    """Its power, its colour; and what nothing depends on: the camera."""
    scene.lamp.data.use_nodes = True
    shader = next(node for node in scene.lamp.data.node_tree.nodes if node.type == "EMISSION")
    clock.rest()
    for change in (lambda: setattr(scene.lamp.data, "energy", 50.0),
                   lambda: setattr(scene.lamp.data, "color", (0.1, 0.2, 0.9)),
                   lambda: setattr(shader.inputs["Strength"], "default_value", 0.5),
                   lambda: setattr(scene.mirror.active_material.node_tree.nodes[0].inputs["Color"], "default_value",
                                   (0.2, 0.9, 0.1, 1.0))):
        before = shape(scene.light)
        change()
        assert "exact" in clock.rest()
        at_rest = shape(scene.light)
        assert at_rest != before and at_rest == generated(scene)
        clock.rest()
    bpy.context.scene.camera.location.x += 0.2
    assert clock.run(PAUSE) == [] and clock.updater.at_rest and not clock.updater.told


def test_frames_count_as_changes(scene, clock):
    scene.mirror.keyframe_insert("rotation_euler", frame=1)
    scene.mirror.rotation_euler[1] += 0.2
    scene.mirror.keyframe_insert("rotation_euler", frame=5)
    clock.rest()
    before = shape(scene.light)
    bpy.context.scene.frame_set(3)
    assert clock.rest()[-1] == "exact" and shape(scene.light) != before
    assert shape(scene.light) == generated(scene)


@pytest.mark.thorough
def test_coarse_while_it_moves_and_as_often_as_can_be(scene, clock, room, monkeypatch):
    """The lamp never rests, and of the light one step is made at each look, whatever else the machine does: coarse
    light comes again and again all the same, since what was begun is finished, and is nothing that is exact."""
    clock.updater.thrown._pace.tolerance = 16.0
    bpy.context.scene.reflection_mesh.tolerance = 0.25
    clock.rest()
    updates, looks, shown = dict(clock.updater.updates), [], {shape(scene.light)}
    monkeypatch.setattr(room("addon.live.thrown"), "BUDGET", 0.0)
    while looks.count("coarse") < 3:
        assert len(looks) < MOST_LOOKS, "What was begun was given up."
        moved(scene.lamp, (0.02 if len(looks) % 2 else -0.03, 0.0, 0.0))
        looks += clock.run(TICK) or [""]
        shown.add(shape(scene.light))
    assert set(looks) == {"coarse", "working"} and len(shown) == 4
    assert clock.updater.updates == {**updates, "coarse": updates["coarse"] + 3}
    monkeypatch.undo()
    assert clock.rest()[-1] == "exact" and shape(scene.light) == generated(scene)


@pytest.mark.thorough
def test_where_no_light_falls_there_is_none(scene, clock):
    """Hidden, switched off, turned away; and back again. Materials stay, so that engines need not begin anew."""
    materials, before = list(scene.light.data.materials), shape(scene.light)
    for dark, light in ((lambda: setattr(scene.lamp, "hide_render", True),
                         lambda: setattr(scene.lamp, "hide_render", False)),
                        (lambda: setattr(scene.lamp.data, "energy", 0.0),
                         lambda: setattr(scene.lamp.data, "energy", 100.0)),
                        (lambda: setattr(scene.mirror, "hide_render", True),
                         lambda: setattr(scene.mirror, "hide_render", False)),
                        (lambda: setattr(scene.floor.location, "z", 9.0),
                         lambda: setattr(scene.floor.location, "z", 0.0))):
        dark()
        clock.rest()
        assert len(scene.light.data.polygons) == 0
        light()
        clock.rest()
        assert shape(scene.light) == before and list(scene.light.data.materials) == materials


@pytest.mark.thorough
def test_only_what_there_is(scene, clock):
    """A lamp whose light was not generated gets none; two that were are both kept right."""
    other = add_lamp("Other", "SUN", (0.0, -1.0, 3.0))
    clock.rest()
    assert [obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"] == ["Mirror Caustics"]
    generated(scene, scene.lamp, other)
    clock.rest()
    moved(scene.mirror, (0.05, 0.0, 0.0))
    clock.rest()
    light = {obj.name: shape(obj) for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"}
    assert len(light) == 2
    generated(scene, scene.lamp, other)
    assert light == {name: shape(bpy.data.objects[name]) for name in light}


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["light", "lamp", "mirror", "floor"])
def test_removing_is_harmless(scene, clock, name):
    moved(scene.mirror, (0.05, 0.0, 0.0))
    clock.run(TICK)
    bpy.data.objects.remove(getattr(scene, name))
    bpy.context.view_layer.update()
    clock.updater.forget()
    clock.rest()


def test_a_receiver_is_removed_and_the_rest_gets_no_light(scene, clock, room, capfd):
    """It filled the console with errors, forever."""
    shelf = parts.add("plane", "Shelf", size=20.0)
    # no light goes there
    scene.floor.location.x = -1000.0
    parts.select(scene.floor, shelf, scene.lamp, scene.mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert {one.object for one in scene.light.reflection_mesh.sources} == {scene.floor, shelf}
    parts.select()
    clock.rest()
    bpy.data.objects.remove(shelf)
    clock.rest()
    assert "Traceback" not in capfd.readouterr().err
    assert not len(scene.light.data.polygons)
    assert [one.object for one in scene.light.reflection_mesh.sources] == [scene.floor]
    assert room("addon.freshness").why_light_is_stale(bpy.context, scene.light) == ""


def test_it_waits_for_object_mode(scene, clock):
    bpy.context.view_layer.objects.active = scene.floor
    bpy.ops.object.mode_set(mode="EDIT")
    moved(scene.mirror)
    assert clock.run(PAUSE) == []
    bpy.ops.object.mode_set(mode="OBJECT")
    assert "exact" in clock.rest() and shape(scene.light) == generated(scene)
