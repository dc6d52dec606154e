"""Frames that play without the extension show what `generate` and `light` make of them; whatever ends a bake, what is
done stays and the rest follows."""
from __future__ import annotations

import json

import bpy
import faults
import numpy as np
import parts
import pytest
from baked_frames import FRAMES, add_camera, assert_same, bake, expected, lit_scene, names, operate
from played import generated, played


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


def test_markers_choose_the_camera(moving, room, tmp_path):
    scene = bpy.context.scene
    second = add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    for frame, camera in ((1, scene.camera), (3, second)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0") == 0
    told = played(out / "scene reflections.blend", FRAMES, tmp_path / "played", ["Mirror Reflection"])
    for frame in FRAMES:
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        bpy.context.scene.timeline_markers.clear()
        bpy.context.scene.camera = bpy.data.objects["Second" if frame > 2 else "Camera"]
        assert_same(told, frame, "Mirror Reflection", expected(frame))


def test_several_cameras_have_a_sequence_each(moving, room, tmp_path):
    scene = bpy.context.scene
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    for frame, name in ((1, "Camera"), (2, "Second")):
        scene.timeline_markers.new(name, frame=frame).camera = bpy.data.objects[name]
    # a still that is there would show itself besides
    parts.generate()
    parts.select()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1-2", "--camera", "Camera", "Second") == 0
    results = ["Mirror Reflection Camera", "Mirror Reflection Second"]
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    assert [obj.name for obj in bpy.data.objects if obj.reflection_mesh.role == "REFLECTION"] == results
    told = played(out / "scene reflections.blend", [1, 2], tmp_path / "played", results)
    # the markers cut to the second camera, and so to its sequence
    assert [[bool(told[f"{frame} {name} hidden"]) for name in results] for frame in (1, 2)] == [[False, True],
                                                                                               [True, False]]
    for frame, name, camera in zip((1, 2), results, ("Camera", "Second")):
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        bpy.context.scene.timeline_markers.clear()
        bpy.context.scene.camera = bpy.data.objects[camera]
        assert_same(told, frame, name, expected(frame))
    # and each has both frames, whatever the markers say
    wholly = played(out / "scene reflections.blend", [1, 2], tmp_path / "played", results, every=True)
    for name, camera in zip(results, ("Camera", "Second")):
        for frame in (1, 2):
            bpy.ops.wm.open_mainfile(filepath=str(moving))
            bpy.context.scene.timeline_markers.clear()
            bpy.context.scene.camera = bpy.data.objects[camera]
            assert_same(wholly, frame, name, expected(frame))


def test_several_view_layers_have_a_sequence_each(moving, room, tmp_path, capsys):
    """Each shows what it sees, to itself alone; cameras may have theirs in each."""
    scene = bpy.context.scene
    other = parts.add("cube", "Other", size=0.6, location=(-1.0, -1.5, 1.0))
    other.reflection_mesh.role = "DIFFUSE"
    other.data.materials.append(parts.material("Green"))
    collection = bpy.data.collections.new("Others")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(other)
    collection.objects.link(other)
    scene.view_layers[0].name = "All"
    scene.view_layers.new("One").layer_collection.children["Others"].exclude = True
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    parts.select()
    parts.generate()
    parts.select()
    bpy.ops.wm.save_mainfile()
    sources = {"All": ["Box", "Other"], "One": ["Box"]}
    for cameras in ((), ("Camera", "Second")):
        out = tmp_path / f"out{len(cameras)}"
        more = ("--camera", *cameras) if cameras else ()
        assert bake(room, "--output", out, "--light", "0", "--frames", "2,4", *more, "--view-layer", "All", "One") == 0
        assert "shows them too" not in capsys.readouterr().out
        bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
        scene = bpy.context.scene
        for frame, layer in ((frame, layer) for frame in (4, 2) for layer in scene.view_layers):
            scene.frame_set(frame)
            with bpy.context.temp_override(view_layer=layer):
                shown = [obj for obj in layer.objects if obj.reflection_mesh.role == "REFLECTION"]
                named = {f"Mirror Reflection {layer.name} {camera}".strip() for camera in cameras or ("",)}
                assert {obj.name for obj in shown} == named
                for obj in [obj for obj in shown if obj.visible_get()]:
                    assert obj.reflection_mesh.camera == (bpy.data.objects["Camera"] if cameras else None)
                    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
                    plain = generated(evaluated)["places"]
                    assert {source.object.name for source in obj.reflection_mesh.sources} == set(sources[layer.name])
                    result = made_in(layer)
                    assert np.array_equal(generated(result)["places"], plain)
                    bpy.data.objects.remove(result)
        # cleared they leave nothing
        parts.select()
        bpy.ops.reflection_mesh.clear()
        assert not [item.name for item in bpy.data.collections if "Reflections" in item.name]
        bpy.ops.wm.open_mainfile(filepath=str(moving))
    assert bake(room, "--output", tmp_path / "one", "--light", "0", "--frames", "2", "--view-layer", "One") == 0
    assert "'All' shows them too" in capsys.readouterr().out


def made_in(layer: bpy.types.ViewLayer) -> bpy.types.Object:
    """What Generate makes of the open frame in a view layer, beside what plays there."""
    playing = [obj for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"]
    mirror = bpy.data.objects["Mirror"]
    for obj in playing:
        obj.reflection_mesh.mirror = None
    for obj in layer.objects:
        obj.select_set(obj.reflection_mesh.role in {"MIRROR", "DIFFUSE"})
    result = parts.generate()
    for obj in playing:
        obj.reflection_mesh.mirror = mirror
    return result


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


def test_scene_view_layer_camera_and_frame_of_a_verb(moving, room, tmp_path, capsys):
    """Those that are named, on every verb; what is not there is one sentence."""
    run = room("addon.command_line.verbs").run
    first = bpy.context.scene
    copy = first.copy()
    copy.name, copy.use_fake_user = "Copy", True
    layer = copy.view_layers.new("Other layer")
    add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3))
    copy.collection.objects.link(bpy.data.objects["Second"])
    for name in ("a", "b"):
        # of two cubes the layer sees one
        collection = bpy.data.collections.new(name)
        copy.collection.children.link(collection)
        cube = bpy.data.objects["Box"].copy()
        cube.name, cube.location = f"Box {name}", (1.0, -1.0, 1.0)
        cube.animation_data_clear()
        collection.objects.link(cube)
    layer.layer_collection.children["b"].exclude = True
    bpy.ops.wm.save_mainfile()
    output = tmp_path / "out.blend"
    assert run(["generate", "--scene", "Copy", "--view-layer", "Other layer", "--camera", "Second", "--frame", "3",
                "--output", str(output)]) == 0
    assert {scene.name: len(scene.objects) for scene in bpy.data.scenes} == {"Scene": 4, "Copy": 7}
    bpy.ops.wm.open_mainfile(filepath=str(output))
    scene, result = bpy.data.scenes["Copy"], bpy.data.objects["Mirror Reflection"]
    assert (scene.camera.name, scene.frame_current, bpy.data.scenes["Scene"].camera.name) == ("Second", 3, "Camera")
    assert {source.object.name for source in result.reflection_mesh.sources} == {"Box", "Box a"}
    for verb in ("generate", "light", "caustics", "compare", "bake", "benchmark"):
        for option, words in (("--scene", "no scene 'None'"), ("--view-layer", "no view layer 'None'"),
                              ("--camera", "no camera 'None'")):
            capsys.readouterr()
            assert run([verb, option, "None", "--output", str(tmp_path / "none.blend")]) == 1
            assert words in faults.one_sentence(capsys.readouterr().err)
    assert run(["bake", "--camera", "Box"]) == 1 and "is no camera" in capsys.readouterr().err


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


