"""The verbs of the command line: exit status 0 only on success, the opened file as it was unless it is to be saved."""
import os
import re
import subprocess
import sys
from pathlib import Path

import bpy
import parts
import pytest

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def saved(blank, tmp_path) -> Path:
    """A saved file: a cube before a wall mirror, roles set, nothing selected; it is open."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    mirror = parts.add_wall_mirror()
    cube.reflection_mesh.role, mirror.reflection_mesh.role = "DIFFUSE", "MIRROR"
    bpy.context.preferences.filepaths.save_version = 0
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


def faces_in(path: Path, name: str = "Mirror Reflection") -> int:
    bpy.ops.wm.open_mainfile(filepath=str(path))
    obj = bpy.data.objects.get(name)
    return len(obj.data.polygons) if obj else 0


def with_bpy(*arguments: str) -> subprocess.CompletedProcess:
    return subprocess.run([sys.executable, str(ROOT / "addon" / "run_with_bpy.py"), *map(str, arguments)],
                          capture_output=True, text=True, check=False, cwd=ROOT.parent,
                          env={**os.environ, "PYTHONDONTWRITEBYTECODE": "1"})


def test_generate_saves_the_file(saved, room, capsys):
    assert room("addon.command_line").run(["generate", "--tolerance", "2"]) == 0
    assert "'Mirror Reflection'" in capsys.readouterr().out
    assert faces_in(saved) > 0


def test_generate_says_what_the_button_says(saved, room, capfd):
    """Each warning, of what is blurred and of what renders show otherwise, is a line of the verb's too."""
    scene, box = bpy.context.scene, bpy.data.objects["Box"]
    scene.camera.data.dof.use_dof = scene.render.use_motion_blur = True
    rounder = box.modifiers.new("Rounder", "SUBSURF")
    rounder.levels, rounder.render_levels = 1, 2
    bpy.ops.reflection_mesh.generate()
    button = {line.removeprefix("Warning: ") for line in capfd.readouterr().out.splitlines()
              if line.startswith("Warning: ")}
    assert len(button) >= 3
    assert room("addon.command_line").run(["generate"]) == 0
    assert button <= set(capfd.readouterr().out.splitlines())


def test_generate_to_another_file(saved, room, tmp_path):
    before = saved.read_bytes()
    output = tmp_path / "other.blend"
    assert room("addon.command_line").run(["generate", "--output", str(output), "--placement", "VIRTUAL"]) == 0
    assert saved.read_bytes() == before
    assert faces_in(output) > 0 and faces_in(saved) == 0


def test_generate_points(saved, room, tmp_path, capsys):
    output = tmp_path / "points.blend"
    assert room("addon.command_line").run(["generate", "--output", str(output), "--method", "POINTS"]) == 0
    printed = capsys.readouterr().out
    assert "8 points" in printed and "Subdivide the reflected objects" in printed
    assert faces_in(output) == 0 and len(bpy.data.objects["Mirror Reflection"].data.vertices) == 8


def test_objects_by_name(saved, room, tmp_path):
    for name in ("Box", "Mirror"):
        bpy.data.objects[name].reflection_mesh.role = "AUTO"
    output = tmp_path / "named.blend"
    assert room("addon.command_line").run(
        ["generate", "--mirror", "Mirror", "--diffuse", "Box", "--output", str(output)]) == 0
    assert faces_in(output) > 0


def test_a_mirror_named_alone_shows_what_is_there(saved, room, tmp_path):
    """But what is hidden: the faces are those of the two objects that are seen, by their names."""
    for obj in bpy.data.objects:
        obj.reflection_mesh.role = "AUTO"
    hidden = bpy.data.objects["Box"].copy()
    hidden.name, hidden.hide_render = "Hidden", True
    bpy.context.scene.collection.objects.link(hidden)
    hidden.location.z += 1.0
    others = [obj.name for obj in bpy.data.objects if obj.type == "MESH" and obj.name not in {"Mirror", "Hidden"}]
    bpy.ops.wm.save_mainfile()
    shown = []
    for number, words in enumerate(([], ["--diffuse", *others])):
        output = tmp_path / f"named {number}.blend"
        bpy.ops.wm.open_mainfile(filepath=str(saved))
        assert room("addon.command_line").run(["generate", "--mirror", "Mirror", *words, "--output", str(output)]) == 0
        shown.append(faces_in(output))
    assert shown[0] == shown[1] > 0


