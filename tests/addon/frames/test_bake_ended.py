"""Frames that are kept, made again, and gone on with after whatever ended their making."""
from __future__ import annotations

import signal

import bpy
import faults
import parts
import pytest
from baked_frames import FRAMES, add_camera, bake, lit_scene, names, stopped_at_each_stage


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


@pytest.mark.thorough
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


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
def test_killed_half_way_the_next_one_goes_on(moving, room, tmp_path, end):
    """Whatever lies in the folder under a frame's name is whole at any moment."""
    wanted, out = tmp_path / "wanted", tmp_path / "out"
    # more of them than are done before the signal comes
    arguments = ("--frames", "1-30", "--frames-only", "--light", "0", "--output")
    assert bake(room, *arguments, wanted) == 0
    with faults.running(**faults.command(moving, "bake", *arguments, out)) as process:
        assert any("0002.usdc" in line and line.startswith("Saved: '") for line in process.stdout)
        process.send_signal(end)
        _, error = process.communicate()
    if end == signal.SIGINT:
        assert process.returncode == 130 and "the frames that are done stay" in error and "Traceback" not in error
    left = {name: content for name, content in faults.contents(out).items() if not name.startswith("reflection_mesh_")}
    assert 4 <= len(left) < 2 * 30
    assert all(faults.contents(wanted)[name] == content for name, content in left.items())
    bpy.ops.wm.open_mainfile(filepath=str(moving))
    assert bake(room, *arguments, out) == 0
    assert faults.contents(out) == faults.contents(wanted)


def test_killed_between_files_a_frame_is_not_done(moving, room, tmp_path, monkeypatch):
    """The record comes last: a process that ends before it leaves a frame that is made again."""
    out, bake_module = tmp_path / "out", room("addon.operators.bake_frames.bake")

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


@pytest.mark.slow
@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_stopped_at_any_step_the_file_is_as_it_was(moving, room, tmp_path, placement):
    lit_scene()
    parts.select()
    parts.generate(placement=placement)
    bpy.ops.reflection_mesh.light(samples=1)
    parts.select()
    bake_module, settings = room("addon.operators.bake_frames.bake"), room("core").Settings(placement=placement)
    before, lit = parts.state(), bpy.data.objects["Mirror Reflection"].reflection_mesh.lit_from

    def steps(folder):
        return bake_module.baking(bpy.context, bake_module.Plan(str(tmp_path / folder), [2, 3], settings, 1))

    def check(stage: str) -> None:
        assert parts.state() == before, stage
        assert bpy.data.objects["Mirror Reflection"].reflection_mesh.lit_from == lit
        assert room("addon.freshness").why_light_differs(bpy.context, bpy.data.objects["Mirror Reflection"]) == ""

    stopped_at_each_stage(steps, check)


@pytest.mark.thorough
@pytest.mark.parametrize("failing", ["player_of", "play", "show_by_camera", "write_result", "lighting", "generation"])
def test_an_error_leaves_no_trace(moving, room, tmp_path, monkeypatch, failing):
    parts.select()
    parts.generate()
    parts.select()
    bake_module = room("addon.operators.bake_frames.bake")
    cameras = (bpy.context.scene.camera, add_camera("Second", (2.0, -6.0, 1.0), (1.5, 0.0, 0.3)))
    bpy.context.view_layer.update()
    before, known = parts.state(), set(bpy.data.cache_files)

    def fails(*arguments, **options):
        raise RuntimeError("on purpose")
    playing = room("addon.operators.bake_frames.playing")
    monkeypatch.setattr(playing if hasattr(playing, failing) else bake_module, failing, fails)
    plan = bake_module.Plan(str(tmp_path / "out"), [1], room("core").Settings(), 1, cameras)
    with pytest.raises(RuntimeError, match="on purpose"):
        playing.playing(bpy.context, plan, room("addon.faults").finished(bake_module.baking(bpy.context, plan)))
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


