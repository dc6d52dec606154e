"""Light that mirrors throw, played without the extension: frame by frame what *Generate Caustics* makes of it."""
from __future__ import annotations

from pathlib import Path

import bpy
import caustic_scene
import faults
import numpy as np
import parts
import pytest
from baked_frames import assert_same, bake, names, stopped_at_each_stage
from caustic_scene import add_lamp, scene_of
from played import generated, played

SAMPLES = Path(__file__).resolve().parents[3] / "sample_blends"
FRAMES = [1, 2, 3, 4]


@pytest.fixture
def thrown(blank, tmp_path) -> Path:
    """A mirror that turns before a floor of two materials, and a lamp that goes out in frame 3, saved."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    floor.data.materials.append(parts.material("Second", "DIFFUSE"))
    tree = mirror.active_material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs["Color"], tree.nodes[0].inputs["Color"])
    other = parts.add("plane", "Ledge", size=0.5, location=(0.2, 0.4, 0.3))
    other.data.materials.append(floor.data.materials[1])
    for frame, turn, power in ((1, -1.5, 100.0), (2, -1.45, 120.0), (3, -1.4, 0.0), (4, -1.35, 80.0)):
        mirror.rotation_euler[1], lamp.data.energy = turn, power
        mirror.keyframe_insert("rotation_euler", frame=frame)
        lamp.data.keyframe_insert("energy", frame=frame)
    parts.select(floor, other, lamp, mirror)
    blank.scene.frame_start, blank.scene.frame_end = 1, 4
    blank.scene.frame_set(1)
    path = tmp_path / "work" / "scene.blend"
    path.parent.mkdir()
    blank.preferences.filepaths.save_version = 0
    bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=False)
    return path


def expected(frame: int, name: str, **options) -> dict:
    """What the operator makes of a frame of the open file."""
    bpy.context.scene.frame_set(frame)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", **options) == {"FINISHED"}
    wanted = generated(bpy.data.objects[name])
    # of the file that plays, whose frames all have their materials from the receivers
    wanted["materials"] = np.array([material.split(".")[0] for material in wanted["materials"]])
    return wanted


@pytest.mark.slow
def test_the_pool_plays_without_the_extension(room, tmp_path):
    """Its waves move: places, faces, materials and light of each frame are those that are generated there."""
    file, out, frames = SAMPLES / "pool.blend", tmp_path / "out", [1, 9]
    bpy.ops.wm.open_mainfile(filepath=str(file))
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1,9", "--tolerance", "4") == 0
    assert names(out) == {"pool caustics.blend", *(f"{stem}.{frame:04d}.{ending}" for frame in frames
                                                   for stem, ending in (("Frame_Caustics", "json"),
                                                                        ("Water_Caustics", "usdc")))}
    told = played(out / "pool caustics.blend", [9, 1], tmp_path / "played", ["Water Caustics"])
    bpy.ops.wm.open_mainfile(filepath=str(file))
    light = {}
    for frame in frames:
        wanted = expected(frame, "Water Caustics", tolerance=4.0)
        light[frame] = wanted[": CORNER FLOAT_VECTOR caustic_light"]
        assert {": CORNER FLOAT irradiance", ": POINT FLOAT_VECTOR mirror_position", ": FACE INT source_face",
                ": CORNER FLOAT2 UVMap"} <= set(wanted) and light[frame].max() > 0.0
        assert "Plaster Caustics" in wanted["materials"]
        assert_same(told, frame, "Water Caustics", wanted)
    assert len(light[1]) != len(light[9]) or not np.array_equal(light[1], light[9])


@pytest.mark.thorough
def test_a_lamp_that_goes_out_and_several_materials(thrown, room, tmp_path):
    before, out = thrown.read_bytes(), tmp_path / "out"
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--eyes", "2") == 0
    assert thrown.read_bytes() == before
    told = played(out / "scene caustics.blend", FRAMES, tmp_path / "played", ["Mirror Caustics"])
    assert len(told["3 Mirror Caustics places"]) == 0
    # it can be rendered: the material of light is in the file, and Cycles' own is left out
    lamp = bpy.data.objects["Lamp"]
    assert [child.name for child in lamp.light_linking.receiver_collection.objects] == ["Mirror"]
    assert bpy.data.node_groups["Metal Thrown"].users == 2
    bpy.ops.wm.open_mainfile(filepath=str(thrown))
    for frame in (1, 2, 4):
        wanted = expected(frame, "Mirror Caustics", eyes=2)
        assert set(wanted["materials"]) == {"Paint Caustics", "Second Caustics"}
        assert {": CORNER FLOAT_VECTOR mirror_light_0", ": CORNER FLOAT_VECTOR mirror_generated"} <= set(wanted)
        assert_same(told, frame, "Mirror Caustics", wanted)


@pytest.mark.thorough
def test_what_mirrors_do_not_show_is_lit(thrown, room, tmp_path):
    """Of a floor that is hidden from glossy rays frames had no light."""
    bpy.data.objects["Floor"].visible_glossy = False
    bpy.ops.wm.save_mainfile(compress=False)
    assert bake(room, "--what", "CAUSTICS", "--output", tmp_path / "out", "--frames", "2") == 0
    told = played(tmp_path / "out" / "scene caustics.blend", [2], tmp_path / "played", ["Mirror Caustics"])
    bpy.ops.wm.open_mainfile(filepath=str(thrown))
    bpy.data.objects["Floor"].visible_glossy = True
    assert_same(told, 2, "Mirror Caustics", expected(2, "Mirror Caustics"))


@pytest.mark.thorough
def test_reflections_and_light_play_in_one_file(thrown, room, tmp_path):
    """The second is baked with the file that plays the first."""
    out = tmp_path / "out"
    assert bake(room, "--output", out, "--frames", "1-2", "--light", "0") == 0
    bpy.ops.wm.open_mainfile(filepath=str(out / "scene reflections.blend"))
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1-2") == 0
    results = ["Mirror Caustics", "Mirror Reflection"]
    told = played(out / "scene reflections caustics.blend", [1, 2], tmp_path / "played", results)
    assert all(len(told[f"{frame} {name} places"]) for frame in (1, 2) for name in results)
    bpy.ops.wm.open_mainfile(filepath=str(thrown))
    assert_same(told, 2, "Mirror Caustics", expected(2, "Mirror Caustics"))


def test_a_frame_alone_by_the_verb(thrown, room, tmp_path):
    path = tmp_path / "lit.blend"
    assert room("addon.command_line").run(["caustics", "--frame", "4", "--scene", "Scene", "--camera", "Camera",
                                           "--output", str(path)]) == 0
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert bpy.context.scene.frame_current == 4
    made = generated(bpy.data.objects["Mirror Caustics"])
    bpy.ops.wm.open_mainfile(filepath=str(thrown))
    wanted = expected(4, "Mirror Caustics")
    assert all(np.array_equal(made[what], wanted[what]) for what in wanted)


@pytest.mark.thorough
def test_the_operator_lets_caustics_play_in_place(thrown, room, tmp_path):
    """Those that are there, with as many places on their lamp; then a still again, and cleared without a trace."""
    empty = parts.state()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=3) == {"FINISHED"}
    result, before = bpy.data.objects["Mirror Caustics"], parts.state()
    operator = bpy.ops.reflection_mesh.bake
    assert operator("EXEC_DEFAULT", what="CAUSTICS", frames="1-2", filepath=str(tmp_path / "out")) == {"FINISHED"}
    assert [obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"] == [result]
    assert room("addon.frames").plays(result) and result.reflection_mesh.eyes == 3
    assert result.reflection_mesh.mirror.name == "Mirror" and not result.hide_render
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=3) == {"FINISHED"}
    assert parts.state() == before and not result.modifiers and not bpy.data.cache_files
    assert operator("EXEC_DEFAULT", what="CAUSTICS", frames="1-2", filepath=str(tmp_path / "out")) == {"FINISHED"}
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert parts.state() == empty and not bpy.data.cache_files


@pytest.mark.thorough
def test_several_lamps_have_a_sequence_each(thrown, room, tmp_path):
    """Hidden in one frame, a lamp's own is empty there; frames that are there are kept."""
    other = add_lamp("Other", "SUN", (0.0, -1.0, 3.0))
    other.select_set(True)
    for frame, hidden in ((1, False), (2, True)):
        other.hide_render = hidden
        other.keyframe_insert("hide_render", frame=frame)
    bpy.ops.wm.save_mainfile()
    out = tmp_path / "out"
    for frames in ("2", "1-2"):
        assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", frames, "--frames-only") == 0
        bpy.ops.wm.open_mainfile(filepath=str(thrown))
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1-2") == 0
    results = ["Mirror Caustics Lamp", "Mirror Caustics Other"]
    told = played(out / "scene caustics.blend", [1, 2], tmp_path / "played", results)
    assert [[len(told[f"{frame} {name} places"]) > 0 for name in results] for frame in (1, 2)] == [[True, True],
                                                                                                   [True, False]]


