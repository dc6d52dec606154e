"""What Generate says that a mirror lacks is said of baked frames too, each sentence once."""
from __future__ import annotations

import re

import bpy
import parts
import pytest
from baked_frames import bake, operate


@pytest.fixture
def crossed(moving, room) -> bpy.types.Object:
    """A post that comes up behind the mirror, in the way of its virtual image, in frames 2 and 3."""
    post = parts.add("cube", "Post", size=0.3, location=(0.25, 1.6, 1.0))
    for frame, height in ((1, -9.0), (2, 1.0), (4, -9.0)):
        post.location[2] = height
        post.keyframe_insert("location", frame=frame)
    for curve in room("addon.compat").curves_of(post):
        for key in curve.keyframe_points:
            key.interpolation = "CONSTANT"
    bpy.context.scene.frame_set(2)
    return post


def test_what_stands_before_the_virtual_image_is_told(crossed, room, tmp_path, capfd):
    """By operator and verb, with the frames of which it is so; nothing of frames that are kept."""
    parts.generate(placement="VIRTUAL")
    said = re.search(r"Warning: (Mirror: 'Post' hides a part of .*\.)\n", capfd.readouterr().out)[1]
    bpy.ops.reflection_mesh.clear()
    operate(tmp_path / "out", frames="1-4", samples=0, placement="VIRTUAL")
    assert re.findall(r"Warning: (In .*)\n", capfd.readouterr().out) == [f"In frames 2, 3: {said}"]
    common = ("--light", "0", "--placement", "VIRTUAL", "--frames-only", "--output")
    assert bake(room, *common, tmp_path / "out", "--frames", "1-4") == 0
    assert "In frame" not in capfd.readouterr().out
    assert bake(room, *common, tmp_path / "other", "--frames", "1-2") == 0
    assert f"In frame 2: {said}" in capfd.readouterr().out.splitlines()
    assert room("addon.operators.bake_frames.plan").lacking(
        {1: ["A: 7 % is gone."], 2: ["A: 12.5 % is gone.", "B: all."]}) == [
            "In frames 1, 2: A: 7 % is gone.", "In frame 2: B: all."]


def test_a_frame_in_which_the_mirror_can_be_no_window_does_not_end_the_others(crossed, tmp_path, capfd):
    """It is empty, and told as Generate tells it."""
    crossed.scale = (30.0, 1.0, 30.0)
    bpy.context.scene.frame_set(3)
    refused = parts.refusal(placement="VIRTUAL")
    assert "'Post' stands before the virtual image" in refused
    capfd.readouterr()
    operate(tmp_path / "out", frames="1-4", samples=0, placement="VIRTUAL")
    assert re.findall(r"Warning: (In .*)\n", capfd.readouterr().out) == [f"In frames 2, 3: {refused}"]
    shown = []
    for frame in (1, 2, 3, 4):
        bpy.context.scene.frame_set(frame)
        result = bpy.data.objects["Mirror Reflection"].evaluated_get(bpy.context.evaluated_depsgraph_get())
        shown.append(len(result.data.polygons) > 0)
    assert shown == [True, False, False, True]


@pytest.mark.slow
def test_what_other_processes_have_seen_is_told(crossed, room, tmp_path, capfd):
    given = {"frames": "1-3", "samples": 0, "placement": "VIRTUAL"}
    operate(tmp_path / "one", **given)
    said = re.search(r"Warning: In frames 2, 3: (.*)\n", capfd.readouterr().out)[1]
    operate(tmp_path / "two", jobs=2, **given)
    assert set(re.findall(r"Warning: (In .*)\n", capfd.readouterr().out)) == {f"In frame {n}: {said}" for n in (2, 3)}
    assert bake(room, "--light", "0", "--placement", "VIRTUAL", "--frames-only", "--output", tmp_path / "three",
                "--frames", "1-2", "--jobs", "2") == 0
    assert f"In frame 2: {said}" in capfd.readouterr().out.splitlines()
