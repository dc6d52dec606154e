"""Ray tracing per pixel and by clusters: the truth itself, and as much work as can be counted by hand."""
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from core import View
from core.rivals import ITSELF, primary_hits
from core.rivals.clustering import clustered
from core.rivals.primary_hits import by_face
from core.rivals.ray_tracing import traced
from core.rivals.tracing import cones_around
from tests.inputs import shapes
from tests.oracles.judge import compare_picture
from tests.oracles.true_map import case_of, truth_of

PIXELS = 80
NAMES = ["sphere", "flat_ortho", "water", "bowl", "torus", "sphere_far", "sphere_small"]


@cache
def given(name, pixels=PIXELS):
    case = case_of(name, pixels)
    return case, primary_hits(case.view, case.mirror, case.scene), truth_of(name, pixels)


@pytest.mark.thorough
@pytest.mark.parametrize("name", NAMES)
def test_every_rival_is_given_the_mirror_that_the_eye_sees(name):
    case, hits, truth = given(name)
    assert np.array_equal(hits.pixel, np.flatnonzero(truth.mirror_triangle >= 0))
    assert np.array_equal(hits.face, truth.mirror_triangle[hits.pixel])
    size = np.ptp(case.mirror.positions[case.mirror.triangles.ravel()], axis=0).max()
    assert np.abs(hits.place.T - truth.mirror_position[hits.pixel]).max() < 1e-9 * size
    straight = ~truth.bent[hits.pixel]
    assert np.abs(hits.ray.T - truth.direction[hits.pixel])[straight].max() < 1e-9
    # what is said of rays that cannot meet the mirror is certain
    assert not truth.sees_itself[hits.pixel][straight & ~hits.meets_mirror].any()
    for depth, true in ((hits.mirror_depth, truth.mirror_depth), (hits.scene_depth, truth.scene_depth)):
        np.testing.assert_allclose(depth.ravel(), true, rtol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("rival, knob", [(traced, 1), (clustered, 0), (clustered, 16)])
@pytest.mark.parametrize("name", NAMES)
def test_ray_tracing_shows_the_truth_at_every_pixel(name, rival, knob):
    case, hits, truth = given(name)
    picture = rival(case.view, case.mirror, case.scene, knob, hits)
    triangle, position = picture.triangle.ravel(), picture.position.reshape(-1, 3)
    sure = ~truth.bent
    expected = np.where(truth.sees_itself, ITSELF, truth.source_triangle)
    assert np.array_equal(triangle[sure], expected[sure])
    shown = sure & (triangle >= 0)
    size = np.ptp(case.scene.positions, axis=0).max()
    assert np.abs(position - truth.position)[shown].max() < 1e-6 * size
    numbers = compare_picture(case.view, truth, picture.triangle, picture.position).numbers
    assert numbers["maximum"] < 1e-6 and numbers["uncovered"] == 0.0 and numbers["compared"] > 500


def test_rays_for_blocks_are_exact_where_the_reflection_is_affine():
    # a flat mirror in an orthographic view: positions are affine in the pixel
    case, hits, truth = given("flat_ortho")
    for block in (2, 5, 8):
        picture = traced(case.view, case.mirror, case.scene, block, hits)
        assert compare_picture(case.view, truth, picture.triangle, picture.position).numbers["maximum"] < 1e-9
        assert picture.counts["rays"] < 0.8 * len(hits.pixel)


def test_fewer_rays_make_larger_errors_on_a_curved_mirror():
    case, hits, truth = given("sphere", 128)
    runs = [traced(case.view, case.mirror, case.scene, block, hits) for block in (8, 4, 2, 1)]
    errors = [compare_picture(case.view, truth, run.triangle, run.position).numbers["p99"] for run in runs]
    assert errors[0] > errors[1] > errors[2] > errors[3] and errors[3] < 1e-9


def test_clusters_take_one_traversal_for_each_mirror_triangle_that_is_seen():
    case, hits, _ = given("sphere")
    whole = clustered(case.view, case.mirror, case.scene, 0, hits).counts
    assert whole["traversals"] == len(np.unique(hits.face))
    width = case.view.resolution[0]
    tiles = np.stack((hits.face, hits.pixel % width // 8, hits.pixel // width // 8), axis=1)
    tiled = clustered(case.view, case.mirror, case.scene, 8, hits).counts
    assert tiled["traversals"] == len(np.unique(tiles, axis=0))
    assert tiled["intersections"] < whole["intersections"] and tiled["rays"] == whole["rays"] == len(hits.pixel)


def test_counts_are_those_of_brute_force_where_every_ray_must_be_tested_with_every_triangle():
    # two parallel quads, smaller than a leaf, that every reflected ray passes: nothing can be culled
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    walls = [shapes.quad((0.0, y, 0.0), (9.0, 0.0, 0.0), (0.0, 0.0, 9.0)) for y in (-8.0, -8.5)]
    view = View.looking_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (30, 20), field_of_view=0.3)
    case = replace(case_of("flat", PIXELS), view=view, mirror=mirror, scene=shapes.combine(*walls))
    hits = primary_hits(case.view, case.mirror, case.scene)
    assert len(hits.pixel) == 600 and not hits.meets_mirror.any()
    assert hits.counts["projections"] == 4 + 8 and hits.counts["rays"] == 0
    rays = traced(case.view, case.mirror, case.scene, 1, hits).counts
    clusters = clustered(case.view, case.mirror, case.scene, 0, hits).counts
    assert rays["rays"] == rays["traversals"] == clusters["rays"] == 600 and clusters["traversals"] == 2
    assert clusters["intersections"] == 600 * 4
    # one leaf, or two of which the nearer one hides the other
    assert rays["intersections"] in (600 * 4, 600 * 2)


def test_cones_hold_the_rays_that_they_are_round():
    case, hits, _ = given("bowl")
    order, start, _ = by_face(hits.face)
    place, ray = hits.place[:, order], hits.ray[:, order]
    cones = cones_around(place, ray, start)
    cone = np.repeat(np.arange(len(start)), np.diff(np.append(start, len(order))))
    for s in (0.0, 0.1, 3.0, 1e4):
        assert cones.touch(cone, place + s * ray, np.full(len(cone), 1e-12 * (1.0 + s))).all()