@pytest.mark.slow
def test_stopped_at_any_step_the_file_is_as_it_was(thrown, room, tmp_path):
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    place, lamps = room("addon.operators.bake_frames"), (bpy.data.objects["Lamp"],)
    before, linked = parts.state(), lamps[0].light_linking.receiver_collection

    def steps(folder: str):
        wanted = room("addon.settings").Wanted(bpy.context.scene)
        plan = place.plan_of(bpy.context, str(tmp_path / folder), "1-2", wanted, lamps=lamps)
        return room("addon.operators.bake_frames.bake").baking(bpy.context, plan)

    def check(stage: str) -> None:
        assert parts.state() == before, stage

    assert len(stopped_at_each_stage(steps, check)) > 3
    assert lamps[0].light_linking.receiver_collection == linked and list(linked.objects) == [bpy.data.objects["Mirror"]]


def test_it_is_told_what_cannot_be(thrown, room, tmp_path, capsys):
    out = tmp_path / "out"
    camera = bpy.context.scene.camera.copy()
    camera.name = "Second"
    bpy.context.scene.collection.objects.link(camera)
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--camera", "Camera", "Second") == 1
    assert "the same for all cameras" in faults.one_sentence(capsys.readouterr().err)
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--eyes", "0") == 1
    assert "raise --eyes" in faults.one_sentence(capsys.readouterr().err)
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1", "--frames-only") == 0
    bpy.ops.wm.open_mainfile(filepath=str(thrown))
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1", "--eyes", "2") == 1
    assert "other settings" in faults.one_sentence(capsys.readouterr().err)
    bpy.data.objects.remove(bpy.data.objects["Lamp"])
    bpy.context.view_layer.update()
    assert bake(room, "--what", "CAUSTICS", "--output", out, "--frames", "1") == 1
    assert "There is no lamp" in faults.one_sentence(capsys.readouterr().err)


