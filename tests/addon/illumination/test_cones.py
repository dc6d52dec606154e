"""Lamps whose cone is smaller than the mirror: light ends where the cone does."""
from __future__ import annotations

import bpy
import numpy as np
import pytest
from caustic_scene import light_and_lamp_behind, scene_of


@pytest.mark.thorough
@pytest.mark.parametrize("kind, values", [("SPOT", {"spot_size": 0.2, "spot_blend": 0.0}),
                                          ("SPOT", {"spot_size": 0.25, "spot_blend": 0.8}),
                                          ("AREA", {"size": 0.01, "spread": 0.25})])
def test_a_cone_in_the_middle_of_a_large_mirror_is_all_there(blank, tmp_path, kind, values):
    floor, mirror, lamp = scene_of(kind, **values)
    mirror.scale = (2.0, 8.0, 1.0)
    bpy.context.view_layer.update()
    blank.scene.cycles.max_bounces = 0
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    assert (expected > 0.01 * expected.max()).sum() > 50
    assert np.abs(light.sum(axis=(0, 1)) / expected.sum(axis=(0, 1)) - 1.0).max() < 0.01
    assert np.abs(light - expected).sum() < 0.03 * expected.sum()
