"""Light that mirrors throw, sent on by what it falls on."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import light_and_lamp_behind, scene_of


@pytest.mark.thorough
def test_light_that_diffuse_rays_see_lights_others_as_in_cycles(blank, tmp_path):
    """A wall that turns its back to the mirror, lit by the floor alone; the switch stays when light is made again."""
    floor, mirror, lamp = scene_of()
    cycles = blank.scene.cycles
    cycles.max_bounces = cycles.diffuse_bounces = 1
    mirror.scale, mirror.visible_camera, mirror.visible_diffuse = (50.0, 50.0, 50.0), False, False
    wall = parts.add("plane", "Wall", size=1.0, location=(0.3, 0.7, 0.3), rotation=(0.0, -1.0, 0.0))
    wall.data.materials.append(floor.active_material)
    parts.select(floor, wall, lamp, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    bpy.data.objects["Mirror Caustics"].visible_diffuse = True
    parts.select(floor, wall, lamp, mirror)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    across, along = np.meshgrid(*2 * [3.0 * (np.arange(64) + 0.5) / 64.0 - 1.5])
    front = (np.abs(across - 0.3) < 0.2) & (np.abs(along - 0.7) < 0.4)
    assert 0.0 < expected[front].mean() < 0.3 * expected.mean()
    assert light[front].mean() == pytest.approx(expected[front].mean(), rel=0.05)
