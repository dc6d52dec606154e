"""A folder of results is whole or as it was: full disks, links and folders in the way."""
from __future__ import annotations

import os
import subprocess
from pathlib import Path

import bpy
import faults
import numpy as np
import parts
import pytest


@pytest.mark.parametrize(("kind", "ending"), [("OPEN_EXR", ".exr"), ("PNG", ".png"), ("JPEG", ".jpg")])
def test_a_cut_picture_is_found_wherever_it_is_cut(room, blank, tmp_path, kind, ending):
    is_whole = room("addon.files.whole").is_whole
    image = bpy.data.images.new("Noise", 61, 47, float_buffer=True)
    image.pixels.foreach_set(np.random.default_rng(0).random(61 * 47 * 4, dtype=np.float32))
    settings = blank.scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format = kind
    path, cut = tmp_path / f"whole{ending}", tmp_path / f"cut{ending}"
    image.save_render(str(path), scene=blank.scene)
    data = path.read_bytes()
    assert len(data) > 1000 and is_whole(str(path))
    assert not is_whole(str(cut))
    for size in {*range(0, 600, 7), *range(0, len(data), 97), *range(len(data) - 9, len(data))}:
        cut.write_bytes(data[:size])
        assert not is_whole(str(cut)), size


def compared(folder: Path, room, samples: int = 1) -> dict:
    return room("addon.faults").finished(room("addon.operators.compare").comparison(bpy.context, str(folder), samples))


def refused(folder: Path) -> str:
    before = faults.contents(folder.parent)
    sentence = parts.refusal(bpy.ops.reflection_mesh.compare, filepath=str(folder), samples=1)
    assert faults.contents(folder.parent) == before
    return sentence


def test_links_are_replaced_and_nothing_is_written_through_them(saved_scene, room, tmp_path):
    precious, folder = tmp_path / "precious", tmp_path / "out"
    precious.write_bytes(b"mine")
    folder.mkdir()
    for name in faults.RESULTS:
        (folder / name).symlink_to(precious)
    compared(folder, room)
    assert precious.read_bytes() == b"mine"
    assert {path.name for path in folder.iterdir() if path.is_file() and not path.is_symlink()} == faults.RESULTS


@pytest.mark.parametrize("name", ["report.json", "holes.png"])
def test_a_folder_in_the_way_is_named(saved_scene, tmp_path, name):
    folder = tmp_path / "out"
    (folder / name).mkdir(parents=True)
    (folder / name / "mine").write_bytes(b"mine")
    (folder / "difference.png").write_bytes(b"old")
    sentence = refused(folder)
    assert str(folder / name) in sentence and "folder" in sentence


def test_a_pipe_in_the_way_stays(saved_scene, tmp_path):
    (tmp_path / "out").mkdir()
    os.mkfifo(tmp_path / "out" / "report.csv")
    assert str(tmp_path / "out" / "report.csv") in refused(tmp_path / "out")
    assert (tmp_path / "out" / "report.csv").is_fifo()


def test_a_full_target_is_named(saved_scene, room, tmp_path, monkeypatch):
    folder = tmp_path / "out"
    monkeypatch.setattr(room("addon.comparison.compare_report"), "page", lambda report: "x" * 5_000_000)
    for existing in (False, True):
        if existing:
            folder.mkdir()
            (folder / "report.html").write_text("old")
        with faults.no_file_over(4_000_000):
            sentence = refused(folder)
        assert str(folder) in sentence and "make room" in sentence and folder.exists() == existing


def test_a_picture_that_does_not_become_whole_is_told(saved_scene, room, tmp_path, monkeypatch):
    monkeypatch.setattr(room("addon.comparison.compare_images"), "is_whole", lambda path: not path.endswith(".png"))
    assert str(tmp_path / "out") in refused(tmp_path / "out")


@pytest.mark.thorough
def test_a_full_scratch_folder_is_named(saved_scene, tmp_path):
    out = tmp_path / "out"
    done = subprocess.run(**faults.command(saved_scene, "compare", "--output", out, "--samples", 1, limit=500,
                                           scratch=tmp_path / "scratch"), check=False)
    assert done.returncode == 1
    sentence = faults.one_sentence(done.stderr)
    assert f"The scratch folder '{tmp_path / 'scratch'}' is full" in sentence and "TMPDIR" in sentence
    assert not out.exists() and not list((tmp_path / "scratch").iterdir())


