"""Lamps that are scaled, or not normalised, beside the lamp itself behind a flat mirror, as Cycles shows that."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import inner, light_and_lamp_behind, scene_of
from mathutils import Matrix


def shares(mirror: bpy.types.Object, lamp: bpy.types.Object, tmp_path) -> np.ndarray:
    """How much brighter the light is than that of the lamp behind the mirror, within it."""
    bpy.context.scene.cycles.max_bounces = 0
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light) & inner(expected)]
    assert len(ratio) > 200
    return ratio


@pytest.mark.thorough
@pytest.mark.parametrize("scale", [(2.0, 1.0, 1.0), (1.0, 1.0, 3.0), (1.0, -1.0, 0.5)], ids=str)
def test_a_spot_that_is_scaled_has_its_cone_drawn_out(blank, tmp_path, scale):
    floor, mirror, lamp = scene_of("SPOT")
    lamp.scale = scale
    blank.view_layer.update()
    ratio = shares(mirror, lamp, tmp_path)
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 2e-3
    assert np.percentile(np.abs(ratio - 1.0), 90) < 0.02


def test_the_cone_of_a_scaled_spot_holds_all_that_it_lights(blank, room):
    """By ways in the lamp's own space, strewn over its rim; sheared by its parent as well."""
    floor, mirror, lamp = scene_of("SPOT", spot_size=1.0)
    lamp.parent, lamp.scale = mirror, (0.5, 3.0, 1.5)
    lamp.matrix_parent_inverse = Matrix.Shear("XY", 4, (0.7, 0.2))
    blank.view_layer.update()
    eye, = room("addon.illumination").eyes_of(blank.evaluated_depsgraph_get(), lamp, 1, np.zeros(3))
    angle, matrix = np.linspace(0.0, 2.0 * np.pi, 1001), np.array(lamp.matrix_world, dtype=np.float64)[:3, :3]
    rim = np.stack((np.sin(0.5) * np.cos(angle), np.sin(0.5) * np.sin(angle), np.full(1001, -np.cos(0.5)))).T
    shining = eye.shining
    axis, half = shining.cone
    ways = rim @ matrix.T
    off = np.arccos(ways @ axis / np.linalg.norm(ways, axis=1))
    assert off.max() <= half < 1.01 * off.max() and shining.narrow <= off.min()
    inside, outside = (shining.share(eye.lamp.place + (rim + (0.0, 0.0, step)) @ matrix.T) for step in (-0.05, 0.05))
    assert (inside > 0.0).all() and (outside == 0.0).all()


@pytest.mark.thorough
@pytest.mark.skipif("normalize" not in bpy.types.Light.bl_rna.properties, reason="all lamps are normalised")
@pytest.mark.parametrize("kind, values", [
    ("POINT", {}), ("SPOT", {}), ("POINT", {"shadow_soft_size": 0.02}), ("SUN", {}), ("SUN", {"angle": 0.02})], ids=str)
def test_a_lamp_that_is_not_normalised_is_as_bright(blank, tmp_path, kind, values):
    """Without a size Cycles takes it for one of 1."""
    floor, mirror, lamp = scene_of(kind, normalize=False, **values)
    assert np.abs(np.median(shares(mirror, lamp, tmp_path), axis=0) - 1.0).max() < 5e-3


def test_a_spot_that_is_flat_is_told(blank):
    floor, mirror, lamp = scene_of("SPOT")
    lamp.parent, lamp.matrix_parent_inverse = floor, Matrix.Diagonal((1.0, 1.0, 0.0, 1.0))
    blank.view_layer.update()
    assert "scale of zero" in parts.refusal(bpy.ops.reflection_mesh.caustics)
