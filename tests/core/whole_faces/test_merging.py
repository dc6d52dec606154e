"""Parts of a scene below a pixel are drawn together, and nobody sees it."""
import numpy as np
import pytest

import core.whole_faces.whole as whole_room
from core import Settings, TriangleMesh, reflect
from tests.inputs import fine_scenes
from tests.inputs.dense_scenes import dense, knots_in_a_ball
from tests.oracles.judge import compare
from tests.oracles.true_map import picture_areas
from tests.oracles.truth import trace

pytestmark = pytest.mark.slow


def judged(case, mesh):
    return compare(case.view, case.mirror, mesh, trace(case.view, case.mirror, case.scene)).numbers


@pytest.mark.parametrize(("name", "size", "share"),
                         [("sphere", 48, 0.36), ("sphere_ortho", 64, 0.45), ("knots", 48, 0.71)])
def test_a_scene_finer_than_the_picture_has_fewer_faces_and_looks_as_it_is(name, size, share, monkeypatch):
    """`share` is the measured ratio of faces."""
    case = knots_in_a_ball((size, size)) if name == "knots" else dense(name, (size, size), 0.06)
    mesh = reflect(case.view, case.mirror, case.scene)
    monkeypatch.setattr(whole_room, "TOGETHER", 0.0)
    apart = reflect(case.view, case.mirror, case.scene)
    assert len(mesh.triangles) < 1.1 * share * len(apart.triangles)
    numbers, before = judged(case, mesh), judged(case, apart)
    # measured: at most 0.176 pixels; one pixel more, which is 0.04 to 0.08 % of these mirrors
    assert numbers["p99"] < 0.3 and numbers["uncovered"] < before["uncovered"] + 0.09


@pytest.fixture(scope="module")
def ball():
    """A scene finer than its picture, and its mesh."""
    case = dense("sphere", (64, 64), 0.09)
    return case, reflect(case.view, case.mirror, case.scene)


def test_vertices_are_moved_onto_vertices(ball):
    case, mesh = ball
    whole = np.unique(mesh.triangles[mesh.mirror_face < 0])
    # the others lie on edges that bend, or are a neighbour's
    known = np.isin(_named(mesh.reflected_position[whole]), _named(case.scene.positions))
    assert known.mean() > 0.6


def test_the_tolerance_says_what_is_drawn_together():
    case = dense("sphere", (96, 96), 0.12)
    faces = [len(reflect(case.view, case.mirror, case.scene, Settings(tolerance=tolerance)).triangles)
             for tolerance in (0.25, 1.0, 4.0)]
    assert faces[0] > 1.2 * faces[1] > 1.4 * faces[2]


def test_all_of_the_geometry_is_kept_where_it_is_asked_for():
    case = dense("sphere", (96, 96), 0.12)
    every = reflect(case.view, case.mirror, case.scene, Settings(hidden_faces=True))
    seen = reflect(case.view, case.mirror, case.scene)
    shown = np.unique(seen.source_face)
    assert len(np.unique(every.source_face)) > 1.5 * len(shown)


def test_corners_in_one_place_move_together(ball):
    """Faces that share no vertex, as in many files: no crack opens between them."""
    case, apart = ball
    scene = case.scene
    soup = TriangleMesh(scene.positions[scene.triangles].reshape(-1, 3),
                        np.arange(scene.triangles.size).reshape(-1, 3))
    mesh = reflect(case.view, case.mirror, soup)
    numbers = compare(case.view, case.mirror, mesh, trace(case.view, case.mirror, scene)).numbers
    assert numbers["hole"] < 0.05 and len(mesh.triangles) < 1.2 * len(apart.triangles)


@pytest.mark.parametrize("case", [fine_scenes.crown(), fine_scenes.fence()], ids=["leaves", "wires"])
def test_leaves_and_wires_below_a_pixel_are_not_lost(case, monkeypatch):
    areas = []
    for together in (2.0, 0.0):
        monkeypatch.setattr(whole_room, "TOGETHER", together)
        mesh = reflect(case.view, case.mirror, case.scene)
        areas.append(np.abs(picture_areas(case.view, mesh)).sum())
        numbers = judged(case, mesh)
        # measured: 0 and 0.004
        assert numbers["hole"] < 0.05 and numbers["p99"] < 0.01
    assert abs(areas[0] / areas[1] - 1.0) < 0.001


def test_what_does_not_hang_together_stays_apart():
    case = fine_scenes.coat()
    mesh = reflect(case.view, case.mirror, case.scene)
    assert mesh.counts["whole"] > 1000 and len(mesh.triangles) < 0.7 * len(case.scene.triangles) / 2
    half = len(case.scene.triangles) // 2
    radius = np.linalg.norm(mesh.reflected_position - (-1.0, -2.6, 0.9), axis=1)[mesh.triangles]
    outer = mesh.source_face >= half
    # the smallest balls round and in the two of icosahedra
    assert (radius[outer] > 0.6025).all() and (radius[~outer] < 0.6015).all() and 0.3 < outer.mean() < 0.7


def _named(points: np.ndarray) -> np.ndarray:
    return np.ascontiguousarray(np.round(points, 9) + 0.0).view([("", float)] * 3).ravel()
