"""Frames that play without the extension show what `generate` and `light` make of them; whatever ends a bake, what is
done stays and the rest follows."""
from __future__ import annotations

import json
import signal
from pathlib import Path

import bpy
import faults
import numpy as np
import parts
import pytest
from played import generated, played

FRAMES = [1, 2, 3, 4]


@pytest.fixture
def moving(blank, tmp_path) -> Path:
    """A cube of two colours that moves before a wall mirror, with a UV map, colours and an attribute, 96 x 72 pixels,
    saved; the mirror moves too."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    for name, colour in (("Plain", (0.8, 0.8, 0.8, 1.0)), ("Red one", (1.0, 0.0, 0.0, 1.0))):
        cube.data.materials.append(parts.material(name))
        cube.data.materials[-1].node_tree.nodes["Emission"].inputs[0].default_value = colour
    rng = np.random.default_rng(5)
    for face in cube.data.polygons:
        face.material_index = face.index % 2
    for name, kind, domain, width in (("My Colour", "FLOAT_COLOR", "POINT", 4), ("wet spots", "FLOAT", "FACE", 1),
                                      ("Zähler", "INT", "FACE", 1)):
        entry = cube.data.attributes.new(name, kind, domain)
        values = rng.uniform(-3.0, 1e6, width * len(entry.data))
        entry.data.foreach_set("color" if width == 4 else "value",
                               values.astype(np.int32 if kind == "INT" else np.float32))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Glass", "GLOSSY"))
    cube.reflection_mesh.role, mirror.reflection_mesh.role = "DIFFUSE", "MIRROR"
    for obj, frame, place in ((cube, 1, (0.0, -1.5, 1.0)), (cube, 5, (1.2, -1.0, 1.3)),
                              (mirror, 1, (0.0, 1.0, 1.0)), (mirror, 5, (0.0, 1.5, 1.0))):
        obj.location = place
        obj.keyframe_insert("location", frame=frame)
    scene = blank.scene
    scene.render.resolution_x, scene.render.resolution_y = 96, 72
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.frame_set(1)
    blank.preferences.filepaths.save_version = 0
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path


def bake(room, *arguments) -> int:
    return room("addon.command_line").run(["bake", *map(str, arguments)])


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


def expected(frame: int, light: bool = False, **options) -> dict:
    """What `generate` makes of a frame of the open file."""
    bpy.context.scene.frame_set(frame)
    parts.select()
    result = parts.generate(**options)
    if light:
        bpy.ops.reflection_mesh.light(samples=4, every=True)
    return generated(result)


def assert_same(told: dict, frame: int, name: str, wanted: dict) -> None:
    for what, values in wanted.items():
        found = told[f"{frame} {name} {what}"]
        assert found.dtype == values.dtype or what == "materials", what
        if ": FACE FLOAT " in what:
            # the mean of three equal numbers
            assert np.allclose(found, values, rtol=2e-7, atol=0.0), what
        elif what == "origin":
            assert np.allclose(found, values, atol=1e-6)
        else:
            assert np.array_equal(found, values), what


def test_frames_play_without_the_extension(moving, room, tmp_path):
    """Bit for bit: places, faces, materials and whatever else the result knows."""
    out = tmp_path / "out"
    before = moving.read_bytes()
    assert bake(room, "--output", out, "--light", "0") == 0
    assert moving.read_bytes() == before
    assert names(out) == {"scene reflections.blend", *(f"Frame.{frame:04d}.json" for frame in FRAMES),
                          *(f"Mirror_Reflection.{frame:04d}.usdc" for frame in FRAMES)}
    told = played(out / "scene reflections.blend", [*FRAMES[::-1], 2], tmp_path / "played", ["Mirror Reflection"])
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    counts = set()
    for frame in FRAMES:
        wanted = expected(frame)
        assert {": POINT FLOAT_VECTOR reflected_position", ": CORNER FLOAT_COLOR My Colour", ": CORNER FLOAT2 UVMap",
                ": FACE INT source_face"} <= set(wanted)
        assert set(wanted["materials"]) == {"Plain", "Red one"}
        counts.add(wanted["places"].tobytes())
        assert_same(told, frame, "Mirror Reflection", wanted)
    assert len(counts) == len(FRAMES)


def lit_scene() -> None:
    """The cube grey and lit by a lamp, so that each frame has a light of its own."""
    cube = bpy.data.objects["Box"]
    for slot in cube.material_slots:
        slot.material = parts.material("Grey", "DIFFUSE")
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy = 300.0
    place = bpy.data.objects.new("Lamp", lamp)
    place.location = (2.0, -4.0, 3.0)
    bpy.context.scene.collection.objects.link(place)


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


def test_what_is_there_is_kept_or_made_again(moving, room, tmp_path, capsys):
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames-only") == 0
    whole = faults.contents(out)
    assert "scene reflections.blend" not in whole and len(whole) == 2 * len(FRAMES)
    (out / "Mirror_Reflection.0002.usdc").unlink()
    (out / "Frame.0003.json").write_text("{")
    first = {path.name: path.stat().st_mtime_ns for path in out.iterdir()}
    assert bake(room, "--output", out, "--light", "0", "--frames-only") == 0
    assert "2 of 4 frames" in capsys.readouterr().out.splitlines()[-1]
    assert faults.contents(out) == whole
    again = {path.name for path in out.iterdir() if path.stat().st_mtime_ns != first.get(path.name)}
    assert again == {f"{name}.{frame:04d}.{ending}" for frame in (2, 3)
                     for name, ending in (("Frame", "json"), ("Mirror_Reflection", "usdc"))}
    # what was made otherwise is not mixed with it
    assert bake(room, "--output", out, "--light", "0", "--tolerance", "3") == 1
    assert "Frame 1 in" in (error := capsys.readouterr().err) and "overwrite it" in error
    assert faults.contents(out) == whole
    assert bake(room, "--output", out, "--light", "0", "--tolerance", "3", "--overwrite", "--frames-only") == 0
    assert set(faults.contents(out)) == set(whole) and faults.contents(out) != whole


def test_chunks_in_any_order_give_the_same_files(moving, room, tmp_path):
    one, other = tmp_path / "one", tmp_path / "other"
    common = ("--light", "4", "--frames-only", "--output")
    lit_scene()
    bpy.ops.wm.save_mainfile()
    assert bake(room, *common, one) == 0
    for chunk in ("4", "1-3:2", "2..3", "4,1"):
        bpy.ops.wm.open_mainfile(filepath=str(moving))
        assert bake(room, *common, other, "--frames", chunk) == 0
    assert len(faults.contents(one)) == 3 * len(FRAMES)
    assert faults.contents(one) == faults.contents(other)


@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_killed_half_way_the_next_one_goes_on(moving, room, tmp_path, end):
    """Whatever lies in the folder under a frame's name is whole at any moment."""
    wanted, out = tmp_path / "wanted", tmp_path / "out"
    # more of them than are done before the signal comes
    arguments = ("--frames", "1-40", "--frames-only", "--light", "0", "--output")
    assert bake(room, *arguments, wanted) == 0
    with faults.running(**faults.command(moving, "bake", *arguments, out)) as process:
        assert any("0002.usdc" in line and line.startswith("Saved: '") for line in process.stdout)
        process.send_signal(end)
        _, error = process.communicate()
    if end == signal.SIGINT:
        assert process.returncode == 130 and "the frames that are done stay" in error and "Traceback" not in error
    left = {name: content for name, content in faults.contents(out).items() if not name.startswith("reflection_mesh_")}
    assert 4 <= len(left) < 2 * 40
    assert all(faults.contents(wanted)[name] == content for name, content in left.items())
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    assert bake(room, *arguments, out) == 0
    assert faults.contents(out) == faults.contents(wanted)


