"""The true reflection map against the ray tracer's own, and its derivatives against finite differences."""
import numpy as np
import pytest

from core import TriangleMesh, View
from core.cameras.mirror_map import MirrorMap
from tests.oracles.true_map import case_of, size_of, true_rays, view_rays
from tests.oracles.truth import reflected_rays

NAMES = ("sphere", "sphere_ortho", "sphere_far", "sphere_small", "flat", "water", "bowl", "torus")


def places_on(case, count=400, seed=61, margin=0.0):
    rng = np.random.default_rng(seed)
    corners = case.mirror.positions[case.mirror.triangles]
    normal = case.mirror.face_normals()
    towards = -(normal * case.view.directions(corners[:, 0])).sum(axis=1)
    facing = np.flatnonzero(towards > 0.3 * np.linalg.norm(case.view.directions(corners[:, 0]), axis=1))
    uv = rng.dirichlet((1.0, 1.0, 1.0), count).T[:2] * (1.0 - 3.0 * margin) + margin
    return rng.choice(facing, count), uv


@pytest.mark.parametrize("name", NAMES)
def test_rays_are_those_that_a_ray_tracer_follows(name):
    case = case_of(name)
    face, uv = places_on(case)
    mirror_map = MirrorMap(case.view, case.mirror)
    place, ray = mirror_map.places(face, uv).T, mirror_map.rays(face, uv).T
    expected_place, expected, weights = reflected_rays(case.mirror, face, *view_rays(case.view, place))
    far = 1e4 if name == "sphere_far" else 1.0
    np.testing.assert_allclose(place, expected_place, rtol=0, atol=1e-13 * size_of(case) * far)
    np.testing.assert_allclose(weights[:, 1:], uv.T, rtol=0, atol=1e-11 * far)
    length = np.linalg.norm(ray, axis=1)
    np.testing.assert_allclose(ray / length[:, None], expected, rtol=0, atol=1e-12 * far)
    np.testing.assert_allclose(length, np.linalg.norm(case.view.directions(place), axis=1), rtol=1e-12)
    np.testing.assert_allclose(mirror_map.coordinates(face, place.T), uv, rtol=0, atol=1e-11 * far)


@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "torus", "cylinder"])
def test_rays_that_would_enter_the_mirror_are_turned_until_they_clear_it(name):
    case = case_of(name)
    rng = np.random.default_rng(63)
    corners = case.mirror.positions[case.mirror.triangles]
    directions = case.view.directions(corners[:, 0])
    slope = -(case.mirror.face_normals() * directions).sum(axis=1) / np.linalg.norm(directions, axis=1)
    face = rng.choice(np.flatnonzero((slope > 0.005) & (slope < 0.25)), 4000)
    uv = rng.dirichlet((0.5, 0.5, 0.5), 4000).T[:2]
    mirror_map = MirrorMap(case.view, case.mirror)
    place, ray = mirror_map.places(face, uv).T, mirror_map.rays(face, uv).T
    _, expected, _, bent = true_rays(case.mirror, face, *view_rays(case.view, place))
    assert 50 < bent.sum() < 3950
    ray = ray / np.linalg.norm(ray, axis=1, keepdims=True)
    np.testing.assert_allclose(ray, expected, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(mirror_map.lifted(face, uv), bent)
    assert (ray * case.mirror.face_normals()[face]).sum(axis=1).min() > 0.004


def test_rays_are_turned_where_they_would_enter_between_the_places_that_are_asked_first():
    """From near a strongly smoothed triangle: rays in its corners and its middle leave it, some along a side do not."""
    corners = np.array([(0.85065081, 0.0, -0.52573111), (0.80901699, 0.5, -0.30901699), (1.0, 0.0, 0.0)])
    mirror = TriangleMesh(corners, np.array([[0, 1, 2]]), corners[None])
    view = View.looking_at((0.77922591, 0.46376158, -0.32631638), corners.mean(axis=0), (64, 64))
    mirror_map = MirrorMap(view, mirror)
    uv = np.random.default_rng(64).dirichlet((0.5, 0.5, 0.5), 4000).T[:2]
    face = np.zeros(4000, dtype=np.int64)
    place, ray = mirror_map.places(face, uv).T, mirror_map.rays(face, uv).T
    _, expected, _, bent = true_rays(mirror, face, *view_rays(view, place))
    assert 50 < bent.sum() < 3950
    np.testing.assert_array_equal(mirror_map.lifted(face, uv), bent)
    ray = ray / np.linalg.norm(ray, axis=1, keepdims=True)
    np.testing.assert_allclose(ray, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_derivatives_are_those_of_finite_differences(name):
    case = case_of(name)
    face, uv = places_on(case)
    mirror_map = MirrorMap(case.view, case.mirror)
    way = np.random.default_rng(67).normal(size=(2, len(face)))
    place, ray, ((move, change),) = mirror_map.linearise(face, uv, way)
    step = 1e-4
    before, after = uv - step * way, uv + step * way
    far = 1e3 if name == "sphere_far" else 1.0
    for given, function in ((move, mirror_map.places), (change, mirror_map.rays)):
        expected = (function(face, after) - function(face, before)) / (2.0 * step)
        np.testing.assert_allclose(given, expected, rtol=0, atol=1e-6 * far * np.abs(expected).max())
    np.testing.assert_array_equal(place, mirror_map.places(face, uv))
    np.testing.assert_allclose(ray, mirror_map.rays(face, uv), rtol=0, atol=1e-12 * np.abs(ray).max())


@pytest.mark.parametrize("name", NAMES)
def test_newton_finds_the_place_where_a_point_is_seen(name):
    case = case_of(name)
    face, uv = places_on(case)
    mirror_map = MirrorMap(case.view, case.mirror)
    rng = np.random.default_rng(71)
    s = rng.uniform(0.1, 0.4, len(face)) * size_of(case) / np.linalg.norm(mirror_map.rays(face, uv), axis=0)
    # Near a caustic two images lie together, and Newton's method may go to the other.
    clear = np.abs(mirror_map.turned(face, uv, s)) > 0.3
    assert clear.sum() > 100
    face, uv, s = face[clear], uv[:, clear], s[clear]
    points = mirror_map.places(face, uv) + s * mirror_map.rays(face, uv)
    start = uv + rng.uniform(-0.1, 0.1, uv.shape)
    found, distance = mirror_map.locate(face, start, 1.05 * s, points, steps=8)
    reached = mirror_map.places(face, found) + distance * mirror_map.rays(face, found)
    rounding = 1e-11 if name == "sphere_far" else 1e-13
    assert np.abs(reached - points).max() < rounding * np.abs(points).max() + 1e-12 * size_of(case)
    np.testing.assert_allclose(found, uv, rtol=0, atol=1e-6)
    # Steps square the error: three of them from a tenth of a triangle away leave next to none.
    near, _ = mirror_map.locate(face, start, 1.05 * s, points)
    assert np.percentile(np.abs(near - uv), 99) < 1e-4


@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "water", "flat"])
def test_newton_finds_the_crossing_of_a_scene_edge_and_a_mirror_line(name):
    case = case_of(name)
    face, uv = places_on(case, margin=0.1)
    mirror_map = MirrorMap(case.view, case.mirror)
    rng = np.random.default_rng(73)
    way = rng.uniform(-0.1, 0.1, uv.shape)
    start, end = uv - way, uv + 2.0 * way
    s = rng.uniform(0.2, 0.5, len(face)) * size_of(case) / np.linalg.norm(mirror_map.rays(face, uv), axis=0)
    met = mirror_map.places(face, uv) + s * mirror_map.rays(face, uv)
    edge = rng.normal(size=met.shape) * 0.3 * size_of(case)
    along = rng.uniform(0.0, 1.0, len(face))
    guess = np.full(len(face), 0.4)
    t, found_along, found_s = mirror_map.meet(face, (start, end), (met - along * edge, edge), (guess, 1.02 * s), 12)
    q = start + t * (end - start)
    reached = mirror_map.places(face, q) + found_s * mirror_map.rays(face, q)
    given = met - along * edge + found_along * edge
    # A line may pass over another in two places, or nearly touch it: those few may go to the other.
    good = np.linalg.norm(reached - given, axis=0) < 1e-11 * size_of(case)
    assert good.mean() > 0.97
    assert (np.abs(t - 1.0 / 3.0)[good] < 1e-6).mean() > 0.95


