"""What is small beside all that is lit: light lies close to it."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import light_and_lamp_behind, scene_of


@pytest.mark.thorough
@pytest.mark.parametrize("projection", ["PERSP", "ORTHO"])
def test_light_lies_close_to_a_small_ball_on_a_wide_floor(blank, tmp_path, projection):
    """It stood before the ball by a part of the floor's size, in a shell whose border shone beside the ball."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    floor.scale, mirror.scale = (20.0, 20.0, 20.0), (200.0, 200.0, 200.0)
    ball = parts.add("uv_sphere", "Ball", segments=48, ring_count=24, radius=0.1, location=(0.1, -0.5, 0.2))
    ball.data.polygons.foreach_set("use_smooth", [True] * len(ball.data.polygons))
    ball.data.materials.append(floor.active_material)
    camera = blank.scene.camera
    camera.location, camera.data.type = (0.1, -0.5, 6.0), projection
    camera.data.ortho_scale, camera.data.angle = 0.4, 0.07
    parts.select(floor, ball, lamp, mirror)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    assert np.ptp(parts.attribute(bpy.data.objects["Mirror Caustics"], "position")[:, 0]) > 100.0
    # all pixels: the ball, its shadow and the floor
    assert expected.min() == 0.0 and np.abs(light - expected).mean() < 0.01 * expected.mean()
