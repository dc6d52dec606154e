"""A right animation of 24 frames in one command, as a person would type it: of a sample whose camera and cube move."""
from __future__ import annotations

import subprocess
from pathlib import Path

import bpy
import faults
import numpy as np
import parts
import pytest
from baked_frames import assert_same, names
from mathutils import Matrix
from played import generated, played

SAMPLE = faults.ROOT / "sample_blends" / "sphere.blend"
RESULT = "Mirror Sphere Reflection"
COUNT = 24


@pytest.fixture
def animated(blank, tmp_path) -> Path:
    """The sample with a camera that goes round the ball and a cube that moves, 64 x 64 pixels, saved elsewhere."""
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLE))
    scene = bpy.context.scene
    camera, cube = scene.camera, bpy.data.objects["Red Cube"]
    rest = camera.matrix_world.copy()
    for frame, turn, along in ((1, 0.0, 0.0), (COUNT, 0.5, 0.8)):
        camera.matrix_world = Matrix.Rotation(turn, 4, "Z") @ rest
        for path in ("location", "rotation_euler"):
            camera.keyframe_insert(path, frame=frame)
        cube.location.x += along
        cube.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, COUNT
    scene.frame_set(1)
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.render.resolution_percentage = 100
    path = tmp_path / "work" / "moving.blend"
    path.parent.mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    return path


@pytest.mark.slow
def test_twenty_four_frames_in_one_command(animated, tmp_path):
    """One for each, as `generate` makes them; they play in a Blender without the extension, and Cycles sees no other
    picture than where it traces the mirror."""
    out = tmp_path / "frames"
    done = subprocess.run(**faults.command(animated, "bake", "--frames", f"1-{COUNT}", "--output", out), check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    numbers = range(1, COUNT + 1)
    assert names(out) == {"moving reflections.blend", *(f"Frame.{frame:04d}.json" for frame in numbers),
                          *(f"Mirror_Sphere_Reflection.{frame:04d}.usdc" for frame in numbers)}
    shown = played(out / "moving reflections.blend", list(numbers), tmp_path / "played", [RESULT])
    assert len({shown[f"{frame} {RESULT} places"].tobytes() for frame in numbers}) == COUNT
    some = (1, 12, COUNT)
    traced = played(animated, some, tmp_path / "traced", picture=8)
    seen = played(out / "moving reflections.blend", some, tmp_path / "seen", picture=8)
    for frame in some:
        bpy.ops.wm.open_mainfile(filepath=str(animated))
        bpy.context.scene.frame_set(frame)
        assert_same(shown, frame, RESULT, generated(parts.generate()))
        apart = {other: np.abs(seen[f"{frame} picture"] - traced[f"{other} picture"]).mean() for other in some}
        assert 8.0 * apart[frame] < min(apart[other] for other in some if other != frame)