@pytest.mark.parametrize("name", ["sphere", "bowl", "flat", "water"])
def test_magnification_is_one_on_the_mirror_and_is_the_area_of_a_ray_bundle(name):
    case = case_of(name)
    face, uv = places_on(case)
    mirror_map = MirrorMap(case.view, case.mirror)
    np.testing.assert_allclose(mirror_map.turned(face, uv, np.zeros(len(face))), 1.0, rtol=0, atol=1e-12)
    s = np.random.default_rng(79).uniform(0.0, 2.0, len(face))
    step, ray = 1e-4, mirror_map.rays(face, uv)
    areas = []
    for distance in (s, np.zeros_like(s)):
        ends = [mirror_map.places(face, q) + distance * mirror_map.rays(face, q)
                for q in (uv, uv + [[step], [0.0]], uv + [[0.0], [step]])]
        areas.append((np.cross(ends[1] - ends[0], ends[2] - ends[0], axis=0) * ray).sum(axis=0))
    given = mirror_map.turned(face, uv, s)
    np.testing.assert_allclose(given, areas[0] / areas[1], rtol=1e-2, atol=1e-2)
    if name == "flat":
        np.testing.assert_allclose(given, (1.0 + s) ** 2, rtol=1e-12)
    if name == "sphere":
        assert (given > 0.0).all()
    if name == "bowl":
        assert (given < 0.0).sum() > 10


@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "water"])
def test_the_parallel_map_sends_all_rays_of_a_triangle_the_way_of_its_middle(name):
    case = case_of(name)
    face, uv = places_on(case)
    mirror_map = MirrorMap(case.view, case.mirror, parallel=True)
    middle = case.mirror.positions[case.mirror.triangles[face]].mean(axis=1)
    _, expected, _ = reflected_rays(case.mirror, face, *view_rays(case.view, middle))
    np.testing.assert_allclose(mirror_map.rays(face, uv).T, expected, rtol=0, atol=1e-12)
    _, _, ((_, change),) = mirror_map.linearise(face, uv, np.ones((2, len(face))))
    np.testing.assert_array_equal(change, 0.0)


def test_opposite_normals_fall_back_on_the_flat_one():
    case = case_of("flat")
    normals = case.mirror.corner_normals.copy()
    normals[0, 1] *= -1.0
    mirror_map = MirrorMap(case.view, type(case.mirror)(case.mirror.positions, case.mirror.triangles, normals))
    ray = mirror_map.rays(np.array([0]), np.array([[0.5], [0.0]]))
    assert np.isfinite(ray).all()
    straight = MirrorMap(case.view, case.mirror).rays(np.array([0]), np.array([[0.5], [0.0]]))
    np.testing.assert_allclose(ray, straight, rtol=0, atol=1e-12)
