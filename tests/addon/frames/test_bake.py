"""Frames that play without the extension show what `generate` and `light` make of them; whatever ends a bake, what is
done stays and the rest follows."""
from __future__ import annotations

import json

import bpy
import numpy as np
import parts
import pytest
from baked_frames import FRAMES, add_camera, assert_same, bake, expected, lit_scene, names, operate
from played import generated, played


@pytest.mark.feature("frames")
def test_frames_play_without_the_extension(moving, room, tmp_path):
    """Bit for bit: places, faces, materials and whatever else the result knows."""
    box = bpy.data.objects["Box"].data
    if bpy.app.version >= (5, 0, 0):
        box.attributes.new("freestyle_edge", "BOOLEAN", "EDGE").data.foreach_set("value", np.arange(12) % 3 == 0)
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    before = moving.read_bytes()
    assert bake(room, "--output", out, "--light", "0") == 0
    assert moving.read_bytes() == before
    assert names(out) == {"scene reflections.blend", *(f"Frame.{frame:04d}.json" for frame in FRAMES),
                          *(f"Mirror_Reflection.{frame:04d}.usdc" for frame in FRAMES)}
    told = played(out / "scene reflections.blend", [*FRAMES[::-1], 2], tmp_path / "played", ["Mirror Reflection"])
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    counts = set()
    # before 5.0 Freestyle's marks are no attributes, and so out of the reach of nodes
    edge_marks = [": EDGE BOOLEAN sharp_edge", ": EDGE BOOLEAN freestyle_edge"][:1 + (bpy.app.version >= (5, 0, 0))]
    for frame in FRAMES:
        wanted = expected(frame)
        assert {": POINT FLOAT_VECTOR reflected_position", ": CORNER FLOAT_COLOR My Colour", ": CORNER FLOAT2 UVMap",
                ": FACE INT source_face", *edge_marks} <= set(wanted)
        assert all(0 < wanted[mark].sum() < len(wanted[mark]) for mark in edge_marks)
        assert set(wanted["materials"]) == {"Plain", "Red one"}
        counts.add(wanted["places"].tobytes())
        assert_same(told, frame, "Mirror Reflection", wanted)
    assert len(counts) == len(FRAMES)


def psnr(one: np.ndarray, other: np.ndarray) -> float:
    return 10.0 * np.log10(1.0 / np.mean((np.clip(one, 0.0, 1.0) - np.clip(other, 0.0, 1.0)) ** 2))


@pytest.mark.thorough
def test_light_plays_too(moving, room, tmp_path):
    """Each frame shows the light that Cycles traces in the mirror there, also where only every third is baked."""
    lit_scene()
    # seen in the mirror alone
    bpy.data.objects["Box"].visible_camera = False
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--frames", "1,4,5", "--light", "64") == 0
    assert {f"Light.{frame:04d}.exr" for frame in (1, 4, 5)} <= names(out)
    truth = played(moving, [1, 4, 5], tmp_path / "truth", picture=64)
    told = played(out / "scene reflections.blend", [4, 5, 3, 1], tmp_path / "played", picture=64)
    shown = {frame: told[f"{frame} picture"] for frame in (1, 3, 4, 5)}
    for frame in (1, 4, 5):
        right = {other: psnr(shown[frame], truth[f"{other} picture"]) for other in (1, 4, 5)}
        assert right[frame] > 33.0 and all(right[frame] > right[other] + 6.0 for other in right if other != frame)
    # between baked frames the last one stays
    assert psnr(shown[3], shown[1]) > psnr(shown[3], truth["4 picture"]) + 3.0
    unlit = tmp_path / "unlit"
    assert bake(room, "--output", unlit, "--frames", "4", "--light", "0") == 0
    dark = played(unlit / "scene reflections.blend", [4], tmp_path / "dark", picture=64)["4 picture"]
    assert psnr(dark, truth["4 picture"]) < psnr(shown[4], truth["4 picture"]) - 6.0


@pytest.mark.thorough
def test_where_nothing_is_seen_nothing_is_shown(moving, room, tmp_path):
    """The cube leaves, or is hidden: those frames are baked, and empty."""
    cube = bpy.data.objects["Box"]
    for frame, hidden in ((1, False), (2, True), (3, False)):
        cube.hide_render = hidden
        cube.keyframe_insert("hide_render", frame=frame)
    for frame, place in ((3, (0.3, -1.5, 1.0)), (4, (0.0, 40.0, 1.0))):
        cube.location = place
        cube.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out) == 0
    told = played(out / "scene reflections.blend", FRAMES, tmp_path / "played", ["Mirror Reflection"])
    assert [len(told[f"{frame} Mirror Reflection places"]) > 0 for frame in FRAMES] == [True, False, True, False]


@pytest.mark.parametrize("text", ["", "x", "3-1", "1-5:0", "-3", "1,,2", "1-99999999"])
def test_frames_that_are_none(room, text):
    with pytest.raises(room("core").ReflectionError, match="names no frames"):
        room("addon.frames").frame_numbers(text)


def test_frames_in_the_words_of_farms(room):
    numbers = room("addon.frames").frame_numbers
    assert numbers("7") == [7] and numbers("1-4") == [1, 2, 3, 4] and numbers("0..2") == [0, 1, 2]
    assert numbers("10-14x2, 3,1-2,11-12") == [1, 2, 3, 10, 11, 12, 14] and numbers("1-9:3") == [1, 4, 7]


def test_blur_is_answered(moving, room, tmp_path, capsys):
    bpy.context.scene.render.use_motion_blur = True
    bpy.context.scene.camera.data.dof.use_dof = True
    assert bake(room, "--output", tmp_path / "out", "--frames", "1", "--light", "0", "--frames-only") == 0
    told = capsys.readouterr().out
    assert "Motion blur: " in told and "Depth of field: " in told


