"""Bounds on what is cut exactly: each that is met is counted, and the mesh stays one that can be drawn."""
from dataclasses import replace

import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from core.filling import Limits
from core.polygons import division
from core.visibility import picture_pairs, scene_contacts, self_occlusion
from core.whole_faces import whole
from tests.inputs import shapes

VIEW = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (128, 96), field_of_view=0.5)
BALLS = shapes.combine(shapes.icosphere((0.0, 0.0, 1.0), 0.8, 2), shapes.icosphere((0.5, -1.5, 1.0), 0.3, 2))
FLOOR = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (3.0, 0.0, 0.0), (0.0, 3.0, 0.0)))
ROOM = shapes.combine(shapes.box((0.0, 4.0, 2.0), (6.0, 1.0, 4.0)), shapes.box((0.0, -8.0, 2.0), (9.0, 1.0, 4.0)))
POLES = shapes.combine(*(shapes.box((x, y, 0.3), (0.12, 0.12, 1.0))
                         for x in (-0.6, 0.0, 0.6) for y in (-0.6, 0.0, 0.6)))
FINE = Settings(tolerance=0.1)

CASES = {
    "pairs in the picture": (BALLS, ROOM, {}, (picture_pairs, "MOST_PAIRS", 0), "overlaid"),
    "lines across a camera": (BALLS, ROOM, {}, (division, "PASSES", 0), "overlaid"),
    "pieces of cameras": (BALLS, ROOM, {}, (self_occlusion, "MOST_PIECES", 0), "overlaid"),
    "triangles over a camera": (BALLS, ROOM, {}, (self_occlusion, "MOST_HIDING", 1), "overlaid"),
    "what cuts through a camera": (FLOOR, POLES, {}, (scene_contacts, "MOST_HIDING", 1), "pierced"),
    "what lies over a camera": (FLOOR, POLES, {}, (picture_pairs, "MOST_PAIRS", 0), "pierced"),
    "outlines in a camera": (FLOOR, ROOM, {"mirrors": BALLS}, (division, "PASSES", 0), "many_outlines"),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", CASES)
def test_what_is_not_cut_is_counted(name, monkeypatch):
    mirror, scene, others, (place, constant, least), count = CASES[name]
    others = {key: TriangleMesh(np.concatenate((mirror.positions, mesh.positions)),
                                np.concatenate((mirror.triangles, mesh.triangles + len(mirror.positions))))
              for key, mesh in others.items()}
    whole = reflect(VIEW, mirror, scene, Settings(), **others)
    assert whole.counts[count] == 0
    monkeypatch.setattr(place, constant, least)
    bounded = reflect(VIEW, mirror, scene, Settings(), **others)
    assert bounded.counts[count] > 0
    assert np.isfinite(bounded.positions).all() and len(bounded.triangles) > 0


@pytest.mark.thorough
def test_cameras_beyond_the_bound_are_told(monkeypatch):
    """Where the mirror may not be split as far as its curvature asks, the result says so."""
    of = Limits.of
    assert reflect(VIEW, BALLS, ROOM, FINE).counts["bounded"] == 0
    monkeypatch.setattr(Limits, "of", lambda *asked: replace(of(*asked), cameras=500))
    assert reflect(VIEW, BALLS, ROOM, FINE).counts["bounded"] > 0


def test_whole_faces_beyond_the_bound_are_told(monkeypatch):
    """Where no more pieces of the scene's triangles may be split, the result says so."""
    monkeypatch.setattr(whole, "LEAST_TRIANGLES", 0)
    of = Limits.of
    free = reflect(VIEW, BALLS, ROOM, FINE)
    assert free.counts["pieces"] > 40 and free.counts["bounded"] == 0
    monkeypatch.setattr(Limits, "of", lambda *asked: replace(of(*asked), pieces=50))
    assert reflect(VIEW, BALLS, ROOM, FINE).counts["bounded"] > 0
