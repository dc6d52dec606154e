"""Crowds: what is too much for the picture or the memory is shown by rays, within bounds, and the result says so."""
import time
import tracemalloc

import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from core.limits import Limits, crowded
from tests import shapes
from tests.core.true_map import case_of, truth_of
from tests.judge import compare

VIEW = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.5), (96, 72))


def soup(count, seed, size=0.8):
    """Triangles across each other in a ball of radius about one."""
    rng = np.random.default_rng(seed)
    middles = rng.normal(0.0, 0.5, (count, 1, 3))
    return TriangleMesh((middles + rng.normal(0.0, size, (count, 3, 3))).reshape(-1, 3),
                        np.arange(3 * count).reshape(-1, 3))


@pytest.mark.parametrize("name", ["sphere", "flat", "water", "bowl"])
def test_rays_alone_show_the_right_thing_to_a_pixel(name):
    # a memory that holds hardly a candidate leaves everything to rays
    case, truth = case_of(name), truth_of(name)
    mesh = reflect(case.view, case.mirror, case.scene, Settings(maximum_memory=1e-4))
    numbers = compare(case.view, case.mirror, mesh, truth).numbers
    assert mesh.counts["crowded"] > 0 and mesh.counts["crowd_rays"] < 2 * mesh.counts["mirror_pixels"]
    assert numbers["p99"] < 1.0 and numbers["median"] < 0.01
    assert numbers["uncovered"] < 1.0 and numbers["spill_outside"] == 0.0
    assert mesh.counts["missed"] == 0


def test_ordinary_scenes_have_no_crowds():
    for name in ("sphere", "flat", "water", "bowl"):
        case = case_of(name)
        assert "crowded" not in reflect(case.view, case.mirror, case.scene).counts


def test_crossing_mirrors_take_bounded_time_and_show_the_scene():
    mirror, scene = soup(250, 3), shapes.combine(shapes.icosphere((0.0, -3.0, 1.0), 0.8, 2))
    started = time.process_time()
    mesh = reflect(VIEW, mirror, scene, Settings(depth=2))
    assert time.process_time() - started < 10.0
    assert mesh.counts["crowded"] > 0
    assert len(mesh.triangles) < 40 * mesh.counts["mirror_pixels"]
    assert mesh.missing_share < 25.0


def test_what_is_made_does_not_grow_with_what_the_picture_cannot_show():
    # a mirror of a few pixels before 4,000 triangles
    mirror = TriangleMesh(0.02 * soup(200, 4).positions, soup(200, 4).triangles)
    scene = soup(4000, 5, 0.3)
    scene = TriangleMesh(scene.positions + [0.0, -2.0, 1.0], scene.triangles)
    started = time.process_time()
    mesh = reflect(VIEW, mirror, scene, Settings(depth=2))
    assert time.process_time() - started < 10.0
    assert mesh.counts["mirror_pixels"] < 100
    assert len(mesh.triangles) < 250_000


@pytest.mark.parametrize("gigabytes", [0.2, 0.05])
def test_arrays_stay_within_the_memory_that_is_allowed(gigabytes):
    mirror, scene = soup(150, 6), soup(1500, 7, 0.2)
    tracemalloc.start()
    try:
        reflect(VIEW, mirror, scene, Settings(maximum_memory=gigabytes))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # what one share of the work takes at a time comes to what the memory holds
    assert peak < 1e9 * gigabytes + 2e8


def test_the_most_crowded_for_their_worth_are_left_out():
    count, worth = np.array([10, 10, 1, 100]), np.array([10.0, 1.0, 1.0, 1000.0])
    assert crowded(count, worth, 121).tolist() == [False] * 4
    assert crowded(count, worth, 120).tolist() == [False, True, False, False]
    assert crowded(count, worth, 100).tolist() == [True, True, True, False]
    assert crowded(count, worth, 0).tolist() == [True] * 4


def test_limits_grow_with_the_picture_and_the_memory():
    small, large = (Limits.of(Settings(), pixels, 1000) for pixels in (100, 100_000))
    assert small.candidates < large.candidates and small.rays < large.rays and small.cameras < large.cameras
    tight = Limits.of(Settings(maximum_memory=0.01), 100_000, 1000)
    assert tight.candidates < large.candidates and tight.faces < large.faces and tight.pairs < large.pairs
    assert Limits.of(Settings(maximum_memory=np.inf), 100, 1000).faces == Settings().maximum_faces
