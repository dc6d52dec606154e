"""Shafts against samples of the rays that they are to hold, and against the cones that they are to be closer than."""
import numpy as np
import pytest

from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.geometry import rows
from core.trees.shafts import Shafts
from tests.core.trees.test_cones import samples
from tests.inputs.random_cameras import cameras_of, moved, random_cameras, random_families
from tests.oracles.true_map import case_of


def thrown(points, rng, size):
    """Corners of a triangle of about that `size` through each of the points (3, n), at random places of it."""
    corners = rng.normal(scale=size, size=(3, *points.shape))
    weights = rng.dirichlet((1.0, 1.0, 1.0), points.shape[1]).T
    return list(corners + points - (weights[:, None] * corners).sum(axis=0))


def held(shafts, shaft, corners):
    count = len(shaft)
    return shafts.hold(shaft, np.concatenate(corners, axis=1).T, np.arange(3 * count).reshape(3, count).T)


@pytest.mark.thorough
@pytest.mark.parametrize("offset", [0.0, 1e4])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [0.0, 1e-9, 0.05, 0.4, 2.0])
def test_shafts_hold_all_triangles_that_rays_of_their_cameras_meet(turn, scale, offset):
    rng = np.random.default_rng(41)
    cameras = moved(random_cameras(rng, 200, turn=turn), scale, offset)
    shaft, points = samples(cameras, rng, 40)
    for size in (0.0, 0.1 * scale, 10.0 * scale):
        corners = thrown(points, rng, size)
        # a point far from the origin is itself rounded
        assert held(Shafts.around(cameras, 5.0 * scale + offset), shaft, corners).all()


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat", "water", "bowl", "cylinder", "flat_ortho"])
def test_shafts_hold_the_true_rays_of_a_mirrors_corners(name):
    case = case_of(name)
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    shaft, points = samples(cameras, np.random.default_rng(43), 20)
    assert held(Shafts.around(cameras, 10.0), shaft, [points] * 3).all()


@pytest.mark.parametrize("turn", [0.0, 0.05, 0.4, 2.0])
def test_a_shaft_round_several_holds_the_rays_of_all(turn):
    rng = np.random.default_rng(59)
    cameras, start = random_families(rng, 200, turn)
    shaft, points = samples(cameras, rng, 40)
    together = Shafts.around(cameras, 5.0).together(start)
    assert len(together) == len(start) < 100
    assert held(together, np.searchsorted(start, shaft, side="right") - 1, [points] * 3).all()


def test_a_shaft_of_rays_in_one_plane_is_thin():
    """A sliver whose rays part along it: what lies a little beside the plane of its rays is not in it, though the
    cone round it holds that."""
    places = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1e-3, 0.0]])
    rays = np.array([[-0.4, 0.0, 1.0], [0.4, 0.0, 1.0], [0.0, 0.0, 1.0]])
    shafts = Shafts.around(cameras_of(places[None], rays[None]), 5.0)
    count = 400
    rng = np.random.default_rng(71)
    spots = np.stack((rng.uniform(-0.9, 0.9, count), np.full(count, 0.05), rng.uniform(0.0, 5.0, count)))
    corners = [spots + np.array([[x], [y], [0.0]]) * 0.04 for x, y in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))]
    shaft = np.zeros(count, dtype=np.int64)
    assert shafts.touch(shaft, spots, np.full(count, 0.05)).all()
    assert not held(shafts, shaft, corners).any()
    through = [corner - np.array([[0.0], [0.06], [0.0]]) for corner in corners]
    assert held(shafts, shaft, through).all()


def test_a_shaft_of_equal_rays_is_a_box_round_them():
    rng = np.random.default_rng(53)
    cameras = random_cameras(rng, 100, turn=0.0)
    shafts, cones = Shafts.around(cameras, 5.0), Shafts.around(cameras, 5.0).cones
    every = np.arange(100)
    along = cones.centre + 1e2 * cones.axis
    across = np.cross(cones.axis, rng.normal(size=(3, 100)), axis=0)
    across /= np.linalg.norm(across, axis=0)
    beside = along + 2.0 * np.sqrt(2.0) * cones.radius * across
    assert not held(shafts, every, [beside] * 3).any()
    assert held(shafts, every, [along] * 3).all()


def test_a_camera_whose_rays_go_all_ways_holds_everything():
    places = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    spread = np.array([[1.0, -0.5, -0.5], [0.0, 0.8, -0.8], [0.0, 0.0, 0.0]])
    shafts = Shafts.around(cameras_of(places.T[None], spread.T[None]), 5.0)
    points = rows(np.random.default_rng(59).normal(size=(500, 3)) * 10.0)
    assert held(shafts, np.zeros(500, dtype=np.int64), [points] * 3).all()
