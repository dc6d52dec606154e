"""Reflection morphing: the search against brute force, and its convergence with the number of rays."""
import numpy as np
import pytest

from core.rivals import primary_hits
from core.rivals.morphing import morphed
from core.rivals.tracing import RayPyramid
from tests.oracles.judge import compare_picture
from tests.oracles.true_map import case_of, truth_of

pytestmark = pytest.mark.thorough

PIXELS = 128


def angles(places, rays, points):
    """(rays, points), of the way to each point off each ray."""
    way = points[:, None, :] - places[:, :, None]
    across = np.cross(way, rays[:, :, None], axis=0)
    return np.arctan2(np.linalg.norm(across, axis=0), (way * rays[:, :, None]).sum(axis=0))


@pytest.mark.parametrize("name", ["sphere", "bowl", "flat", "torus"])
def test_the_nearest_ray_is_that_of_brute_force(name):
    case = case_of(name, 64)
    hits = primary_hits(case.view, case.mirror, case.scene)
    rng = np.random.default_rng(4)
    low, high = case.scene.positions.min(axis=0), case.scene.positions.max(axis=0)
    points = rng.uniform(low, high, (300, 3)).T
    grid = np.full(64 * 64, -1)
    grid[hits.pixel] = np.arange(len(hits.pixel))
    pyramid = RayPyramid.build(grid.reshape(64, 64)[::2, ::2], hits.place, hits.ray)
    found, visited = pyramid.nearest(points)
    used = np.unique(grid.reshape(64, 64)[::2, ::2])[1:]
    true = angles(hits.place[:, used], hits.ray[:, used], points)
    own = angles(hits.place[:, found], hits.ray[:, found], points)[np.arange(300), np.arange(300)]
    np.testing.assert_allclose(own, true.min(axis=0), rtol=1e-6, atol=1e-9)
    assert np.isin(found, used).all()
    assert visited < 0.5 * true.size


def numbers(name, rays, **options):
    case = case_of(name, PIXELS)
    hits, truth = primary_hits(case.view, case.mirror, case.scene), truth_of(name, PIXELS)
    runs = [morphed(case.view, case.mirror, case.scene, count, hits, **options) for count in rays]
    return [compare_picture(case.view, truth, run.triangle, run.position).numbers | run.counts for run in runs]


def test_it_converges_with_the_number_of_rays_on_a_ball():
    coarse, middle, fine = numbers("sphere", (60, 240, 960))
    # with the square of the rays' distance
    assert coarse["median"] > 2.0 * middle["median"] > 4.0 * fine["median"]
    assert fine["median"] < 0.2 and fine["uncovered"] < 1.5


def test_it_is_exact_inside_a_flat_mirror():
    # neighbouring rays of a flat mirror tell all the others
    (fine,) = numbers("flat", (1500,))
    assert fine["median"] < 1e-3 and fine["p95"] < 0.01 and fine["uncovered"] < 0.1


def test_every_vertex_is_searched_once_where_nothing_is_split():
    case = case_of("sphere", PIXELS)
    (plain,) = numbers("sphere", (960,), rounds=0)
    assert plain["traversals"] == plain["projections"] == len(case.scene.positions)
    (split,) = numbers("sphere", (960,))
    assert split["p99"] < 0.6 * plain["p99"] and split["traversals"] > plain["traversals"]


def test_a_concave_mirror_shows_what_it_shows_twice_only_once():
    # more rays do not help: what is missing are images
    found = numbers("bowl", (1000, 4000))
    assert all(run["uncovered"] > 0.3 for run in found)
