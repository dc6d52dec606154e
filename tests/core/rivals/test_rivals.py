"""All rivals by the table: what they hand back, and that the method does not know of them."""
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from core import ReflectionError, Settings, TriangleMesh, View
from core.rivals import ITSELF, METHODS, NOTHING, primary_hits
from tests.oracles.judge import compare, compare_picture
from tests.oracles.true_map import case_of, mesh_of, truth_of

pytestmark = pytest.mark.slow

ROOT = Path(__file__).resolve().parents[3]
PIXELS = 256


@cache
def hits_of(name):
    case = case_of(name)
    return primary_hits(case.view, case.mirror, case.scene)


@cache
def run_of(name, method, value):
    case = case_of(name)
    picture = METHODS[method].run(case.view, case.mirror, case.scene, value, hits_of(name))
    return picture, compare_picture(case.view, truth_of(name), picture.triangle, picture.position).numbers


@pytest.mark.parametrize("method", METHODS)
def test_every_method_hands_back_a_picture_with_its_work(method):
    picture, numbers = run_of("sphere", method, METHODS[method].values[0])
    case = case_of("sphere")
    assert picture.triangle.shape == (PIXELS, PIXELS) and picture.position.shape == (PIXELS, PIXELS, 3)
    assert set(np.unique(picture.triangle[picture.triangle < 0])) <= {NOTHING, ITSELF}
    assert picture.triangle.max() < len(case.scene.triangles)
    shown = picture.triangle >= 0
    assert (picture.position[~shown] == 0.0).all()
    # what is shown lies on the triangle that is named, or within its plane where points stand for what is round them
    corners = case.scene.positions[case.scene.triangles[picture.triangle[shown]]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert np.abs(((picture.position[shown] - corners[:, 0]) * normal).sum(axis=1)).max() < 1e-6
    names = ("intersections", "traversals", "projections", "rays", "nodes")
    assert all(type(picture.counts[name]) is int and picture.counts[name] >= 0 for name in names)
    assert sum(picture.counts.values()) > 0 and picture.seconds and min(picture.seconds.values()) >= 0.0
    assert numbers["compared"] > 3000
    # discs are larger than what they stand for
    assert numbers["spill_outside"] == 0.0 or method == "POINTS"


@pytest.mark.parametrize("name, method, value", [("sphere", "GENERAL", 0.5), ("torus", "PARALLEL", 0)])
def test_cameras_are_judged_as_their_meshes_are(name, method, value):
    case = case_of(name)
    _, drawn = run_of(name, method, value)
    expected = compare(case.view, case.mirror, mesh_of(name, method=method), truth_of(name)).numbers
    for name in ("median", "p95", "p99", "maximum", "hole", "spill", "wrong_layer"):
        assert drawn[name] == pytest.approx(expected[name], abs=1e-6)


def test_nothing_to_see_is_told_before_any_rival_starts():
    case = case_of("sphere", 64)
    away = View.looking_at((0.0, -6.0, 2.0), (0.0, -12.0, 2.0), (64, 64))
    with pytest.raises(ReflectionError, match="does not see the mirror"):
        primary_hits(away, case.mirror, case.scene)
    with pytest.raises(ReflectionError, match="no faces"):
        primary_hits(case.view, case.mirror, TriangleMesh(case.scene.positions, case.scene.triangles[:0]))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("resolution", [(1, 1), (1, 9), (7, 2)])
def test_tiny_pictures_and_scenes_of_one_triangle_are_no_trouble(method, resolution):
    case = case_of("flat", 64)
    view = View.looking_at((0.3, -2.0, 1.7), (0.0, 2.0, 1.6), resolution, field_of_view=0.2)
    one = TriangleMesh([[-9.0, -6.0, -9.0], [9.0, -6.0, -9.0], [0.0, -6.0, 12.0]], [[0, 1, 2]])
    hits = primary_hits(view, case.mirror, one)
    picture = METHODS[method].run(view, case.mirror, one, METHODS[method].values[0], hits)
    assert picture.triangle.shape == resolution[::-1] and len(hits.pixel) == resolution[0] * resolution[1]
    # all rays go back to the triangle behind the eye
    assert (picture.triangle == 0).all() or method == "MORPHING"


def test_mirror_and_scene_hide_what_lies_behind_them_from_meshes():
    case, hits = case_of("sphere"), hits_of("sphere")
    for depth in ("mirror_depth", "scene_depth"):
        nearer = replace(hits, **{depth: np.full((PIXELS, PIXELS), 4.0)})
        assert (METHODS["GENERAL"].run(case.view, case.mirror, case.scene, 2.0, nearer).triangle == NOTHING).all()


@pytest.mark.parametrize("method, times", [("PARALLEL", 2.0), ("UNREFINED", 3.0)])
def test_a_finer_mirror_helps_the_cameras_that_are_not_refined(method, times):
    # a parallel camera is off by its size, a general one by the square of it
    coarse, fine = (run_of("sphere", method, value)[1] for value in METHODS[method].values[:2])
    assert 0.7 * times < coarse["p99"] / fine["p99"] < 2.0 * times


def test_without_refinement_there_are_only_the_mirrors_own_cameras():
    hits, (picture, numbers) = hits_of("sphere"), run_of("sphere", "UNREFINED", 0)
    assert picture.counts["traversals"] < 1.5 * len(np.unique(hits.face))
    assert numbers["p99"] > 3.0 * run_of("sphere", "GENERAL", 0.5)[1]["p99"]


def test_more_points_make_smaller_errors():
    coarse, fine = (run_of("sphere", "POINTS", value)[1] for value in (3000, 30000))
    assert fine["median"] < 0.6 * coarse["median"] and fine["p99"] < 0.6 * coarse["p99"]


def test_a_tolerance_is_kept_in_this_ring_too():
    for tolerance in (1.0, 0.5):
        assert run_of("sphere", "GENERAL", tolerance)[1]["p99"] < tolerance
    assert Settings().tolerance == 0.5


def test_the_method_does_not_know_of_its_rivals():
    code = "import sys, core; print([name for name in sys.modules if name.startswith('core.rivals')])"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
    for path in (ROOT / "core").rglob("*.py"):
        assert "rivals" in path.relative_to(ROOT).parts or "rivals" not in path.read_text(encoding="utf-8"), path.name


def test_the_judge_finds_no_error_in_the_truth_and_the_whole_error_in_an_empty_picture():
    case, truth = case_of("sphere"), truth_of("sphere")
    shape = (PIXELS, PIXELS)
    numbers = compare_picture(case.view, truth, truth.source_triangle.reshape(shape),
                              truth.position.reshape(*shape, 3)).numbers
    assert numbers["maximum"] == 0.0 and numbers["hole"] == numbers["wrong_layer"] == 0.0
    # one pixel to the right: what it shows has moved by as much as a pixel moves it, or crossed to another surface
    moved = compare_picture(case.view, truth, np.roll(truth.source_triangle.reshape(shape), 1, axis=1),
                            np.roll(truth.position.reshape(*shape, 3), 1, axis=1)).numbers
    assert 0.5 < moved["median"] <= 1.05 and moved["uncovered"] > 0.3
    empty = compare_picture(case.view, truth, np.full(shape, -1), np.zeros((*shape, 3))).numbers
    sees = (truth.source_triangle >= 0) & ~truth.bent & ~truth.sees_itself
    assert empty["hole"] == pytest.approx(100.0 * sees.sum() / empty["mirror_pixels"]) and empty["compared"] == 0
