"""Which mirrors light has met, and at what angles, against the law of reflection."""
from __future__ import annotations

import numpy as np

from core import Lamp, Settings, TriangleMesh, caustics


def square(origin, first, second) -> TriangleMesh:
    """A parallelogram of four triangles, round its middle."""
    corners = np.array(origin) + np.array([(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)], dtype=float) @ np.array(
        (first, second), dtype=float)
    return TriangleMesh(corners, np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]))


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
    expected = np.abs((turned * normal[:, None]).sum(axis=2))
    np.testing.assert_allclose(mesh.cosine[twice, :, 1], expected, rtol=0, atol=1e-9)
