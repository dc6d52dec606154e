"""What plays in a scene with a time of its own, and beside what the scene had before."""
from __future__ import annotations

import bpy
import parts
import pytest
from baked_frames import FRAMES, add_camera, assert_same, bake, expected, lit_scene, operate
from played import played


@pytest.mark.thorough
def test_stretched_time(moving, room, tmp_path):
    """Blender looks for keys at stretched places, and each frame still shows its own reflection and light."""
    lit_scene()
    bpy.context.scene.render.frame_map_new = 230
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "1") == 0
    told = played(out / "scene reflections.blend", FRAMES, tmp_path / "played", ["Mirror Reflection"])
    for frame in FRAMES:
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        wanted = expected(frame, light=True)
        assert_same(told, frame, "Mirror Reflection", {what: wanted[what] for what in ("places", "origin")})
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    light = bpy.data.objects["Mirror Reflection"].material_slots[0].material
    users = [node.image_user for node in light.node_tree.nodes if node.type == "TEX_IMAGE"]
    assert users
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        assert {user.frame_start + user.frame_offset for user in users} == {frame}


def shown(frames) -> dict:
    """The results of the open file that renders show at some frames."""
    scene, found = bpy.context.scene, {}
    for frame in frames:
        scene.frame_set(frame)
        bpy.context.view_layer.update()
        found[frame] = sorted(obj.name for obj in scene.objects
                              if obj.reflection_mesh.role == "REFLECTION" and not obj.hide_render)
    return found


def cuts() -> bpy.types.Object:
    """A second camera, to which markers cut at frame 3."""
    scene = bpy.context.scene
    second = add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    for frame, camera in ((1, scene.camera), (3, second)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    return second


def test_stills_of_other_cameras_do_not_lie_over_what_plays(moving, tmp_path, capfd):
    """One sequence for all cameras, as markers choose them: a still that the second one had is hidden, and told of."""
    scene, second = bpy.context.scene, cuts()
    parts.generate()
    first, scene.camera = scene.camera, second
    parts.select()
    parts.generate()
    scene.camera = first
    scene.frame_set(1)
    operate(tmp_path / "out", samples=0)
    assert "Hidden, since what plays is right for every camera: 'Mirror Reflection Second'." in capfd.readouterr().out
    assert shown(FRAMES) == dict.fromkeys(FRAMES, ["Mirror Reflection"])


@pytest.mark.thorough
def test_a_sequence_for_all_cameras_after_one_for_each(moving, room, tmp_path):
    """Its result is shown at every cut, though keys had shown it to one camera alone."""
    cuts()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--camera", "Camera", "Second") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    assert shown(FRAMES) == {frame: [f"Mirror Reflection {'Second' if frame > 2 else 'Camera'}"] for frame in FRAMES}
    bpy.context.scene.frame_set(1)
    operate(tmp_path / "other", samples=0)
    one, = shown([1])[1]
    assert shown(FRAMES) == dict.fromkeys(FRAMES, [one])
    told = played_again(tmp_path)
    assert [bool(told[f"{frame} {one} hidden"]) for frame in FRAMES] == [False] * 4


def test_a_sequence_for_each_camera_after_one_for_all(moving, tmp_path, capfd):
    """Where a camera looks that has a sequence of its own, the one for all is not seen; elsewhere it is."""
    scene, second = bpy.context.scene, cuts()
    operate(tmp_path / "all", samples=0)
    parts.select(second)
    operate(tmp_path / "one", samples=0, cameras="SELECTED")
    assert "Hidden where cameras have sequences of their own: 'Mirror Reflection'." in capfd.readouterr().out
    assert shown(FRAMES) == {frame: ["Mirror Reflection Second" if frame > 2 else "Mirror Reflection"]
                             for frame in FRAMES}
    scene.frame_set(1)
    operate(tmp_path / "all", samples=0)
    assert shown(FRAMES) == dict.fromkeys(FRAMES, ["Mirror Reflection"])
    scene.timeline_markers.clear()
    scene.camera = second
    operate(tmp_path / "one", samples=0, cameras="SELECTED")
    assert shown(FRAMES) == dict.fromkeys(FRAMES, ["Mirror Reflection Second"])


def played_again(folder) -> dict:
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "again.blend"))
    names = [obj.name for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    return played(folder / "again.blend", FRAMES, folder / "played", names)


def test_a_marker_of_a_camera_that_renders_hide_is_no_cut(moving, room, tmp_path):
    """Blender goes on looking through the one before, and sees its sequence."""
    second = cuts()
    second.hide_render = True
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--camera", "Camera", "Second") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    assert shown(FRAMES) == dict.fromkeys(FRAMES, ["Mirror Reflection Camera"])
    assert bpy.context.scene.camera.name == "Camera"


def test_one_camera_of_two_takes_its_own_result(moving, room, tmp_path):
    """A still of the camera that looks stays, where another one is baked."""
    second = cuts()
    bpy.context.scene.timeline_markers.clear()
    still = parts.generate()
    parts.select()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--camera", "Second") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    results = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    assert {obj.reflection_mesh.camera.name: [modifier.type for modifier in obj.modifiers] for obj in results} == {
        "Camera": [], "Second": ["MESH_SEQUENCE_CACHE", "NODES"]}
    for camera in ("Camera", "Second"):
        bpy.context.scene.camera = bpy.data.objects[camera]
        bpy.context.view_layer.update()
        assert [obj.reflection_mesh.camera.name for obj in results if not obj.hide_render] == [camera]
    assert second and still


def test_what_plays_and_was_renamed_plays_on(moving, room, tmp_path):
    """Also where Blender cuts the name that it was to have."""
    bpy.data.objects["Mirror"].name = "Mirror with as many letters as a name may have in old Blenders"
    bpy.data.objects["Camera"].name = "Camera with as many letters as a name may have in old Blenders"
    cuts()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    cameras = ("--camera", bpy.context.scene.camera.name, "Second")
    assert bake(room, "--output", out, "--light", "0", *cameras) == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    bpy.context.scene.frame_set(1)
    results = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    results[0].name = "Mine"
    names = {obj.name for obj in results}
    bpy.ops.wm.save_mainfile()
    assert bake(room, "--output", out, "--light", "0", *cameras) == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections reflections.blend"))
    assert {obj.name for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"} == names