def test_killed_between_files_a_frame_is_not_done(moving, room, tmp_path, monkeypatch):
    """The record comes last: a process that ends before it leaves a frame that is made again."""
    out, bake_module = tmp_path / "out", room("addon.bake")

    def ends(*arguments):
        raise KeyboardInterrupt
    with monkeypatch.context() as patch:
        patch.setattr(bake_module, "write_record", ends)
        assert bake(room, "--output", out, "--light", "0") == 130
    assert names(out) == {"Mirror_Reflection.0001.usdc"}
    assert bake(room, "--output", out, "--light", "0", "--frames-only") == 0
    assert len(names(out)) == 2 * len(FRAMES)
    with monkeypatch.context() as patch:
        patch.setattr(bake_module, "write_record", ends)
        assert bake(room, "--output", out, "--light", "0", "--overwrite", "--tolerance", "3") == 130
    # what the old record tells is no longer true
    assert "Frame.0001.json" not in names(out) and "Frame.0002.json" in names(out)


def test_a_full_disk_is_one_sentence(moving, room, tmp_path, capsys):
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1", "--frames-only") == 0
    before = faults.contents(out)
    with faults.no_file_over(2000):
        assert bake(room, "--output", out, "--light", "0", "--frames", "1-2", "--frames-only") == 1
    assert "Mirror_Reflection.0002.usdc' cannot be written whole" in faults.one_sentence(capsys.readouterr().err)
    assert faults.contents(out) == before


