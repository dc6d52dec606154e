"""Cameras that share vertices and rays leave no gap between them: points on the surface of rays between two of them, or
on the ray that several share."""
import numpy as np
import pytest

from core import project
from tests.inputs.family_tools import mirrored, seen, turned, turns, unit
from tests.oracles.exact_pairs import ExactPairs
from tests.oracles.explained import Looked, judge

pytestmark = pytest.mark.slow

COUNT = 1000
"""Points of each test, 24,000 in all."""


def fans(rng, n, cameras, offset=0.0, scale=1.0):
    """Closed fans of cameras round a middle vertex of convex mirrors: corners (n, cameras + 1, 3) and rays, the middle
    first. Convex mirrors show every point once."""
    angle = (np.arange(cameras) + rng.uniform(-0.15, 0.15, (n, cameras))) * 2.0 * np.pi / cameras
    radius = rng.uniform(0.3, 1.0, (n, cameras))
    outer = np.stack((radius * np.cos(angle), radius * np.sin(angle)), axis=2)
    flat = np.concatenate((rng.uniform(-0.05, 0.05, (n, 1, 2)), outer), axis=1) * 10.0 ** -rng.uniform(0, 3, (n, 1, 1))
    places = np.concatenate((flat, 1.0 - (flat ** 2).sum(axis=2, keepdims=True) / 2.0), axis=2)
    normals = unit(np.concatenate((flat, np.ones_like(flat[..., :1])), axis=2))
    eye = rng.normal(size=(n, 1, 3)) + [0.0, 0.0, 6.0]
    places, normals, eye = turned(turns(rng, n), places, normals, eye)
    places, eye = places * scale + offset, eye * scale + offset
    return places, mirrored(places, normals, eye)


def triangles(cameras):
    """Corners of each camera of a fan, begun at any of them and wound either way."""
    order = np.array([[0, k + 1, (k + 1) % cameras + 1] for k in range(cameras)])
    order[1::3] = np.roll(order[1::3], 1, axis=1)
    order[2::3] = order[2::3, ::-1]
    return order


def moved_a_little(rng, points, scale):
    """A quarter moved by a few units of rounding, a quarter by 10^-14 to 10^-8 of the scale."""
    quarter = len(points) // 4
    some, others = points[:quarter], points[quarter:2 * quarter]
    some += rng.integers(-3, 4, some.shape) * np.spacing(np.abs(some).max(axis=1, keepdims=True))
    others += scale * 10.0 ** -rng.uniform(8, 14, (quarter, 1)) * rng.normal(size=others.shape)


@pytest.mark.parametrize("offset, scale", [(0.0, 1.0), (1e6, 1.0), (1e6, 1e-3), (0.0, 1e-130)])
@pytest.mark.parametrize("cameras", [3, 4, 6])
@pytest.mark.parametrize("on_vertex", [False, True])
def test_no_gap_between_neighbours(cameras, on_vertex, offset, scale):
    rng = np.random.default_rng([cameras, on_vertex, int(offset)])
    places, rays = fans(rng, COUNT, cameras, offset, scale)
    part = np.zeros((COUNT, 1)) if on_vertex else rng.uniform(0.0, 0.9, (COUNT, 1))
    distance = 10.0 ** rng.uniform(-2, 2, COUNT)
    ends = [0, 1 + rng.integers(cameras)]
    points = seen(places[:, ends], rays[:, ends], np.concatenate((1.0 - part, part), axis=1), distance)
    moved_a_little(rng, points, scale)
    corners = triangles(cameras)
    pairs = places[:, corners].reshape(-1, 3, 3), rays[:, corners].reshape(-1, 3, 3), np.repeat(points, cameras, axis=0)
    images = project(*pairs)
    assert not judge(*pairs, images).unexplained
    point = images.pair // cameras
    near = np.abs(images.distance / distance[point] - 1.0) < 1e-2 + (scale != 1.0 and offset != 0.0)
    count = np.bincount(point[near], minlength=COUNT)
    assert count.min() >= 1
    # Farther from all sides of one camera's moved triangle than the bounds of any reach: seen only there.
    exact = ExactPairs(*pairs)
    there = Looked(exact, images.pair, *exact.times(images.pair, images.distance))
    heights = (there.at.area / there.at.still * 2.0 ** exact.length_power[images.pair])[:, None] / there.sides
    reach = np.zeros(COUNT)
    np.maximum.at(reach, point[near], (there.sure * heights).max(axis=1)[near])
    inside = near & (there.at.weights * heights > 4.0 * reach[point, None]).all(axis=1)
    assert inside.sum() > 30
    assert (count[point[inside]] == 1).all()