def test_cycles_own_is_left_out_of_frames_as_it_was_of_the_still(thrown, room, tmp_path):
    """By the operator and the verb, where nothing is said; else as it is said, and the next time again."""
    bake_frames, lamp = bpy.ops.reflection_mesh.bake, bpy.data.objects["Lamp"]
    options = {"what": "CAUSTICS", "frames": "1", "filepath": str(tmp_path / "out")}
    bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=False)
    record, told = bpy.data.objects["Mirror Caustics"].reflection_mesh, []
    for said in ({}, {"leave_out": True}, {}, {"leave_out": False}):
        assert bake_frames("EXEC_DEFAULT", **options, **said) == {"FINISHED"}
        told.append((record.keeps_own, lamp.light_linking.receiver_collection is None))
    assert told == [(True, True), (False, False), (False, False), (True, True)]
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=False)
    bpy.ops.wm.save_mainfile()
    for words, linked in (([], False), (["--replace-own"], True), (["--keep-own"], False)):
        bpy.ops.wm.open_mainfile(filepath=str(thrown))
        assert bake(room, "--what", "CAUSTICS", "--output", tmp_path / "out", "--frames", "1", *words) == 0
        bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "out" / "scene caustics.blend"))
        assert (bpy.data.objects["Lamp"].light_linking.receiver_collection is not None) == linked


def test_what_was_left_out_comes_back_where_it_is_kept(thrown):
    lamp = bpy.data.objects["Lamp"]
    for leave_out in (True, False):
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=leave_out) == {"FINISHED"}
        assert (lamp.light_linking.receiver_collection is not None) == leave_out


@pytest.mark.parametrize("leave_out", [True, False])
def test_the_panel_after_a_bake_shows_what_was_used(blank, tmp_path, leave_out):
    """Of Cycles' own caustics too, though that was said when the light was generated; the next bake is not told."""
    floor, mirror, lamp = caustic_scene.scene_of()
    parts.select(floor, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", leave_out=leave_out) == {"FINISHED"}
    # as from a button: such runs have a panel
    assert bpy.ops.reflection_mesh.bake("EXEC_DEFAULT", True, what="CAUSTICS", filepath=str(tmp_path),
                                        frames="1") == {"FINISHED"}
    ran = bpy.context.window_manager.operators[-1]
    assert ran.bl_idname == "REFLECTION_MESH_OT_bake" and ran.properties.leave_out == leave_out