def add_camera(name: str, place: tuple, turn: tuple) -> bpy.types.Object:
    camera = bpy.data.objects.new(name, bpy.data.cameras.new(name))
    camera.location, camera.rotation_euler = place, turn
    bpy.context.scene.collection.objects.link(camera)
    return camera


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
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--light", "0", "--frames", "1-2", "--camera", "Camera", "Second") == 0
    results = ["Mirror Reflection Camera", "Mirror Reflection Second"]
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
    run = room("addon.command_line").run
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
    for verb in ("generate", "light", "compare", "bake", "benchmark"):
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

def operate(out: Path, **options) -> None:
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", filepath=str(out), **options) == {"FINISHED"}


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


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_stopped_at_any_step_the_file_is_as_it_was(moving, room, tmp_path, placement):
    lit_scene()
    parts.select()
    parts.generate(placement=placement)
    bpy.ops.reflection_mesh.light(samples=1)
    parts.select()
    bake_module, settings = room("addon.bake"), room("core").Settings(placement=placement)
    before, stale = parts.state(), bpy.data.objects["Mirror Reflection"].reflection_mesh.light_stale

    def steps(folder):
        return bake_module.baking(bpy.context, bake_module.Plan(str(tmp_path / folder), [2, 3], settings, 1))
    told = list(dict.fromkeys(stage for _, stage in steps("all")))
    assert parts.state() == before
    for index, stage in enumerate(told):
        running = steps(f"out{index}")
        while next(running)[1] != stage:
            pass
        running.close()
        assert parts.state() == before, stage
        assert bpy.data.objects["Mirror Reflection"].reflection_mesh.light_stale == stale


@pytest.mark.parametrize("failing", ["player_of", "play", "show_by_camera", "write_result", "lighting", "generation"])
def test_an_error_leaves_no_trace(moving, room, tmp_path, monkeypatch, failing):
    parts.select()
    parts.generate()
    parts.select()
    bake_module = room("addon.bake")
    cameras = (bpy.context.scene.camera, add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3)))
    bpy.context.view_layer.update()
    before, known = parts.state(), set(bpy.data.cache_files)

    def fails(*arguments, **options):
        raise RuntimeError("on purpose")
    monkeypatch.setattr(bake_module, failing, fails)
    plan = bake_module.Plan(str(tmp_path / "out"), [1], room("core").Settings(), 1, cameras)
    with pytest.raises(RuntimeError, match="on purpose"):
        bake_module.playing(bpy.context, room("addon.faults").finished(bake_module.baking(bpy.context, plan)))
    assert parts.state() == before and set(bpy.data.cache_files) == known


def test_it_refuses_before_anything_changes(moving, room, tmp_path):
    operator = bpy.ops.reflection_mesh.bake
    assert "names no frames" in parts.refusal(operator, frames="abc", filepath=str(tmp_path / "out"))
    assert "No folder" in parts.refusal(operator, filepath="")
    bpy.context.scene.camera = None
    assert "no camera" in parts.refusal(operator, filepath=str(tmp_path / "out"))
    bpy.data.objects["Mirror"].reflection_mesh.role = "IGNORE"
    assert "No mirror" in parts.refusal(operator, filepath=str(tmp_path / "out"))
    assert not (tmp_path / "out").exists()


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
