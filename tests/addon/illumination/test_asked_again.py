"""Light that is generated again is what it was asked for to be, where nothing else is given."""
from __future__ import annotations

import bpy
import pytest
from caustic_scene import scene_of


def light() -> bpy.types.Object:
    found, = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "CAUSTICS"]
    return found


def left_out(room) -> bool:
    return room("addon.illumination").leaves_out(bpy.data.objects["Lamp"], bpy.data.objects["Mirror"])


def again(room, way: str) -> None:
    if way == "verb":
        assert room("addon.command_line").run(["caustics"]) == 0
    else:
        assert bpy.ops.reflection_mesh.caustics(way) == {"FINISHED"}


@pytest.mark.thorough
@pytest.mark.parametrize("way", ["EXEC_DEFAULT", "INVOKE_DEFAULT", "verb"])
def test_places_and_own_caustics_are_as_before(blank, room, tmp_path, way):
    scene_of("AREA", size=0.5)
    bpy.ops.reflection_mesh.caustics(eyes=4, leave_out=False)
    assert light().reflection_mesh.eyes == 4 and not left_out(room)
    faces = light().reflection_mesh.faces
    # as whoever opens the file later does
    path = str(tmp_path / "lit.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    again(room, way)
    assert light().reflection_mesh.eyes == 4 and light().reflection_mesh.faces == faces and not left_out(room)
    # what is given wins, and holds from then on
    bpy.ops.reflection_mesh.caustics(eyes=2, leave_out=True)
    assert light().reflection_mesh.eyes == 2 and left_out(room)
    again(room, way)
    assert light().reflection_mesh.eyes == 2 and left_out(room)


def test_each_lamp_keeps_its_own(blank, room):
    floor, mirror, lamp = scene_of("AREA", size=0.5)
    bpy.ops.reflection_mesh.caustics(eyes=3)
    other = lamp.copy()
    other.name = "Other"
    other.location.y += 0.3
    blank.scene.collection.objects.link(other)
    other.select_set(True)
    bpy.ops.reflection_mesh.caustics()
    eyes = {obj.reflection_mesh.lamp.name: obj.reflection_mesh.eyes for obj in blank.scene.objects
            if obj.reflection_mesh.role == "CAUSTICS"}
    assert eyes == {"Lamp": 3, "Other": 1}


def test_the_verb_keeps_and_replaces_cycles_own(blank, room, tmp_path):
    scene_of("AREA", size=0.5)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "lit.blend"))
    run = room("addon.command_line").run
    told = []
    for words in ([], ["--keep-own"], [], ["--replace-own"], []):
        assert run(["caustics", *words]) == 0
        told.append(light().reflection_mesh.keeps_own)
    assert told == [False, True, True, False, False]
