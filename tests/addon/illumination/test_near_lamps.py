"""Lamps whose size is no longer small beside their distance, and those that a mirror stands around."""
from __future__ import annotations

import bpy
import numpy as np
import pytest
from caustic_scene import add_lamp, aim, rendered, scene_of

RADIUS = 0.35


def lamp_with(kind: str, soft: bool) -> bpy.types.Object:
    lamp = add_lamp("Lamp", kind, (0.3, 0.2, 0.1), shadow_soft_size=RADIUS, color=(1.0, 1.0, 1.0))
    lamp.data.use_soft_falloff = soft
    bpy.context.view_layer.update()
    return lamp


@pytest.mark.parametrize("soft", [True, False])
def test_a_lamp_among_mirrors_lights_all_of_them_as_it_is(blank, room, soft):
    """What falls on small mirrors all round it, in closed form: of a disc that faces each of them, or of a ball. It
    was that of a disc that faced one way alone, 11 % more of the light in a bowl 0.4 before a lamp of 0.2."""
    lamp, rng = lamp_with("POINT", soft), np.random.default_rng(3)
    way = rng.normal(size=(400, 3))
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    distance = rng.uniform(2.0, 5.0, 400) * RADIUS
    places = np.array(lamp.location) + distance[:, None] * way
    eyes = room("addon.illumination").eyes_of(blank.evaluated_depsgraph_get(), lamp, 1000, places)
    middle = np.array(lamp.location)
    towards = np.stack([places - eye.lamp.place for eye in eyes])
    length = np.linalg.norm(towards, axis=2)
    light = np.stack([eye.power[0] * eye.shining.share(places) for eye in eyes]) / length**2
    # across mirrors that look at the lamp's middle
    got = (light * np.einsum("enc,nc->en", towards / length[:, :, None], way)).sum(axis=0)
    radiance = 100.0 / (4.0 * np.pi) / (np.pi * RADIUS**2)
    solid = np.pi * RADIUS**2 / (distance**2 + (RADIUS**2 if soft else 0.0))
    np.testing.assert_allclose(got, radiance * solid, rtol=0.02)
    assert abs((got / (radiance * solid)).mean() - 1.0) < 2e-3
    # as wide across every way: a disc's places are half its radius off its middle along any line, in the mean square
    off = np.stack([eye.lamp.place - middle for eye in eyes])
    spread = np.sqrt(((off @ way.T)**2).mean(axis=0))
    assert np.ptp(spread) < 0.02 * spread.mean()
    if not soft:
        np.testing.assert_allclose(spread, 0.5 * RADIUS, rtol=0.02)


@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "soft"), [("POINT", True), ("SPOT", False)])
def test_a_large_lamp_near_a_mirror_is_as_bright_as_in_cycles(blank, tmp_path, kind, soft):
    """Its radius is a third of its distance: it was 7 % too bright with a soft falloff, and 2 % too dark without.
    Cycles finds a lamp of that size with little noise."""
    floor, mirror, lamp = scene_of(kind, shadow_soft_size=0.25)
    if kind == "SPOT":
        lamp.data.spot_size = 2.6
    lamp.data.use_soft_falloff = soft
    aim(lamp, (0.55, 0.05, 1.0))
    cycles = blank.scene.cycles
    cycles.use_adaptive_sampling = False
    cycles.diffuse_bounces, mirror.visible_camera = 1, False
    alone = bpy.data.collections.new("Mirror alone")
    alone.objects.link(mirror)
    lamp.light_linking.receiver_collection = alone
    expected = rendered(tmp_path, 512).mean()
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", eyes=24, leave_out=False) == {"FINISHED"}
    cycles.caustics_reflective = False
    assert rendered(tmp_path, 16).mean() == pytest.approx(expected, rel=0.01)


def test_one_place_is_the_middle(blank, room):
    lamp = lamp_with("POINT", True)
    eye, = room("addon.illumination").eyes_of(blank.evaluated_depsgraph_get(), lamp, 1, np.array(((9.0, 0.0, 0.0),)))
    np.testing.assert_array_equal(eye.lamp.place, np.array(lamp.location, dtype=np.float64))
