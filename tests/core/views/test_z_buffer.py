"""The z-buffer against the one that judges, which draws in another way."""
import numpy as np
import pytest

from core import TriangleMesh, View
from core.rivals.scenes import quartered, tessellated
from core.views import draw
from tests.inputs import shapes
from tests.oracles.raster import rasterise
from tests.oracles.true_map import case_of, mesh_of


def same_picture(view, positions, triangles):
    expected, drawn = rasterise(view, positions, triangles), draw(view, positions, triangles)
    shown = expected.triangle >= 0
    assert np.array_equal(drawn.triangle, expected.triangle)
    np.testing.assert_allclose(drawn.depth[shown], expected.depth[shown], rtol=1e-9)
    np.testing.assert_allclose(drawn.weights.T[shown], expected.weights[shown], rtol=0, atol=1e-6)
    pixel = np.flatnonzero(shown)
    np.testing.assert_allclose(drawn.interpolate(positions, triangles, pixel).T,
                               expected.interpolate(positions, triangles)[pixel], rtol=0,
                               atol=1e-8 * np.abs(positions).max())
    return shown.mean()


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat_ortho", "bowl", "sphere_shift", "sphere_small"])
def test_meshes_and_scenes_are_drawn_as_the_judge_draws_them(name):
    case, mesh = case_of(name), mesh_of(name)
    assert same_picture(case.view, mesh.positions, mesh.triangles) > 0.1
    assert same_picture(case.view, case.scene.positions, case.scene.triangles) > 0.01


@pytest.mark.parametrize("orthographic", [0.0, 3.0])
def test_triangles_that_pass_the_eye_are_drawn_as_the_judge_draws_them(orthographic):
    rng = np.random.default_rng(8)
    view = View.looking_at((0.1, 0.2, 0.3), (1.0, 3.0, 0.5), (90, 60), field_of_view=1.6,
                           orthographic_scale=orthographic)
    corners = rng.uniform(-4.0, 4.0, (60, 1, 3)) + rng.normal(scale=2.0, size=(60, 3, 3))
    assert same_picture(view, corners.reshape(-1, 3), np.arange(180).reshape(-1, 3)) > 0.5


def test_nothing_shows_through_between_triangles_that_share_an_edge():
    # spokes from the middle of a pixel: every edge passes through a pixel's centre
    angle = 2.0 * np.pi * np.arange(24) / 24
    ring = np.stack((np.cos(angle), np.zeros(24), np.sin(angle)), axis=1) * 9.0
    fan = np.stack((np.zeros(24, dtype=int), 1 + np.arange(24), 1 + (np.arange(24) + 1) % 24), axis=1)
    view = View.looking_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (65, 65), field_of_view=0.9)
    drawn = draw(view, np.concatenate((np.zeros((1, 3)), ring)), fan)
    assert (drawn.triangle >= 0).all() and len(np.unique(drawn.triangle)) == 24


def test_nothing_is_drawn_of_nothing_or_of_what_lies_behind_the_eye():
    view = View.looking_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (8, 8))
    behind = shapes.combine(shapes.quad((0.0, -9.0, 0.0), (3.0, 0.0, 0.0), (0.0, 0.0, 3.0)))
    line = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.5]])
    for positions, triangles in ((behind.positions, behind.triangles), (line, np.array([[0, 1, 2]])),
                                 (line, np.zeros((0, 3), dtype=int))):
        drawn = draw(view, positions, triangles)
        assert (drawn.triangle == -1).all() and np.isinf(drawn.depth).all()


def test_a_triangle_seen_edge_on_covers_no_more_than_its_own_place():
    # its corners lie on one ray of the eye, to rounding: its edges run anywhere
    view = View.looking_at((1.5, -7.0, 2.6), (0.0, 2.0, 1.5), (64, 64), field_of_view=0.62)
    origin, direction = view.rays(np.random.default_rng(1).integers(0, 64, (300, 2)) + 0.5)
    corners = origin[:, None] + direction[:, None] * np.array([9.3, 9.4, 9.7])[:, None]
    drawn = draw(view, corners.reshape(-1, 3), np.arange(900).reshape(-1, 3))
    pixel = np.flatnonzero(drawn.triangle >= 0)
    own = view.pixels(corners[drawn.triangle[pixel], 0])
    assert np.abs(own - np.stack((pixel % 64, pixel // 64), axis=1) - 0.5).max(initial=0.0) < 1e-6


def area(mesh):
    a, b, c = (mesh.positions[mesh.triangles[:, k]] for k in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


def test_quartered_mirrors_are_the_same_surface_with_normals_between():
    mirror = case_of("sphere").mirror
    finer = quartered(mirror, 2)
    assert len(finer.triangles) == 16 * len(mirror.triangles) and quartered(mirror, 0) is mirror
    assert area(finer).sum() == pytest.approx(area(mirror).sum(), rel=1e-12)
    # a closed surface stays closed: vertices - edges + faces
    edges = np.unique(np.sort(finer.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
    assert len(np.unique(finer.triangles)) - len(edges) + len(finer.triangles) == 2
    outwards = finer.positions[finer.triangles] - (0.0, 0.0, 1.3)
    outwards /= np.linalg.norm(outwards, axis=2, keepdims=True)
    assert (finer.corner_normals * outwards).sum(axis=2).min() > np.cos(0.01)


def test_tessellated_scenes_keep_their_area_and_know_their_triangles():
    scene = case_of("sphere").scene
    finer, source = tessellated(scene, 5000)
    assert 2500 < len(np.unique(finer.triangles)) < 12000
    np.testing.assert_allclose(np.bincount(source, area(finer), len(scene.triangles)), area(scene), rtol=1e-9)
    same, source = tessellated(TriangleMesh(scene.positions, scene.triangles), 1)
    assert np.array_equal(same.triangles, scene.triangles) and np.array_equal(source, np.arange(len(scene.triangles)))