def test_a_blender_without_usd_says_so_before_any_work(moving, room, tmp_path, monkeypatch):
    place, button = (room(f"addon.operators.bake_frames.{name}") for name in ("bake", "bake_operator"))
    for one in (place, button):
        monkeypatch.setattr(one, "writes_usd", lambda: False)
    assert not bpy.ops.reflection_mesh.bake.poll()
    assert "cannot write USD files" in parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(tmp_path / "out"))
    plan = button.plan_of(bpy.context, str(tmp_path / "out"), "1", room("addon.settings").Wanted(bpy.context.scene))
    monkeypatch.setattr(place, "candidates", lambda *_: pytest.fail("Work has begun."))
    with pytest.raises(room("core").ReflectionError, match="cannot write USD files"):
        list(place.baking(bpy.context, plan))
    assert not (tmp_path / "out").exists()


@pytest.mark.thorough
@pytest.mark.parametrize("case", [
    ("nothing", 1, ""), ("selection", 1, ""), ("cube", 0, "object"), ("mirror", 0, "mirror"), ("camera", 0, "camera"),
    ("materials", 0, "materials"), ("colour", 0, ""), ("colour", 1, "colours"), ("lamp", 0, ""), ("lamp", 1, "lamps"),
    ("hidden", 0, "object")])
def test_frames_of_another_state_of_the_scene_are_told(moving, room, tmp_path, capsys, case):
    """They are kept, and said to be what they are: after a change, with light or without, by a word."""
    change, light, word = case
    lit_scene()
    red = bpy.data.objects["Box"].data.materials[1]
    if change in ("hidden", "selection"):
        other = parts.add("cube", "Other", size=0.5, location=(-1.0, -1.5, 1.0))
        other.reflection_mesh.role = "DIFFUSE"
    if change == "selection":
        # what is shown again comes last among a result's sources
        bpy.data.objects["Box"].hide_viewport = True
        parts.generate()
        bpy.data.objects["Box"].hide_viewport = False
    parts.select()
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    arguments = ("--output", out, "--light", light, "--frames-only", "--tolerance", "4")
    assert bake(room, *arguments, "--frames", "2-3") == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    if change == "selection":
        parts.select(bpy.data.objects["Mirror Reflection"])
    elif change == "cube":
        bpy.data.objects["Box"].scale.x = 1.5
    elif change == "mirror":
        bpy.data.objects["Mirror"].scale.x = 1.5
    elif change == "camera":
        bpy.context.scene.camera.data.lens = 45.0
    elif change == "materials":
        bpy.data.objects["Box"].material_slots[1].material = parts.material("Blue")
    elif change == "colour":
        red.node_tree.nodes[0].inputs["Color"].default_value = (0.0, 0.5, 0.0, 1.0)
    elif change == "lamp":
        bpy.data.lights["Lamp"].energy = 50.0
    elif change == "hidden":
        bpy.data.objects["Other"].hide_render = True
    bpy.context.view_layer.update()
    capsys.readouterr()
    assert bake(room, *arguments, "--frames", "1-3") == 0
    told = [line for line in capsys.readouterr().out.splitlines() if line.startswith("Kept although")]
    assert len(told) == bool(word) and all(word in line and ": frames 2, 3 in " in line for line in told)
    assert {name: (out / name).read_bytes() for name in before} == before
    assert (out / "Frame.0001.json").exists()
    # made again they are all alike
    assert bake(room, *arguments, "--frames", "1-3", "--overwrite") == 0
    capsys.readouterr()
    assert bake(room, *arguments, "--frames", "1-3") == 0
    assert "Kept although" not in capsys.readouterr().out


def test_many_frames_are_told_in_short(room):
    listed = room("addon.operators.bake_frames.plan").frames_listed
    assert listed([7]) == "frame 7" and listed([1, 2]) == "frames 1, 2"
    assert listed(list(range(1, 12))) == "frames 1, 2, 3, 4, 5, 6, 7, 8 and 3 more"
