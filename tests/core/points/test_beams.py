"""Bounds that cull without a solve: beams that hold points, and how large a camera can show a small thing."""
import numpy as np
import pytest

from core import View, project
from core.points.beams import Beams
from core.trees.cones import Cones
from core.trees.magnification import Magnification
from tests.inputs.random_cameras import cameras_of

VIEW = View.looking_at((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1000, 1000))


def random_cameras(count, spread, seed=3):
    """Cameras before an eye at the origin that looks along +Y; rays spread by `spread` round a way back."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform((-1.0, 3.0, -1.0), (1.0, 5.0, 1.0), (count, 1, 3))
    places = middle + rng.normal(scale=0.03, size=(count, 3, 3))
    back = rng.normal(scale=0.4, size=(count, 1, 3)) + (0.0, -1.0, 0.0)
    rays = (back + rng.normal(scale=spread, size=(count, 3, 3))) * np.linalg.norm(places, axis=2, keepdims=True)
    return cameras_of(places, rays, VIEW), places, rays


@pytest.mark.parametrize("spread", [0.0, 0.01, 0.1, 1.0])
def test_beams_hold_every_point_on_a_ray_of_their_camera(spread):
    cameras, places, rays = random_cameras(4000, spread)
    beams, rng = Beams.of(cameras, Cones.around(cameras)), np.random.default_rng(4)
    weights = rng.dirichlet((0.3, 0.3, 0.3), 4000)
    distance = rng.exponential(1.0, 4000)
    point = np.einsum("nk,nkx->nx", weights, places + distance[:, None, None] * rays)
    assert beams.hold(np.arange(4000), point.T).all()


def test_beams_hold_little_else():
    cameras, places, rays = random_cameras(4000, 0.02)
    cones, rng = Cones.around(cameras), np.random.default_rng(5)
    weights = rng.dirichlet((1.0, 1.0, 1.0), 4000)
    point = np.einsum("nk,nkx->nx", weights, places + rays)
    point += rng.normal(scale=0.08, size=point.shape)
    seen = np.zeros(4000, dtype=bool)
    seen[project(places, rays, point).pair] = True
    held = Beams.of(cameras, cones).hold(np.arange(4000), point.T)
    touched = cones.touch(np.arange(4000), point.T, np.zeros(4000))
    assert (held | ~seen).all() and seen.sum() > 200
    assert (held & ~seen).sum() < 0.3 * (touched & ~seen).sum()


@pytest.mark.parametrize("spread", [0.005, 0.05])
def test_no_image_of_a_small_thing_is_larger_than_the_bound(spread):
    count, samples = 300, 40
    cameras, places, rays = random_cameras(count, spread)
    rng = np.random.default_rng(6)
    centre = np.einsum("nk,nkx->nx", rng.dirichlet((2.0, 2.0, 2.0), count),
                       places + rng.uniform(0.2, 2.0, (count, 1, 1)) * rays)
    radius = rng.uniform(1e-4, 3e-3, count)
    bound = Magnification.of(cameras).pixels(Cones.around(cameras), np.arange(count),
                                             np.concatenate((centre.T, radius[None])))
    ways = rng.normal(size=(count, samples, 3))
    point = centre[:, None] + radius[:, None, None] * ways / np.linalg.norm(ways, axis=2, keepdims=True)
    found = project(np.repeat(places, samples, axis=0), np.repeat(rays, samples, axis=0), point.reshape(-1, 3))
    camera = found.pair // samples
    pixel = VIEW.pixels(np.einsum("nk,nkx->nx", found.weights, places[camera]))
    sure = 0
    for index in np.flatnonzero(np.isfinite(bound)):
        images = pixel[camera == index]
        if len(images) > 1:
            sure += 1
            away = np.linalg.norm(images[:, None] - images, axis=2).max()
            assert away <= 1.05 * bound[index]
    assert sure > 50