@pytest.mark.parametrize("case", [
    (["generate", "--mirror", "Mirror", "--diffuse", "Nothing"], 1, "no object 'Nothing'"),
    (["generate", "--diffuse", "Mirror"], 1, "Name the mirrors too"),
    (["bake", "--eyes", "4", "--output", "{folder}/frames"], 1, "add --what CAUSTICS"),
    (["generate", "--mirror", "Mirror", "--diffuse", "Mirror"], 1, "named both"),
    (["generate", "--tolerance", "0"], 1, "tolerance"),
    (["generate", "--tolerance", "nan"], 1, "tolerance"),
    (["generate", "--memory", "0"], 1, "The memory must be"),
    (["generate", "--memory", "nan"], 1, "The memory must be"),
    (["generate", "--method", "POINTS", "--depth", "2"], 1, "set Bounces (depth) to 1"),
    (["generate", "--placement", "NOWHERE"], 2, "NOWHERE"),
    (["generate", "--output", "{folder}/none/x.blend"], 1, "Error: '{folder}/none/x.blend' cannot be saved"),
    (["generate", "--output", "{folder}/picture.png"], 1, "picture.png' is not the name of a .blend file"),
    (["compare", "--samples", "0"], 1, "sample"),
    (["compare", "--what", "CAUSTICS", "--rays", "0"], 1, "at least one ray: raise --rays"),
    (["polish"], 2, "polish"),
    ([], 2, "verb"),
])
def test_failures(saved, room, capfd, tmp_path, case):
    (arguments, status, words), before = case, saved.read_bytes()
    assert room("addon.command_line").run([argument.format(folder=tmp_path) for argument in arguments]) == status
    error = capfd.readouterr().err
    assert words.format(folder=tmp_path) in error and "Traceback" not in error
    assert saved.read_bytes() == before


@pytest.mark.parametrize("verb", ["generate", "compare"])
def test_all_settings_reach_the_core(saved, room, tmp_path, capsys, monkeypatch, verb):
    def told(context, participants, settings, *_, **__):
        raise room("core").ReflectionError(f"{settings(participants.mirrors[0])}.")
    monkeypatch.setattr(room(f"addon.operators.{verb}"), "generation", told)
    monkeypatch.setattr(room("addon.command_line.verbs"), "generation", told)
    assert room("addon.command_line").run([verb, "--tolerance", "2", "--placement", "VIRTUAL", "--method", "PARALLEL",
                                           "--depth", "3", "--memory", "0.5", "--hidden-faces", "--output",
                                           str(tmp_path / "x.blend")]) == 1
    expected = room("core").Settings(2.0, "VIRTUAL", "PARALLEL", 3, maximum_memory=0.5, hidden_faces=True)
    assert capsys.readouterr().err == f"Error: {expected}.\n"


@pytest.mark.parametrize("verb", ["generate", "light", "caustics", "compare", "mirror-uvs", "benchmark"])
def test_every_verb_works_at_the_frame_and_by_the_camera_it_is_told(saved, room, tmp_path, capsys, monkeypatch, verb):
    second = bpy.data.objects.new("Second", bpy.data.cameras.new("Second"))
    bpy.context.scene.collection.objects.link(second)
    bpy.ops.wm.save_mainfile()

    def told(context):
        raise room("core").ReflectionError(f"{context.scene.name}, {context.scene.camera.name}, frame "
                                           f"{context.scene.frame_current}, {context.view_layer.name}.")
    monkeypatch.setattr(room("addon.command_line.place"), "forget_chance", told)
    assert room("addon.command_line").run([verb, "--scene", "Scene", "--camera", "Second", "--frame", "7",
                                           "--view-layer", "ViewLayer", "--output", str(tmp_path / "x.blend")]) == 1
    assert capsys.readouterr().err.endswith("Scene, Second, frame 7, ViewLayer.\n")


