"""Light by rays one by one, against closed forms; and meshes of light against it, where they failed once."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core import Lamp, caustics
from core.rivals.tracing import LightRays
from tests.core.caustics.test_caustics import (
    RING_LAMPS,
    bent_strip,
    level,
    light_of_ring,
    seen_from_below,
    solid_angle,
    upright,
)
from tests.fuzz.drawing.lights import drawn_light
from tests.fuzz.kept import kept_seeds
from tests.fuzz.light_trial import light_problems, sent_light

SEEDS = range(20)  # `make fuzz` tries others


def test_a_flat_mirror_sends_all_that_it_is_sent():
    lamp, mirror, floor = Lamp((1.0, 0.0, 3.0)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0)
    landed = LightRays(mirror, floor).thrown(lamp, 200_000)
    assert abs(landed.flux.sum() / solid_angle(lamp.place, mirror) - 1.0) < 1e-4
    # on straight ways from the lamp behind the mirror
    way, start = landed.points - (-1.0, 0.0, 3.0), landed.start - (-1.0, 0.0, 3.0)
    assert np.abs(np.cross(way, start)).max() < 1e-12 and not landed.bent.any()
    assert np.allclose(landed.cosine[0], np.abs(landed.start[:, 0] - 1.0) / np.linalg.norm(
        landed.start - lamp.place, axis=1))
    sun = LightRays(mirror, floor).thrown(Lamp.shining((-1.0, 0.0, -1.0)), 10_000)
    assert abs(sun.flux.sum() - np.sqrt(0.5)) < 1e-9


@pytest.mark.thorough
def test_a_lamp_close_to_the_mirror_is_no_trouble():
    lamp, mirror, floor = Lamp((1e-3, 0.1, 1.5)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 50.0)
    landed = [LightRays(mirror, floor).thrown(lamp, 100_000, seed).flux.sum() for seed in range(4)]
    ways = caustics(lamp, mirror, floor).flux.sum()
    assert np.std(landed) < 1e-3 * ways and abs(np.mean(landed) / ways - 1.0) < 1e-3


def test_rays_are_weighted_as_a_path_tracer_finds_them():
    sun, floor = Lamp.shining((-1.0, 0.0, -1.0)), level(0.0, 0.0, -3.0, 60.0)
    landed = LightRays(bent_strip(0.35), floor).thrown(sun, 100_000)
    assert not landed.bent.any() and abs(landed.flux.sum() / seen_from_below(0.35, sun) - 1.0) < 1e-3


@pytest.mark.thorough
def test_what_stands_in_the_way_hides():
    lamp, mirror, floor = Lamp((1.0, 0.0, 3.0)), upright(0.0, 1.5, 0.5), level(0.0, 0.0, 0.0, 9.0)
    whole = solid_angle(lamp.place, mirror)
    before, after = upright(0.4, 2.1, 0.1), level(0.8, 0.0, 0.6, 0.1)
    shaded = LightRays(mirror, floor, blockers=before).thrown(lamp, 400_000).flux.sum()
    assert abs(shaded - (whole - solid_angle(lamp.place, before))) < 1e-3 * whole
    hidden = LightRays(mirror, floor, blockers=after).thrown(lamp, 400_000).flux.sum()
    assert abs(hidden - (whole - solid_angle((-1.0, 0.0, 3.0), after))) < 1e-3 * whole


@pytest.mark.thorough
def test_several_bounces_are_followed():
    lamp, floor = Lamp((1.0, 0.0, 4.0)), level(0.0, 0.0, 0.0, 9.0)
    first, second = upright(0.0, 3.0, 0.5), upright(0.5, 2.0, 0.5)
    rays = LightRays(first, floor, second)
    one, two = rays.thrown(lamp, 100_000), rays.thrown(lamp, 100_000, depth=2)
    again = two.met[1] >= 0
    assert again.any() and (two.met[1][again] >= 2).all()
    assert abs(two.flux[~again].sum() - one.flux.sum()) < 1e-12
    # by the first mirror the lamp is at x = -1, by the second that is at x = 2
    way, start = (two.points - (2.0, 0.0, 4.0))[again], (two.start * (-1.0, 1.0, 1.0) + (1.0, 0.0, 0.0) - (
        2.0, 0.0, 4.0))[again]
    assert np.abs(np.cross(way, start)).max() < 1e-9


@pytest.mark.thorough
def test_a_screen_that_ends_in_a_camera_to_the_last_bit_does_not_fill_it():
    """Rays of parallel light that leave a flat triangle are parallel, and the sides that they meet straight."""
    one = drawn_light(68)
    expected = LightRays(one.mirror, one.receivers, one.others, one.blockers).thrown(one.lamp, 200_000).flux.sum()
    assert abs(caustics(*one.arguments).flux.sum() / expected - 1.0) < 1e-3


@pytest.mark.thorough
def test_light_that_grazes_stays_on_what_it_lights():
    """A line of the lamp's picture within the tolerance runs far out where light grazes."""
    for seed in (2, 40):
        one = drawn_light(seed)
        mesh = caustics(*one.arguments)
        corners = one.receivers.positions[one.receivers.triangles[mesh.source_face]]
        assert np.abs(np.matmul(mesh.source_weights, corners) - mesh.positions[mesh.triangles]).max() < 1e-6


@pytest.mark.thorough
def test_slivers_keep_no_more_light_than_single_precision_shows():
    for seed in (0, 8):
        one = drawn_light(seed)
        mesh = caustics(*one.arguments)
        places = (mesh.positions - mesh.positions.mean(axis=0)).astype(np.float32).astype(float)[mesh.triangles]
        area = 0.5 * np.linalg.norm(np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]), axis=1)
        assert abs((area * mesh.irradiance.mean(axis=1)).sum() / mesh.flux.sum() - 1.0) < 1e-2


@pytest.mark.thorough
def test_the_flux_of_a_ring_is_that_of_rays():
    for which in (0, 1):
        mirror, table, mesh = light_of_ring(which)
        thrown = LightRays(mirror, table)
        rays = [thrown.thrown(RING_LAMPS[which], 100_000, seed).flux.sum() for seed in range(4)]
        assert abs(mesh.flux.sum() / np.mean(rays) - 1.0) < 1e-3


@pytest.mark.slow
def test_light_that_runs_along_a_second_mirror_is_what_rays_find():
    """Slivers far below a pixel of the lamp's picture are sent over half the scene there, hundreds of times as bright
    as they fell on the mirrors; no more of them may pass than a hundred-thousandth of the light."""
    one = drawn_light(1795485998011)
    rays = LightRays(one.mirror, one.receivers, one.others, one.blockers)
    assert not any(len(rays.thrown(one.lamp, 60_000, seed, 2).flux) for seed in range(2))
    for tolerance in (0.5, 2.0):
        settings = replace(one.settings, tolerance=tolerance)
        mesh = caustics(one.lamp, one.mirror, one.receivers, settings, one.others, one.blockers)
        assert mesh.flux.sum() < 1e-5 * sent_light(one)


@pytest.mark.thorough
@pytest.mark.parametrize("seed", kept_seeds("light"))
def test_kept_seeds(seed):
    assert light_problems(drawn_light(seed)) == []


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_lamps_at_random(seed):
    assert light_problems(drawn_light(seed)) == []
