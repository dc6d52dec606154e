"""Creases of a mesh in many places: told once where angles stay, and in each place where they do not."""
from __future__ import annotations

import numpy as np
import pytest

EDGES, CREASE = 400, np.cos(np.radians(40.0))


def turned(rng, scale) -> np.ndarray:
    """A random rotation, as exact as Blender's own numbers are, times a scale."""
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return rotation.astype(np.float32).astype(np.float64) * scale


def cofactor(linear: np.ndarray) -> np.ndarray:
    return np.linalg.inv(linear).T * abs(np.linalg.det(linear))


def hinges(rng) -> np.ndarray:
    """Normals (2 EDGES, 3) of faces that meet at all angles, a third of them nearly at the limit."""
    angle = rng.uniform(0.0, 80.0, EDGES)
    angle[::3] = 40.0 + rng.choice([-1.0, 1.0], len(angle[::3])) * 10.0 ** rng.uniform(-7.0, -2.0, len(angle[::3]))
    one = rng.normal(size=(EDGES, 3))
    one /= np.linalg.norm(one, axis=1)[:, None]
    across = np.cross(one, rng.normal(size=(EDGES, 3)))
    across /= np.linalg.norm(across, axis=1)[:, None]
    angle = np.radians(angle)[:, None]
    return np.concatenate((one, np.cos(angle) * one + np.sin(angle) * across)).astype(np.float32)


@pytest.mark.parametrize("stretched", [False, True])
def test_places_that_keep_angles_have_the_creases_that_each_has_by_itself(room, stretched):
    rng = np.random.default_rng(3)
    normals, scales = hinges(rng), 10.0 ** rng.uniform(-3.0, 3.0, 12)
    linear = np.stack([turned(rng, scale) for scale in scales])
    if stretched:
        linear[::2] = linear[::2] @ np.diag((1.0, 1.4, 0.6))
    meeting = np.stack((np.arange(EDGES), EDGES + np.arange(EDGES))).astype(np.int32)
    # behind them edges with one face, which are no creases
    meeting_of = np.append(np.arange(EDGES), (-1, -1)).astype(np.int32)
    cofactors = np.stack(list(map(cofactor, linear)))
    creases = room("addon.reading.meshes.creases").Creases.of(meeting, meeting_of, normals, cofactors)
    assert creases.even.tolist() == [not stretched or index % 2 == 1 for index in range(12)]
    edge = np.tile(np.arange(EDGES + 2), 12)
    found = creases.among(np.stack((edge, edge, edge), axis=1), np.repeat(np.arange(12), EDGES + 2))
    assert (found == found[:, :1]).all()
    for turn, own in zip(cofactors, found[:, 0].reshape(12, -1)):
        one, other = (normals[side].astype(np.float64) @ turn.T for side in meeting)
        cosine = (one * other).sum(axis=1) / (np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1))
        told = np.abs(cosine - CREASE) > 1e-14  # else rounding decides
        assert (own[:EDGES][told] == (cosine < CREASE)[told]).all() and told.sum() > EDGES - 3
        assert not own[EDGES:].any()


def test_no_more_than_the_doubtful_edges_are_asked_in_each_place(room, monkeypatch):
    module, rng = room("addon.reading.meshes.creases"), np.random.default_rng(5)
    normals, asked, plain = hinges(rng), [], module._products
    monkeypatch.setattr(module, "_products", lambda one, *given: asked.append(len(one)) or plain(one, *given))
    meeting = np.stack((np.arange(EDGES), EDGES + np.arange(EDGES))).astype(np.int32)
    cofactors = np.stack([cofactor(turned(rng, 1.0)) for _ in range(100)])
    creases = module.Creases.of(meeting, np.arange(EDGES, dtype=np.int32), normals, cofactors)
    edge = np.tile(np.arange(EDGES), 100).reshape(-1, 1).repeat(3, axis=1)
    creases.among(edge, np.repeat(np.arange(100), EDGES))
    assert asked[0] == EDGES and 0 < asked[1] < 0.35 * edge.size
