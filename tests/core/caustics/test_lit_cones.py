"""Lamps that light a cone alone: no more of the mirror is looked at than what lies in it, and the light is the same."""
from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from core import Lamp, caustics
from core.views import in_cone
from tests.core.caustics.test_caustics import graph, level

AXIS, HALF = np.array((0.6, 0.0, -0.8)), 0.08


def spot(place: np.ndarray) -> Lamp:
    def share(places: np.ndarray) -> np.ndarray:
        way = places - place
        ahead = way @ AXIS / np.linalg.norm(way, axis=-1)
        t = np.clip((ahead - np.cos(HALF)) / (0.5 * (1.0 - np.cos(HALF))), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)
    return Lamp(place, pattern=share, narrow=0.5 * HALF)


@pytest.mark.thorough
def test_what_lies_beyond_a_lamp_s_cone_costs_nothing_and_nothing_is_lost():
    dish = graph(lambda r: 0.1 * r**2, lambda r: 0.2 * r, 2.0, 24)
    lamp, ceiling = spot(np.array((-1.5, 0.1, 2.2))), level(0.0, 0.0, 4.0, 6.0)
    every, lit = (caustics(one, dish, ceiling) for one in (lamp, replace(lamp, cone=(AXIS, HALF))))
    # sides beyond the cone are not split, so that those beside it may be others
    assert every.flux.sum() > 0.0 and abs(lit.flux.sum() / every.flux.sum() - 1.0) < 1e-5
    middle = [(mesh.positions[mesh.triangles].mean(axis=1) * mesh.flux[:, None]).sum(axis=0) / mesh.flux.sum()
              for mesh in (every, lit)]
    assert np.abs(middle[0] - middle[1]).max() < 1e-5
    assert lit.counts["mirror_triangles"] < 0.15 * every.counts["mirror_triangles"]
    assert lit.counts.get("missed", 0) == 0


def test_no_triangle_that_a_cone_touches_is_left_out():
    """Against places spread over triangles at random."""
    rng = np.random.default_rng(5)
    corners = rng.normal(size=(3, 1, 4000)) + rng.uniform(0.01, 1.0, 4000) * rng.normal(size=(3, 3, 4000))
    weights = rng.dirichlet((1.0, 1.0, 1.0), 64).T
    places = np.einsum("xkm,kp->xpm", corners, weights)
    for half in (1e-3, 0.1, 0.8, 1.7):
        found = in_cone((AXIS, half), corners)
        ahead = np.tensordot(AXIS, places, 1) / np.linalg.norm(places, axis=0)
        assert not ((ahead >= np.cos(half)).any(axis=0) & ~found).any()
        assert half > 1.0 or not found.all()
