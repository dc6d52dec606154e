"""Frames in which a mirror shows nothing, or throws none: they are empty, and what is so in all of them is named."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from baked_frames import bake, operate
from caustic_scene import scene_of

TOLD = "Empty in every baked frame, since hidden, out of sight or with nothing to show: {}."


def hide(obj: bpy.types.Object, frame: int, gone: bool) -> None:
    obj.hide_render = gone
    obj.keyframe_insert("hide_render", frame=frame)


def move_out_of_view(obj: bpy.types.Object, frame: int, gone: bool) -> None:
    obj.delta_location[0] = 80.0 if gone else 0.0
    obj.keyframe_insert("delta_location", frame=frame)


def shrink(obj: bpy.types.Object, frame: int, gone: bool) -> None:
    obj.scale = (1.0 - gone,) * 3
    obj.keyframe_insert("scale", frame=frame)


def build(obj: bpy.types.Object, frame: int, gone: bool) -> None:
    """It has no faces in some frames."""
    mask = obj.modifiers.get("Mask") or obj.modifiers.new("Mask", "MASK")
    mask.vertex_group = (obj.vertex_groups.get("None") or obj.vertex_groups.new(name="None")).name
    mask.show_viewport = mask.show_render = gone
    for switch in ("show_viewport", "show_render"):
        mask.keyframe_insert(switch, frame=frame)


def faces_shown(frame: int, name: str = "Mirror Reflection") -> int:
    bpy.context.scene.frame_set(frame)
    return len(bpy.data.objects[name].evaluated_get(bpy.context.evaluated_depsgraph_get()).data.polygons)


@pytest.mark.thorough
@pytest.mark.parametrize("goes", [hide, move_out_of_view, shrink, build])
@pytest.mark.parametrize("who", ["Mirror", "Box"])
def test_a_frame_without_anything_to_see_is_empty_and_the_others_are_baked(moving, tmp_path, capfd, who, goes):
    """Of the one mirror, or the one thing that it shows: nobody is told, whichever frame is the first."""
    for frame in (1, 2, 3):
        goes(bpy.data.objects[who], frame, frame != 2)
    operate(tmp_path / "out", frames="1-3", samples=0)
    assert [faces_shown(frame) > 0 for frame in (1, 2, 3)] == [False, True, False]
    told = capfd.readouterr().out
    assert "Empty in every" not in told and "Warning: " not in told


def test_what_is_empty_in_every_frame_is_named(moving, room, tmp_path, capfd):
    """By operator and verb, of several mirrors those alone, and of frames that were there already too; a farm's chunk
    says nothing of what others may have."""
    for name in ("First Mirror", "Other"):
        mirror = parts.add("plane", name, size=1.5, location=(0.0, 0.5, 1.0), rotation=(np.pi / 2, 0.0, 0.0))
        mirror.reflection_mesh.role, mirror.hide_render = "MIRROR", True
    operate(tmp_path / "out", frames="1-2", samples=0)
    told = capfd.readouterr().out
    assert f"Warning: {TOLD.format(repr('First Mirror') + ', ' + repr('Other'))}" in told
    bpy.ops.reflection_mesh.clear()
    common = ("--output", tmp_path / "out", "--light", "0")
    assert bake(room, *common, "--frames", "1-2", "--frames-only") == 0
    assert "Empty in every" not in capfd.readouterr().out
    bpy.data.objects["Other"].hide_render = False
    assert bake(room, *common, "--frames", "1-3") == 0
    assert TOLD.format("'First Mirror'") in capfd.readouterr().out.splitlines()


def test_what_one_camera_sees_is_not_empty(moving, room, tmp_path, capfd):
    """Of two sequences: the other camera looks away."""
    camera = bpy.context.scene.camera.copy()
    camera.name, camera.rotation_euler = "Away", (1.45, 0.0, np.pi)
    bpy.context.scene.collection.objects.link(camera)
    common = ("--output", tmp_path / "out", "--light", "0", "--frames", "1-2")
    assert bake(room, *common, "--camera", "Away", "Camera") == 0
    assert "Empty in every" not in capfd.readouterr().out
    assert bake(room, *common, "--camera", "Away", "--overwrite") == 0
    assert TOLD.format("'Mirror'") in capfd.readouterr().out.splitlines()


@pytest.fixture
def thrown(blank) -> bpy.types.Object:
    """A mirror that throws light of a lamp on the floor, and one that throws some too, which is returned."""
    floor, mirror, lamp = scene_of()
    other = parts.add("plane", "Small", size=0.6, location=(0.9, 0.8, 0.7), rotation=(0.0, -np.pi / 2, 0.0))
    other.data.materials.append(mirror.active_material)
    parts.select(floor, lamp, other, mirror)
    return other


@pytest.mark.thorough
@pytest.mark.parametrize("goes", [hide, shrink, build])
def test_light_that_is_not_thrown_in_one_frame(thrown, tmp_path, capfd, goes):
    """Another mirror's light is there in each, and none of this one's where it has gone."""
    for frame in (1, 2, 3):
        goes(thrown, frame, frame != 2)
    operate(tmp_path / "out", frames="1-3", what="CAUSTICS")
    assert [faces_shown(frame, "Small Caustics") > 0 for frame in (1, 2, 3)] == [False, True, False]
    assert all(faces_shown(frame, "Mirror Caustics") for frame in (1, 2, 3))
    assert "Empty in every" not in capfd.readouterr().out


def test_light_that_is_never_thrown_is_named(thrown, tmp_path, capfd):
    thrown.scale = (0.0, 0.0, 0.0)
    operate(tmp_path / "out", frames="1-2", what="CAUSTICS")
    assert f"Warning: {TOLD.format(repr('Small Caustics'))}" in capfd.readouterr().out