def test_nothing_to_save_to(blank, room, capsys):
    assert room("addon.command_line").run(["generate"]) == 1
    assert "no file to save to" in capsys.readouterr().err


def test_bad_input_is_one_line(saved, room, capsys):
    bpy.context.scene.camera = None
    assert room("addon.command_line").run(["generate"]) == 1
    error = capsys.readouterr().err
    assert error.startswith("Error: The scene has no camera") and error.count("\n") == 1


def test_help_succeeds(room, capsys):
    assert room("addon.command_line").run(["--help"]) == 0
    out = capsys.readouterr().out
    assert "generate" in out and "compare" in out


def test_through_pypis_bpy(saved, tmp_path):
    """From a checkout, in a fresh process."""
    done = with_bpy(saved, "generate", "--output", tmp_path / "result.blend")
    assert done.returncode == 0, done.stdout + done.stderr
    assert "Traceback" not in done.stdout + done.stderr and "100 %" in done.stdout
    assert faces_in(tmp_path / "result.blend") > 0


@pytest.mark.thorough
def test_pypis_bpy_without_a_file(tmp_path):
    done = with_bpy(tmp_path / "none.blend", "generate")
    assert done.returncode == 1 and "Traceback" not in done.stderr and done.stderr.count("\n") == 1
    assert done.stderr.startswith(f"Error: '{tmp_path / 'none.blend'}' cannot be opened")


def test_pypis_bpy_without_a_verb(room, capsys):
    """It names the verbs that there are."""
    done = with_bpy()
    assert done.returncode == 2 and done.stderr.startswith("Usage:")
    assert room("addon.command_line").run(["none"]) == 2
    verbs = re.findall(r"[\w-]+", capsys.readouterr().err.partition("choose from")[2])
    told = done.stderr.partition(".blend ")[2].split()[0].split("|")
    assert sorted(told) == sorted(verbs)


@pytest.mark.thorough
def test_pypis_bpy_takes_several_files_for_a_benchmark_alone(tmp_path):
    done = with_bpy(tmp_path / "one.blend", tmp_path / "two.blend", "generate")
    assert done.returncode == 2 and done.stderr.startswith("Usage:")
    done = with_bpy(tmp_path / "one.blend", tmp_path / "two.blend", "benchmark", "--output", tmp_path)
    assert done.returncode == 1 and "one.blend" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("words", [
    ["bake", "--frames"], ["bake", "--output"], ["bake", "--camera"], ["bake", "--view-layer"],
    *(["generate", option] for option in ("--output", "--camera", "--scene", "--view-layer", "--mirror", "--diffuse",
                                          "--tolerance", "--depth", "--memory")),
    ["light", "--output"], ["light", "--scene"], ["caustics", "--output"], ["compare", "--output"],
    ["compare", "--tolerance"], ["mirror-uvs", "--print"], ["mirror-uvs", "--picture"], ["benchmark", "--output"],
], ids=" ".join)
def test_an_option_without_a_value_is_refused(saved, room, capsys, words):
    """As of a script whose variable is empty: the whole range would be baked, the opened file overwritten."""
    before, there = saved.read_bytes(), sorted(saved.parent.iterdir())
    for empty in ("", " "):
        assert room("addon.command_line").run([*words, empty]) == 2
        told = capsys.readouterr().err.splitlines()[-1]
        assert words[-1] in told and ("without a value" in told or "invalid" in told) and "Traceback" not in told
    assert saved.read_bytes() == before and sorted(saved.parent.iterdir()) == there


def test_farms_may_name_options_and_give_nothing(saved, room, tmp_path):
    """Their templates cannot leave an option out: these take what the file holds."""
    folder = tmp_path / "frames"
    assert room("addon.command_line").run([
        "bake", "--scene", "", "--eyes", "", "--light", "", "--tolerance", "", "--frames", "1", "--frames-only",
        "--output", str(folder)]) == 0
    assert [path.name for path in folder.glob("*.usdc")] == ["Mirror_Reflection.0001.usdc"]
