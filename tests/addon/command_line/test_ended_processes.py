"""What killed processes leave goes at the next run, and nothing else; Ctrl-C is one sentence."""
from __future__ import annotations

import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import bpy
import faults
import pytest


def ended_process() -> int:
    process = subprocess.Popen([sys.executable, "-c", ""])
    process.wait()
    return process.pid


@pytest.fixture(scope="module")
def scratch(room):
    return room("addon.files.scratch")


def test_only_our_own_leftovers_go(scratch, tmp_path, monkeypatch):
    ended, machine = ended_process(), scratch.MACHINE
    precious = tmp_path / "precious"
    precious.mkdir()
    names = {True: [f"reflection_mesh_{machine}_{ended}_abcd_012", f"reflection_mesh_{machine}_{ended}_abcdefgh.blend",
                    f"reflection_mesh_{machine}_{ended}_abcdefgh.blend@"],
             False: [f"reflection_mesh_{machine}_{os.getpid()}_abcdefgh", f"reflection_mesh_{machine}_1_abcdefgh",
                     f"reflection_mesh_{machine}_{ended}_abcdefghi", f"reflection_mesh_{machine}_{ended}_abcdefgh.png",
                     f"my_reflection_mesh_{machine}_{ended}_abcdefgh", f"reflection_mesh_elsewhere_{ended}_abcdefgh",
                     f"reflection_mesh_{ended}_abcdefgh", "reflection_mesh_tests_abcdefgh"]}

    def made():
        for name in names[True] + names[False]:
            path = tmp_path / name
            path.write_bytes(b"x") if "." in name else (path.mkdir(exist_ok=True), (path / "x").write_bytes(b"x"))
    made()
    link = tmp_path / f"reflection_mesh_{machine}_{ended}_linklink"
    link.symlink_to(precious)
    (precious / "mine").write_bytes(b"x")
    mine = os.geteuid()
    with monkeypatch.context() as patch:
        patch.setattr(os, "geteuid", lambda: mine + 1)
        scratch.clear_leftovers(str(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {*names[True], *names[False], link.name, "precious"}
    scratch.clear_leftovers(str(tmp_path))
    assert {path.name for path in tmp_path.iterdir()} == {*names[False], link.name, "precious"}
    assert (precious / "mine").exists()
    scratch.clear_leftovers(str(tmp_path / "none"))


@pytest.mark.thorough
def test_what_a_killed_comparison_left_goes_at_the_next(scratch, saved_scene, room, tmp_path, monkeypatch):
    out, place = tmp_path / "out", tmp_path / "scratch"
    with faults.running(**faults.command(saved_scene, "compare", "--output", out, scratch=place)) as process:
        faults.until_it_renders(process, place, 0.0)
        process.kill()
    left = [path.name for folder in (out, place) for path in folder.iterdir() if not path.name.startswith("blender_")]
    assert len(left) == 2 and all(scratch.NAME.fullmatch(name) for name in left)
    monkeypatch.setattr(scratch.tempfile, "tempdir", str(place))
    room("addon.faults").finished(room("addon.operators.compare").comparison(bpy.context, str(out), 1))
    assert set(faults.contents(out)) == faults.RESULTS == {path.name for path in out.iterdir()}
    assert not [path for path in place.iterdir() if path.name in left]


@pytest.mark.thorough
def test_ctrl_c_is_one_sentence(tmp_path):
    """In the middle of work that takes seconds."""
    scene = tmp_path / "suzanne.blend"
    shutil.copy(Path(__file__).resolve().parents[3] / "sample_blends" / "suzanne.blend", scene)
    with faults.running(**faults.command(scene, "generate", "--output", tmp_path / "out.blend")) as process:
        assert any("Tracing rays" in line for line in process.stdout)
        interrupted(process, scene)


@pytest.mark.slow
def test_ctrl_c_ends_a_comparison(saved_scene, tmp_path):
    """Within a render Blender swallows what Python raises, and the comparison went on to its end."""
    with faults.running(**faults.command(saved_scene, "compare", "--samples", 4000, "--output", tmp_path / "out",
                                         scratch=tmp_path / "scratch")) as process:
        faults.until_it_renders(process, tmp_path / "scratch", 0.3)
        interrupted(process, saved_scene)
    assert not (tmp_path / "out").exists() and not list((tmp_path / "scratch").iterdir())


def interrupted(process: subprocess.Popen, saved_scene: Path) -> None:
    """Press Ctrl-C: the process ends with a sentence, and leaves all as it was."""
    before = faults.contents(saved_scene.parent)
    process.send_signal(signal.SIGINT)
    _, error = process.communicate()
    assert process.returncode == 130
    assert error.splitlines()[-1] == "Interrupted: nothing has been saved." and "Traceback" not in error
    assert faults.contents(saved_scene.parent) == before


@pytest.mark.thorough
def test_a_second_ctrl_c_does_not_wait_for_the_picture(saved_scene, tmp_path):
    with faults.running(**faults.command(saved_scene, "compare", "--samples", 10**6, "--output", tmp_path / "out",
                                         scratch=tmp_path / "scratch")) as process:
        faults.until_it_renders(process, tmp_path / "scratch", 2.0)
        process.send_signal(signal.SIGINT)
        assert "again" in process.stderr.readline()
        process.send_signal(signal.SIGINT)
        process.communicate()
    assert process.returncode == 130
