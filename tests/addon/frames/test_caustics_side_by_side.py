"""Light that mirrors throw, baked by several processes into one folder: as one alone bakes it, and plays it."""
from __future__ import annotations

import sys
from contextlib import ExitStack
from pathlib import Path

import bpy
import faults
import parts
import pytest
from baked_frames import bake
from caustic_scene import scene_of

from tools import extension_zip


@pytest.fixture
def crowded(blank, tmp_path) -> Path:
    """A mirror that moves and throws the light of a lamp from several places on a floor, in more layers than Cycles
    follows, saved; the lamp goes out in the last frame."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.3)
    blank.scene.cycles.transparent_max_bounces = 2
    for frame, turn, power in ((1, -1.5, 100.0), (2, -1.45, 120.0), (3, -1.4, 0.0)):
        mirror.rotation_euler[1], lamp.data.energy = turn, power
        mirror.keyframe_insert("rotation_euler", frame=frame)
        lamp.data.keyframe_insert("energy", frame=frame)
    parts.select(floor, lamp, mirror)
    blank.scene.frame_start, blank.scene.frame_end = 1, 3
    blank.scene.frame_set(1)
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path


def told_by(path: Path) -> dict:
    """What the file that plays the frames in a folder says of light, and of Cycles' own."""
    bpy.ops.wm.open_mainfile(filepath=str(path / "scene caustics.blend"))
    scene, lamp, result = bpy.context.scene, bpy.data.objects["Lamp"], bpy.data.objects["Mirror Caustics"]
    linked = lamp.light_linking.receiver_collection
    return {"layers": scene.cycles.transparent_max_bounces, "eyes": result.reflection_mesh.eyes,
            "left out": [child.name for child in linked.objects] if linked else [],
            "glints": sorted(obj.name for obj in bpy.data.objects if obj.type == "LIGHT"),
            "materials": [slot.material.name for slot in result.material_slots]}


def at_once(file: Path, words: tuple, chunks: list[str]) -> None:
    """Bake chunks of frames by a process each, all at the same time."""
    with ExitStack() as stack:
        processes = [stack.enter_context(faults.running(**faults.command(
            file, "bake", *words, "--frames-only", "--frames", chunk))) for chunk in chunks]
        for process in processes:
            assert process.communicate()[1] == "" and process.returncode == 0


def one_by_one(file: Path, words: tuple, chunks: list[str]) -> None:
    run = sys.modules[f"{extension_zip.PACKAGE}.addon.command_line"].run
    for chunk in chunks:
        bpy.ops.wm.open_mainfile(filepath=str(file))
        assert run(["bake", *map(str, words), "--frames-only", "--frames", chunk]) == 0


@pytest.mark.thorough
@pytest.mark.parametrize(("own", "chunks", "baked"), [
    ("--replace-own", ["1-2", "1-2"], at_once), ("--replace-own", ["3", "1-2"], one_by_one),
    ("--keep-own", ["2", "1,3", "2"], one_by_one)])
def test_chunks_end_as_one_process_does(crowded, room, tmp_path, own, chunks, baked):
    """What plays them is written by a process that makes one frame at most, and has as many layers of light followed,
    and Cycles' own caustics left out or kept."""
    words = ("--what", "CAUSTICS", "--eyes", "4", "--tolerance", "8", own, "--output")
    one, many = tmp_path / "one", tmp_path / "many"
    assert bake(room, *words, one) == 0
    baked(crowded, (*words, many), chunks)
    bpy.ops.wm.open_mainfile(filepath=str(crowded))
    assert bake(room, *words, many) == 0
    made, wanted = faults.contents(many), faults.contents(one)
    assert made.pop("scene caustics.blend") and wanted.pop("scene caustics.blend")
    assert len(wanted) == 6 and made == wanted
    told = told_by(many)
    assert told == told_by(one)
    assert told["layers"] > 2 and told["eyes"] == 4
    assert told["left out"] == (["Mirror"] if own == "--replace-own" else [])