def test_a_scratch_folder_that_cannot_be_made_is_told(saved_scene, room, tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise PermissionError(13, "Permission denied", "/somewhere")
    scratch = room("addon.files.scratch")
    made = scratch.tempfile.mkdtemp
    monkeypatch.setattr(scratch.tempfile, "mkdtemp", lambda prefix, dir: made(prefix=prefix, dir=dir)
                        if dir != scratch.scratch_place() else refuse())
    assert "The scratch folder" in refused(tmp_path / "out")
    monkeypatch.setattr(scratch.tempfile, "mkdtemp", refuse)
    assert str(tmp_path / "out") in refused(tmp_path / "out")


def test_results_take_their_places_all_or_none(room, tmp_path, monkeypatch):
    folder = tmp_path / "deep" / "out"
    (folder / "plots").mkdir(parents=True)
    (folder / "a.txt").write_text("old")
    (folder / "plots" / "b.txt").write_text("old")
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (folder / "linked").symlink_to(elsewhere)
    staged, before, replace, count = room("addon.files").staged, faults.contents(tmp_path), os.replace, []

    def fill(scratch):
        for name in ("a.txt", "c.txt", "plots/b.txt", "linked/d.txt", "new/e.txt"):
            path = Path(scratch) / name
            path.parent.mkdir(exist_ok=True)
            path.write_text("new")

    def breaks(source, target):
        # once: the steps that take others back are not to fail
        count[0] -= 1
        if not count[0]:
            raise PermissionError(13, "Permission denied", str(source), None, str(target))
        replace(source, target)
    for steps in range(1, 7):
        count[:] = [steps]
        with monkeypatch.context() as patch:
            patch.setattr(os, "replace", breaks)
            with pytest.raises(room("core").ReflectionError, match="cannot be written"), staged(str(folder)) as scratch:
                fill(scratch)
        assert faults.contents(tmp_path) == before and not (folder / "new").exists()
    with staged(str(folder)) as scratch:
        fill(scratch)
    assert not list(elsewhere.iterdir()) and not (folder / "linked").is_symlink()
    names = "a.txt", "c.txt", "linked/d.txt", "new/e.txt", "plots/b.txt"
    assert faults.contents(folder) == dict.fromkeys(names, b"new")


def test_a_folder_that_another_process_makes_at_the_same_time_will_do(room, tmp_path, monkeypatch):
    folder, made = tmp_path / "out" / "inner", os.mkdir

    def late(path, *arguments):
        if "reflection_mesh" not in str(path):
            made(path, *arguments)
        made(path, *arguments)
    monkeypatch.setattr(os, "mkdir", late)
    staged = room("addon.files").staged
    with pytest.raises(ZeroDivisionError), staged(str(folder)) as scratch:
        (Path(scratch) / "a.txt").write_text("new")
        raise ZeroDivisionError
    assert folder.is_dir() and not list(folder.iterdir())  # it is theirs
    with staged(str(folder)) as scratch:
        (Path(scratch) / "a.txt").write_text("new")
        made(Path(scratch) / "plots")
        (Path(scratch) / "plots" / "b.txt").write_text("new")
    assert faults.contents(folder) == {"a.txt": b"new", "plots/b.txt": b"new"}


def test_a_benchmark_takes_its_place_at_the_end(saved_scene, room, tmp_path, monkeypatch):
    folder, line = tmp_path / "out", ["benchmark", "--no-work", "--samples", "1", "--methods", "ENVIRONMENT",
                                      "--resolution", "32", "--output"]
    place = room("addon.benchmark.whole_report")
    # else it hides its own image
    bpy.data.objects["Box"].location.x = 1.5

    def full(*_):
        raise OSError(28, "No space left on device")
    with monkeypatch.context() as patch:
        patch.setattr(place, "page", full)
        assert room("addon.command_line").run([*line, str(folder)]) == 1
    assert not folder.exists()
    assert room("addon.command_line").run([*line, str(folder)]) == 0
    assert faults.RESULTS < set(faults.contents(folder))


def test_what_another_process_removes_at_that_moment_is_no_error(room, tmp_path, monkeypatch):
    """As the record of a frame that two make at once."""
    place, target = room("addon.files.staged"), tmp_path / "frames" / "record"

    def removed(path: str, spare: str) -> None:
        os.unlink(path)
        keep(path, spare)
    keep = place.keep
    with place.staged(str(target.parent)) as scratch:
        Path(scratch, "record").write_text("first")
    monkeypatch.setattr(place, "keep", removed)
    with place.staged(str(target.parent)) as scratch:
        Path(scratch, "record").write_text("second")
    assert target.read_text() == "second" and faults.contents(tmp_path) == {"frames/record": b"second"}
