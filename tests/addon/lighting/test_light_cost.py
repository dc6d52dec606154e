"""Light beside one Cycles render of the frame with the same samples: the processor time of both."""
from __future__ import annotations

import os
from pathlib import Path

import bpy
import pytest
from lamp_scenes import SAMPLES

FOLDER = Path(__file__).resolve().parents[3] / "sample_blends"
SIZE = 128


def processor_time() -> float:
    """Seconds of all threads."""
    return sum(os.times()[:2])


# measured: 0.21, 0.29 and 0.83 at 64 samples and 144 pixels
@pytest.mark.thorough
@pytest.mark.parametrize(("name", "most"), [("room", 0.3), ("bathroom", 0.4), ("pond", 1.05)])
def test_light_takes_less_than_a_render(name, most, tmp_path):
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / f"{name}.blend"))
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.filepath, scene.cycles.samples, scene.cycles.device = str(tmp_path / "frame.png"), SAMPLES, "CPU"
    started = processor_time()
    bpy.ops.render.render(write_still=True)
    cycles = processor_time() - started
    bpy.ops.reflection_mesh.generate()
    started = processor_time()
    bpy.ops.reflection_mesh.light(samples=SAMPLES)
    assert processor_time() - started < most * cycles