# in the window


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
    assert result.reflection_mesh.mirror.name == "Mirror" and not result.reflection_mesh.light_stale
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


def test_names_that_would_be_one_in_files_are_told_apart(moving, room, tmp_path):
    """Spaces are no spaces in files, and some systems take small letters for capital ones."""
    mirror = bpy.data.objects["Mirror"]
    bpy.data.objects["Box"].scale = (6.0, 1.0, 4.0)
    mirror.animation_data_clear()
    mirror.scale, mirror.location = (0.25, 0.25, 1.0), (-1.5, 1.0, 1.0)
    for number, name in enumerate(("Mirror_A", "MIRROR A", "Mirror B")):
        other = mirror.copy()
        other.name, other.location = name, (number - 0.5, 1.2 + 0.3 * number, 1.0)
        bpy.context.scene.collection.objects.link(other)
    mirror.name = "Mirror A"
    cameras = [add_camera(name, (x, -6.0, 1.0), (1.45, 0.0, 0.0))
               for name, x in (("Left eye", -1.0), ("left_eye", 1.0))]
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1", "--camera",
                *(camera.name for camera in cameras)) == 0
    assert len({name.casefold() for name in names(out)}) == 4 * 2 + 2 + 1
    assert sum(name.startswith("Mirror_B_Reflection_Left_eye_") for name in names(out)) == 1
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    for obj in bpy.context.scene.objects:
        # those of the camera that does not look too
        obj.hide_viewport = False
    bpy.context.scene.frame_set(1)
    depsgraph, places = bpy.context.evaluated_depsgraph_get(), set()
    for obj in bpy.context.scene.objects:
        if obj.reflection_mesh.role == "REFLECTION":
            mesh, mirror = obj.evaluated_get(depsgraph).data, obj.reflection_mesh.mirror
            at = np.empty(3 * len(mesh.vertices), dtype=np.float32)
            mesh.attributes["position"].data.foreach_get("vector", at)
            at = at.reshape(-1, 3) @ np.array(obj.matrix_world)[:3, :3].T + np.array(obj.matrix_world)[:3, 3]
            assert len(at) and (np.abs(at[:, 1] - mirror.matrix_world.translation.y) < 0.1).all()
            places.add(at.tobytes())
    assert len(places) == 8


def test_two_mirrors_of_one_name_are_refused(moving, tmp_path):
    """A linked one and one of the file's own: frames could not tell whose they are."""
    bpy.data.libraries.write(str(tmp_path / "library.blend"), {bpy.data.objects["Mirror"]})
    with bpy.data.libraries.load(str(tmp_path / "library.blend"), link=True) as (_, wanted):
        wanted.objects = ["Mirror"]
    bpy.context.scene.collection.objects.link(wanted.objects[0])
    bpy.context.view_layer.update()
    told = parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(tmp_path / "out"))
    assert told == "Two mirrors are called 'Mirror': rename one of them."
    assert not (tmp_path / "out").exists()


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
    frames = room("addon.operators.bake")
    wanted = room("addon.settings").Wanted(scene, {"light_samples": 0})
    plan = frames.plan_of(bpy.context, str(tmp_path), "1", wanted, cameras=(second,))
    room("addon.faults").finished(frames.baking(bpy.context, plan))
    assert not other.hide_render and not other.hide_viewport and not any(other.reflection_mesh.aside)
    assert scene.reflection_mesh.seen_by == scene.camera
