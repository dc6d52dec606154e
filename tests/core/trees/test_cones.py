"""Bounding cones against samples of the rays that they are to hold."""
import numpy as np
import pytest

from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.trees.cones import Cones
from tests.inputs.random_cameras import cameras_of, moved, random_cameras, random_families
from tests.oracles.true_map import case_of


def samples(cameras, rng, count):
    """Points Q(W) + s R(W) of every camera, some of them on its corners and edges, some on the mirror and very far."""
    weights = rng.dirichlet((0.5, 0.5, 0.5), (len(cameras), count))
    weights[:, :3] = np.eye(3)
    weights[:, 3, 0] = 0.0
    weights /= weights.sum(axis=2, keepdims=True)
    s = 10.0 ** rng.uniform(-3.0, 4.0, (len(cameras), count))
    s[:, ::5] = 0.0
    places, rays = (np.einsum("nwk,xnk->xnw", weights, given[:, cameras.corners])
                    for given in (cameras.places, cameras.rays))
    cone = np.repeat(np.arange(len(cameras)), count)
    return cone, (places + s * rays).reshape(3, -1)


@pytest.mark.thorough
@pytest.mark.parametrize("offset", [0.0, 1e4])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
@pytest.mark.parametrize("turn", [0.0, 1e-9, 0.05, 0.4, 2.0])
def test_cones_hold_all_rays_of_their_cameras(turn, scale, offset):
    rng = np.random.default_rng(41)
    cameras = moved(random_cameras(rng, 200, turn=turn), scale, offset)
    cone, points = samples(cameras, rng, 40)
    # A point far from the origin is itself rounded, by as much as the sphere round it.
    rounding = 1e-15 * np.linalg.norm(points, axis=0) + 1e-14 * offset
    assert Cones.around(cameras).touch(cone, points, rounding).all()


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat", "water", "bowl", "cylinder", "flat_ortho"])
def test_cones_hold_the_true_rays_of_a_mirrors_corners(name):
    case = case_of(name)
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    cone, points = samples(cameras, np.random.default_rng(43), 20)
    assert Cones.around(cameras).touch(cone, points, np.full(len(cone), 1e-12)).all()


def test_spheres_that_reach_a_ray_touch_and_those_behind_or_beside_do_not():
    rng = np.random.default_rng(47)
    cameras = random_cameras(rng, 300, size=0.1, turn=0.05)
    cones = Cones.around(cameras)
    cone, points = samples(cameras, rng, 10)
    shift = rng.normal(size=points.shape)
    shift *= 0.5 / np.linalg.norm(shift, axis=0)
    assert cones.touch(cone, points + shift, np.full(len(cone), 0.5 + 1e-9)).all()
    every = np.arange(300)
    behind = cones.centre - 3.0 * cones.axis
    assert not cones.touch(every, behind, np.full(300, 1.0)).any()
    across = np.cross(cones.axis, rng.normal(size=(3, 300)), axis=0)
    across /= np.linalg.norm(across, axis=0)
    # Ten units along, a cone of 0.3 radians and less is at most some 4 wide.
    beside = cones.centre + 10.0 * cones.axis + 8.0 * across
    assert not cones.touch(every, beside, np.full(300, 1.0)).any()


def test_a_cone_is_tight_round_equal_rays():
    rng = np.random.default_rng(53)
    cameras = random_cameras(rng, 100, turn=0.0)
    cones = Cones.around(cameras)
    np.testing.assert_allclose(cones.cosine, 1.0, rtol=0, atol=1e-12)
    every = np.arange(100)
    along = cones.centre + 1e3 * cones.axis
    across = np.cross(cones.axis, rng.normal(size=(3, 100)), axis=0)
    across /= np.linalg.norm(across, axis=0)
    assert cones.touch(every, along + 0.99 * cones.radius * across, np.zeros(100)).all()
    assert not cones.touch(every, along + 1.01 * cones.radius * across, np.zeros(100)).any()


def test_a_camera_whose_rays_go_all_ways_holds_everything():
    places = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
    spread = np.array([[1.0, -0.5, -0.5], [0.0, 0.8, -0.8], [0.0, 0.0, 0.0]])
    cones = Cones.around(cameras_of(places.T[None], spread.T[None]))
    points = np.random.default_rng(59).normal(size=(3, 500)) * 10.0
    assert cones.touch(np.zeros(500, dtype=np.int64), points, np.zeros(500)).all()


@pytest.mark.parametrize("turn", [0.0, 0.05, 0.4, 2.0])
def test_a_cone_round_several_holds_the_rays_of_all(turn):
    rng = np.random.default_rng(59)
    cameras, start = random_families(rng, 200, turn)
    cone, points = samples(cameras, rng, 40)
    together = Cones.around(cameras).together(start)
    family = np.searchsorted(start, cone, side="right") - 1
    assert len(together.radius) == len(start) < 100
    assert together.touch(family, points, 1e-14 * np.linalg.norm(points, axis=0)).all()


def test_a_cone_round_several_is_no_wider_than_they_need():
    rng = np.random.default_rng(61)
    cameras = random_cameras(rng, 1, size=0.1, turn=0.01)
    alone = Cones.around(cameras)
    several = Cones.around(cameras.select(np.zeros(5, dtype=np.int64))).together(np.array([0]))
    np.testing.assert_allclose(several.centre, alone.centre, atol=1e-12)
    np.testing.assert_allclose(several.axis, alone.axis, atol=1e-12)
    np.testing.assert_allclose((several.radius, several.sine), (alone.radius, alone.sine), rtol=1e-9)
