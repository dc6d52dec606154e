"""Which mirrors light has met, and at what angles, against the law of reflection."""
from __future__ import annotations

import numpy as np
import pytest

from core import Lamp, Settings, TriangleMesh, caustics
from core.rivals.tracing import LightRays
from tests.core.caustics.test_caustics import level, quad, upright


def square(origin, first, second) -> TriangleMesh:
    """A parallelogram of four triangles, round its middle."""
    corners = np.array(origin) + np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)], dtype=float) @ np.array(
        (first, second), dtype=float)
    return TriangleMesh(corners, np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))


@pytest.mark.thorough
def test_light_tells_the_mirrors_that_it_has_met_and_how_steeply():
    """A lamp before an upright mirror, opposite to a leaning one, behind which more mirrors stand."""
    lamp = Lamp((0.4, 0.1, 1.2))
    mirror = square((0.0, -0.5, 0.5), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    aside = square((9.0, 9.0, 9.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    leaning = square((3.0, -2.0, 0.5), (0.0, 4.0, 0.0), (-0.8, 0.0, 3.0))
    others, rng = TriangleMesh.joined((aside, leaning)), np.random.default_rng(4)
    order = rng.permutation(len(others.triangles))
    mixed = TriangleMesh(others.positions, others.triangles[order])
    floor = square((-9.0, -9.0, 0.0), (30.0, 0.0, 0.0), (0.0, 18.0, 0.0))
    mesh = caustics(lamp, mirror, floor, Settings(depth=2), mixed)
    assert set(mesh.bounces) == {1, 2} and mesh.met.shape == (len(mesh.triangles), 2)
    assert (mesh.met[mesh.bounces == 1, 1] == -1).all()
    places = mesh.mirror_position[mesh.triangles]
    way = places - lamp.place
    way /= np.linalg.norm(way, axis=2, keepdims=True)
    np.testing.assert_allclose(mesh.cosine[:, :, 0], -way[..., 0], rtol=0, atol=1e-9)
    # where the light of each face's middle goes on to
    twice = np.flatnonzero(mesh.bounces == 2)
    start, sent = places[twice].mean(axis=1), way[twice].mean(axis=1) * (-1.0, 1.0, 1.0)
    corners = mixed.positions[mixed.triangles[mesh.met[twice, 1] - len(mirror.triangles)]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    along = ((corners[:, 0] - start) * normal).sum(axis=1) / (sent * normal).sum(axis=1)
    hit = start + along[:, None] * sent
    for first, second in ((0, 1), (1, 2), (2, 0)):
        side = np.cross(corners[:, second] - corners[:, first], hit - corners[:, first])
        assert ((side * normal).sum(axis=1) > -1e-3).all()
    assert len(np.unique(mesh.met[twice, 1])) == 4
    turned = way[twice] * (-1.0, 1.0, 1.0)
    # at backs it is negative
    expected = -(turned * normal[:, None]).sum(axis=2)
    assert (expected < 0.0).all()
    np.testing.assert_allclose(mesh.cosine[twice, :, 1], expected, rtol=0, atol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("lean", [-0.3, 0.3])
def test_a_floor_hides_from_a_second_mirror_what_reaches_below_it(lean):
    """A mirror that leans back sends up what comes to it above the floor; through the floor it would send the rest to
    its underside. Against rays, leaning either way."""
    lamp, first, floor = Lamp((-0.4, 0.1, 1.4)), upright(1.2, 0.7, 0.6), level(0.0, 0.0, 0.0, 10.0)
    up, along = np.array((-np.sin(lean), 0.0, -np.cos(lean))), np.array((0.0, 1.0, 0.0))
    second = quad(*((-2.2, 0.0, 2.0) + 3.0 * (sx * up + sy * along) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))))
    mesh, rays = caustics(lamp, first, floor, Settings(depth=2), second), LightRays(first, floor, second)
    landed = rays.thrown(lamp, 200_000, depth=2)
    twice = landed.met[1] >= 0
    for number, chosen in ((1, ~twice), (2, twice)):
        assert abs(mesh.flux[mesh.bounces == number].sum() - landed.flux[chosen].sum()) < 1e-3 * landed.flux.sum()
    assert twice.any() == (lean > 0.0)
