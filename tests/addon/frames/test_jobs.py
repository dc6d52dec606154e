"""Frames baked by several processes side by side: the same files, and nobody left behind."""
from __future__ import annotations

import signal
from pathlib import Path

import bpy
import faults
import pytest
from baked_frames import FRAMES, bake, lit_scene, operate


def unsaved_change() -> None:
    """What the open file shows and the saved one does not."""
    bpy.data.objects["Box"].scale = (0.5, 1.0, 1.5)
    lit_scene()


@pytest.mark.thorough
def test_several_processes_make_the_same_files(moving, room, tmp_path, capsys):
    one, three = tmp_path / "one", tmp_path / "three"
    unsaved_change()
    assert bake(room, "--light", "4", "--frames-only", "--output", one) == 0
    assert bake(room, "--light", "4", "--output", three, "--jobs", "3", "--progress", "OPENJD") == 0
    told = capsys.readouterr().out
    assert f"{len(FRAMES)} of {len(FRAMES)} frames baked into '{three}'" in told.splitlines()[-1]
    assert "Kept although" not in told and "openjd_progress: " in told
    assert {Path(line[8:-1]).name for line in told.splitlines() if line.startswith(f"Saved: '{three}")} == {
        name for name in (*faults.contents(one), "scene reflections.blend") if not name.endswith("json")}
    made = faults.contents(three)
    assert made.pop("scene reflections.blend") and made == faults.contents(one)
    assert Path(bpy.data.filepath) == moving


@pytest.mark.slow
def test_what_is_there_is_kept_or_made_again(moving, room, tmp_path, capsys):
    out = tmp_path / "out"
    common = ("--light", "0", "--frames-only", "--output", out, "--jobs", "2")
    assert bake(room, *common) == 0
    whole = faults.contents(out)
    (out / "Frame.0003.json").unlink()
    assert bake(room, *common) == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith(f"1 of {len(FRAMES)} frames")
    assert bake(room, *common, "--tolerance", "3", "--overwrite") == 0
    assert capsys.readouterr().out.splitlines()[-1].startswith(f"{len(FRAMES)} of {len(FRAMES)} frames")
    assert set(faults.contents(out)) == set(whole) and faults.contents(out) != whole


@pytest.mark.thorough
def test_what_a_process_says_is_told_in_its_words(moving, room, tmp_path, capsys):
    out = tmp_path / "out"
    assert bake(room, "--light", "0", "--frames", "2", "--frames-only", "--output", out) == 0
    before = faults.contents(out)
    arguments = ("--light", "0", "--frames-only", "--tolerance", "3", "--output", out)
    assert bake(room, *arguments) == 1
    alone = faults.one_sentence(capsys.readouterr().err)
    assert bake(room, *arguments, "--jobs", "2") == 1
    assert faults.one_sentence(capsys.readouterr().err) == alone
    assert all(faults.contents(out)[name] == content for name, content in before.items())
    assert bake(room, *arguments, "--jobs", "0") == 1
    assert "one process at least" in faults.one_sentence(capsys.readouterr().err)


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGTERM, signal.SIGINT])
def test_ended_half_way_no_process_goes_on(moving, room, tmp_path, end):
    wanted, out = tmp_path / "wanted", tmp_path / "out"
    arguments = ("--frames", "1-30", "--frames-only", "--light", "0", "--output")
    assert bake(room, *arguments, wanted) == 0
    with faults.running(**faults.command(moving, "bake", *arguments, out, "--jobs", "2")) as process:
        assert any("0002.usdc" in line and line.startswith("Saved: '") for line in process.stdout)
        process.send_signal(end)
        # until all that write there have ended
        _, error = process.communicate()
    if end == signal.SIGINT:
        assert process.returncode == 130 and "the frames that are done stay" in error and "Traceback" not in error
    left = faults.contents(out)
    assert all(left[name] == content for name, content in faults.contents(wanted).items() if name in left)
    if end == signal.SIGINT:
        assert 2 <= len(left) < 2 * 30 and set(left) <= set(faults.contents(wanted))
    assert bake(room, *arguments, out, "--jobs", "2") == 0
    assert faults.contents(out) == faults.contents(wanted)


@pytest.mark.slow
def test_the_button_lets_several_bake_what_one_does(moving, room, tmp_path):
    one, two = tmp_path / "one", tmp_path / "two"
    given = {"tolerance": 1.5, "placement": "SURFACE", "hidden_faces": True}
    unsaved_change()
    for out, jobs in ((one, 1), (two, 2)):
        operate(out, samples=0, jobs=jobs, **given)
        bpy.ops.reflection_mesh.clear()
    assert len(faults.contents(one)) == 2 * len(FRAMES)
    assert faults.contents(one) == faults.contents(two)
    # with the same files there nothing is made again but by wish
    before = {path.name: path.stat().st_mtime_ns for path in two.iterdir()}
    operate(two, samples=0, jobs=2, **given)
    assert {path.name: path.stat().st_mtime_ns for path in two.iterdir()} == before
    operate(two, samples=0, jobs=2, overwrite=True, **given)
    assert not any(path.stat().st_mtime_ns == before[path.name] for path in two.iterdir())


@pytest.mark.thorough
def test_esc_ends_them_all(moving, room, tmp_path, monkeypatch):
    place = room("addon.operators.bake_frames.side_by_side")
    started, heard = [], place._heard

    def noted(processes: list, saved):
        started.extend(processes)
        return heard(processes, saved)
    monkeypatch.setattr(place, "_heard", noted)
    out = tmp_path / "out"
    steps = place.side_by_side(["bake", "--light", "0", "--output", str(out)], list(range(1, 61)), 2)
    while not out.exists() or not any(path.suffix == ".usdc" for path in out.iterdir()):
        next(steps)
    steps.close()
    assert len(started) == 2 and all(process.poll() is not None for process in started)
    assert len(list(out.glob("*.usdc"))) < 60


def test_words_are_those_of_the_verb(room):
    words = room("addon.operators.bake_frames.side_by_side").words_of(
        {"tolerance": 0.25, "placement": "VIRTUAL", "method": "POINTS", "depth": 3, "memory": 1.5,
         "hidden_faces": False, "light_samples": 7})
    options = room("addon.command_line.verbs")._parser().parse_args(["bake", *words])
    assert (options.tolerance, options.placement, options.method, options.depth, options.memory, options.hidden_faces,
            options.light) == (0.25, "VIRTUAL", "POINTS", 3, 1.5, False, 7)