@pytest.mark.thorough
def test_the_operator_lets_results_play(moving, room, tmp_path):
    """One that is there plays in place; generated again it is a still, and cleared it leaves nothing."""
    parts.select()
    result = parts.generate()
    kinds = ("objects", "meshes", "materials", "images", "node_groups", "cache_files", "scenes")

    def data() -> dict:
        return {kind: {item.name for item in getattr(bpy.data, kind)
                       if getattr(item, "type", "") != "RENDER_RESULT"} for kind in kinds}
    before = data()
    frame = bpy.context.scene.frame_current
    for _ in range(2):
        # again, over itself
        operate(tmp_path / "out", samples=2)
        assert room("addon.frames").plays(result) and bpy.context.scene.frame_current == frame
        assert [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"] == [result]
        assert len(bpy.data.cache_files) == 1
        wanted = {}
        for number in FRAMES:
            bpy.context.scene.frame_set(number)
            wanted[number] = len(result.evaluated_get(bpy.context.evaluated_depsgraph_get()).data.vertices)
        bpy.context.scene.frame_set(frame)
        assert min(wanted.values()) > 0
    assert result.reflection_mesh.mirror.name == "Mirror"
    parts.select(result)
    assert parts.generate() == result and not result.modifiers and not result.constraints
    assert data() == before
    operate(tmp_path / "out", samples=2)
    parts.select()
    bpy.ops.reflection_mesh.clear()
    assert not bpy.data.cache_files and not bpy.data.node_groups and "Mirror Reflection" not in bpy.data.objects
    assert not [image for image in bpy.data.images if image.type != "RENDER_RESULT"]


def test_records_that_are_none(room, tmp_path):
    """A record may come from anywhere: names of files that lead elsewhere are not believed."""
    baking = room("addon.frames")
    path = tmp_path / "Frame.0001.json"
    good = {"frame": 1, "made_with": {}, "image": "", "results": {"M": {"file": "M.0001.usdc", "lit": False,
                                                                       "attributes": [], "materials": []}}}
    path.write_text(json.dumps(good))
    assert baking.read_record(str(path)).files == ["M.0001.usdc"]
    for key, value in (("frame", "x"), ("results", []), ("image", "../x.exr"), ("made_with", 3)):
        path.write_text(json.dumps({**good, key: value}))
        assert baking.read_record(str(path)) is None
    for text in ("", "[]", "null", "[" * 100_000):
        path.write_text(text)
        assert baking.read_record(str(path)) is None
    assert baking.read_record(str(tmp_path / "none.json")) is None


@pytest.mark.thorough
def test_points_and_windows_play_too(moving, room, tmp_path):
    """Discs as the faces that they are drawn as; a window is opened to the image behind it."""
    out = tmp_path / "points"
    assert bake(room, "--output", out, "--light", "0", "--frames", "3", "--method", "POINTS") == 0
    told = played(out / "scene reflections.blend", [3], tmp_path / "played", ["Mirror Reflection"])
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    expected(3, method="POINTS")
    shown = bpy.context.object.evaluated_get(bpy.context.evaluated_depsgraph_get())
    wanted = generated(shown)
    assert len(wanted["corners"]) and ": CORNER FLOAT2 UVMap" in wanted
    assert_same(told, 3, "Mirror Reflection", wanted)
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    out = tmp_path / "window"
    assert bake(room, "--output", out, "--light", "0", "--frames", "3", "--placement", "VIRTUAL") == 0
    told = played(out / "scene reflections.blend", [3], tmp_path / "played", ["Mirror Reflection"])
    assert not bpy.data.objects["Mirror"].visible_camera
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    assert_same(told, 3, "Mirror Reflection", expected(3, placement="VIRTUAL"))


def test_a_still_again_shows_its_own_materials(moving, tmp_path):
    """Those of frames are in another order; and the previews of before are gone with what they stood for."""
    bpy.data.objects["Box"].data.materials[0].name = "Zebra"
    before = set(bpy.data.materials)
    parts.select()
    result = parts.generate(preview=True)
    wanted = [material.name for material in result.data.materials]
    assert wanted == ["Zebra", "Red one"] and set(bpy.data.materials) > before
    parts.select()
    operate(tmp_path / "out", frames="1-2", samples=0)
    assert set(bpy.data.materials) == before
    parts.select()
    result = parts.generate()
    assert [material.name for material in result.data.materials] == wanted


def test_results_that_are_not_baked_stay_shown(moving, room, tmp_path):
    """Also where the frames are for another camera than the one that looks."""
    box, mirror, scene = bpy.data.objects["Box"], bpy.data.objects["Mirror"], bpy.context.scene
    small = mirror.copy()
    scene.collection.objects.link(small)
    small.scale, small.reflection_mesh.role, mirror.reflection_mesh.role = (0.5, 0.5, 0.5), "MIRROR", "DIFFUSE"
    parts.select(box, small)
    other = parts.generate()
    mirror.reflection_mesh.role, small.reflection_mesh.role = "MIRROR", "IGNORE"
    second = add_camera("Second", (0.5, -6.0, 1.0), (1.45, 0.0, 0.0))
    parts.select()
    frames = room("addon.operators.bake_frames")
    wanted = room("addon.settings").Wanted(scene, {"light_samples": 0})
    plan = frames.plan_of(bpy.context, str(tmp_path), "1", wanted, cameras=(second,))
    room("addon.faults").finished(room("addon.operators.bake_frames.bake").baking(bpy.context, plan))
    assert not other.hide_render and not other.hide_viewport and not any(other.reflection_mesh.aside)
    assert scene.reflection_mesh.seen_by == scene.camera
