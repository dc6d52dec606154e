"""Saving: the file is whole or as it was, backups and relative paths are as Blender makes them."""
from __future__ import annotations

import os
import subprocess
from pathlib import Path

import bpy
import faults
import parts
import pytest


@pytest.fixture
def save_blend(room):
    return room("addon.files.save_blend").save_blend


def opens(path: Path, name: str = "Box") -> bool:
    # Blender does not look into the file that is open
    copy = path.parent.parent / "copy.blend"
    copy.write_bytes(path.read_bytes())
    with bpy.data.libraries.load(str(copy)) as (there, _):
        return name in there.objects


@pytest.mark.parametrize("compress", [False, True])
def test_a_cut_blend_file_is_found_wherever_it_is_cut(room, saved_scene, compress):
    is_whole = room("addon.files.whole").is_whole
    path, cut = saved_scene.with_name("whole.blend"), saved_scene.with_name("cut.blend")
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=compress)
    data = path.read_bytes()
    assert is_whole(str(path)) and data.startswith(b"BLENDER") != compress
    for size in {0, 1, 4, 12, 100, *range(0, len(data), len(data) // 7), *range(len(data) - 60, len(data))}:
        cut.write_bytes(data[:size])
        assert not is_whole(str(cut)), size - len(data)


@pytest.mark.parametrize("compress", [False, True])
def test_a_full_disk_leaves_the_old_file(save_blend, saved_scene, room, compress):
    bpy.ops.wm.save_as_mainfile(filepath=str(saved_scene), compress=compress)
    # a file that was opened stays compressed or not
    bpy.ops.wm.open_mainfile(filepath=str(saved_scene))
    bpy.context.preferences.filepaths.save_version = 0
    before, size = faults.contents(saved_scene.parent), saved_scene.stat().st_size
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Mirror"])
    parts.generate()
    for limit in (0, 1000, size // 2, size - 30):
        for path in (saved_scene, saved_scene.with_name("other.blend")):
            refused = pytest.raises(room("core").ReflectionError, match=f"'{path}' cannot be written")
            with refused, faults.no_file_over(limit):
                save_blend(str(path))
            assert faults.contents(saved_scene.parent) == before
    save_blend(str(saved_scene))
    assert opens(saved_scene, "Mirror Reflection") and set(faults.contents(saved_scene.parent)) == {"scene.blend"}
    assert saved_scene.read_bytes().startswith(b"BLENDER") != compress


@pytest.mark.thorough
@pytest.mark.parametrize("output", [[], ["--output", "{folder}/old.blend"], ["--output", "{folder}/new.blend"]])
def test_the_command_line_tells_of_a_full_disk(saved_scene, output):
    saved_scene.with_name("old.blend").write_bytes(b"mine")
    before = faults.contents(saved_scene.parent)
    output = [word.format(folder=saved_scene.parent) for word in output]
    third = saved_scene.stat().st_size // 3
    done = subprocess.run(**faults.command(saved_scene, "generate", *output, limit=third), check=False)
    assert done.returncode == 1, done.stdout
    assert (output[-1] if output else str(saved_scene)) in faults.one_sentence(done.stderr)
    assert faults.contents(saved_scene.parent) == before


@pytest.mark.parametrize(("output", "words"), [("", "is a folder"), ("none/there.blend", "there is no folder"),
                                               ("file/there.blend", "there is no folder"),
                                               ("locked.blend", "protected"), ("pipe.blend", "no file"),
                                               ("/proc/there.blend", "cannot be written (No such"),
                                               ("shut/x.blend", "cannot be written")])
def test_a_place_that_cannot_be_is_one_sentence(saved_scene, room, capsys, monkeypatch, output, words):
    folder = saved_scene.parent
    (folder / "file").write_bytes(b"mine")
    (folder / "shut").mkdir()
    os.mkfifo(folder / "pipe.blend")
    (folder / "locked.blend").write_bytes(b"mine")
    access = os.access
    # whoever runs the tests may write everywhere
    monkeypatch.setattr(os, "access", lambda path, mode: not str(path).endswith("locked.blend") and access(path, mode))
    if words == "cannot be written":
        monkeypatch.setattr(room("addon.files.save_blend"), "temporary_blend", lambda folder: "/proc/none/x.blend")
    before = faults.contents(folder)
    assert room("addon.command_line").run(["generate", "--output", str(folder / output)]) == 1
    said = capsys.readouterr()
    told = faults.one_sentence(said.err)
    assert words in told and str(folder / output).rstrip("/") in told
    # what can be told at once is not told after all the work
    assert ("100 %" in said.out) == (words == "cannot be written")
    assert faults.contents(folder) == before and (folder / "shut").is_dir() and (folder / "pipe.blend").is_fifo()


def blenders_own(path: str) -> None:
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True)


@pytest.mark.parametrize("versions", [0, 1, 3])
@pytest.mark.parametrize("links", [True, False])
def test_backups_are_kept_as_blender_keeps_them(save_blend, saved_scene, monkeypatch, versions, links):
    if not links:
        def refuse(*_, **__):
            raise NotImplementedError
        monkeypatch.setattr(os, "link", refuse)
    bpy.context.preferences.filepaths.save_version = versions
    names, folders = [], [saved_scene.parent.parent / name for name in ("ours", "blender")]
    for folder, save in zip(folders, (save_blend, blenders_own)):
        folder.mkdir()
        for number in range(5):
            bpy.context.scene.frame_current = number
            save(str(folder / "x.blend"))
        names.append(sorted(path.name for path in folder.iterdir()))
        told = []
        for path in sorted(folder.iterdir()):
            with bpy.data.libraries.load(str(path)) as (there, wanted):
                wanted.scenes = there.scenes
            told.append(wanted.scenes[0].frame_current)
            bpy.data.scenes.remove(wanted.scenes[0])
        assert told == [4 - number for number in range(versions + 1)]
    assert names[0] == names[1]


def test_relative_paths_lead_where_they_led(save_blend, saved_scene):
    folder = saved_scene.parent
    (folder / "deep").mkdir()
    data = bpy.data.images.new("Made", 4, 4)
    data.filepath_raw, data.file_format = str(folder / "picture.png"), "PNG"
    data.save()
    image = bpy.data.images.load(str(folder / "picture.png"))
    image.filepath = "//picture.png"
    image.use_fake_user = True
    for path in (saved_scene, folder / "deep" / "other.blend"):
        save_blend(str(path))
    assert image.filepath == "//picture.png" and bpy.data.filepath == str(saved_scene)
    for path in (saved_scene, folder / "deep" / "other.blend"):
        bpy.ops.wm.open_mainfile(filepath=str(path))
        found = bpy.data.images["picture.png"].filepath
        assert found.startswith("//") and os.path.samefile(bpy.path.abspath(found), folder / "picture.png")


def test_a_link_in_place_of_the_file_is_replaced(save_blend, saved_scene):
    precious = saved_scene.with_name("precious.blend")
    precious.write_bytes(b"mine")
    link = saved_scene.with_name("link.blend")
    link.symlink_to(precious)
    save_blend(str(link))
    assert precious.read_bytes() == b"mine" and not link.is_symlink() and opens(link)
