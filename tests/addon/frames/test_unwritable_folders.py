"""Folders into which no frames can be written: told in one sentence before any work, with the file as it was."""
from __future__ import annotations

import bpy
import faults
import parts
import pytest
from baked_frames import bake, operate
from caustic_scene import add_lamp

REFUSED = {"file": "cannot be written (Not a directory)", "file/frames": "cannot be made (Not a directory)",
           "/proc/some/frames": "cannot be made (No such file or directory)"}


@pytest.fixture
def scene(moving):
    add_lamp("Lamp", "POINT", (0.0, -4.0, 3.0))
    bpy.context.view_layer.update()
    return moving


@pytest.mark.thorough
@pytest.mark.parametrize("what", ["REFLECTIONS", "CAUSTICS"])
@pytest.mark.parametrize("where", REFUSED)
def test_frames_are_not_begun(scene, room, tmp_path, capfd, where, what):
    """By operator and verb, and by two processes; whoever runs the tests may write everywhere, but not below a file."""
    (tmp_path / "file").write_text("mine")
    out, before = tmp_path / where, parts.state()
    for jobs in (1, 2) if (what, where) == ("REFLECTIONS", "file") else (1,):
        told = parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(out), what=what, frames="1-2", samples=0,
                             jobs=jobs)
        assert told == f"The folder '{out}' {REFUSED[where]}: choose another one."
    capfd.readouterr()
    assert bake(room, "--output", out, "--what", what, "--frames", "1-2", "--light", "0") == 1
    said = capfd.readouterr()
    assert faults.one_sentence(said.err) == f"Error: {told}" and "Frame" not in said.out
    assert parts.state() == before and faults.contents(tmp_path)["file"] == b"mine"


def test_frames_that_are_there_play_from_a_folder_that_is_not_written(scene, room, tmp_path, monkeypatch):
    operate(tmp_path / "out", frames="1-2", samples=0)
    bpy.ops.reflection_mesh.clear()
    for place in ("staged", "save_blend"):
        monkeypatch.setattr(room(f"addon.files.{place}"), "why_unwritable", lambda folder: "Read-only file system")
    operate(tmp_path / "out", frames="1-2", samples=0)
    assert room("addon.frames").plays(bpy.data.objects["Mirror Reflection"])
    bpy.ops.reflection_mesh.clear()
    told = parts.refusal(bpy.ops.reflection_mesh.bake, filepath=str(tmp_path / "out"), frames="1-3", samples=0)
    assert told == f"The folder '{tmp_path / 'out'}' cannot be written (Read-only file system): choose another one."


def test_where_the_file_that_plays_them_cannot_be_no_frame_is_made(scene, room, tmp_path, capsys):
    out = tmp_path / "out"
    (out / "scene reflections.blend").mkdir(parents=True)
    assert bake(room, "--output", out, "--frames", "1-2", "--light", "0") == 1
    assert "is a folder" in faults.one_sentence(capsys.readouterr().err)
    assert not faults.contents(out)
