"""`core.reflect` as a whole: the same answer in steps, with a ready tree, in another place or size."""
from dataclasses import fields

import numpy as np
import pytest

from core import (
    METHODS,
    PLACEMENTS,
    Discs,
    ReflectionMesh,
    SceneTree,
    Settings,
    View,
    reflect,
    reflection_steps,
)
from tests.oracles.judge import judge
from tests.oracles.true_map import case_of, mesh_of, truth_of

OTHERS = ("counts", "seconds", "estimated_error", "discs")
ARRAYS = [field.name for field in fields(ReflectionMesh) if field.name not in OTHERS]
KEYS = ("median", "p95", "p99", "uncovered")


def assert_same(one, other):
    for name in ARRAYS:
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    for name in [field.name for field in fields(Discs)] if one.discs is not None else []:
        np.testing.assert_array_equal(getattr(one.discs, name), getattr(other.discs, name))
    assert one.counts == other.counts
    assert one.estimated_error == other.estimated_error


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat", "bowl"])
def test_a_tree_built_before_gives_the_same_mesh_bit_for_bit(name):
    case = case_of(name)
    tree = SceneTree.build(case.scene)
    assert_same(reflect(case.view, case.mirror, tree), mesh_of(name))
    # The tree stays as it is and serves another eye.
    view = View.looking_at(case.view.eye + 0.1, case.mirror.positions.mean(axis=0), (200, 200))
    assert_same(reflect(view, case.mirror, tree), reflect(view, case.mirror, case.scene))
    assert_same(reflect(case.view, case.mirror, tree), mesh_of(name))


@pytest.mark.thorough
@pytest.mark.parametrize("placement", PLACEMENTS)
@pytest.mark.parametrize("method", METHODS)
def test_steps_tell_a_rising_share_and_return_the_mesh(method, placement):
    case, settings = case_of("sphere"), Settings(method=method, placement=placement)
    steps, told = reflection_steps(case.view, case.mirror, case.scene, settings), []
    while True:
        try:
            told.append(next(steps))
        except StopIteration as end:
            result = end.value
            break
    shares, stages = zip(*told)
    assert len(set(told)) >= 5
    # in a stage that takes long the same is told again
    assert (np.diff(sorted(set(shares))) > 0.0).all() and list(shares) == sorted(shares)
    assert len(set(shares)) == len(set(told))
    assert shares[0] >= 0.0 and shares[-1] <= 1.0
    assert all(isinstance(stage, str) and stage for stage in stages)
    assert_same(result, mesh_of("sphere", method=method, placement=placement))
    assert all(seconds >= 0.0 for seconds in result.seconds.values())


def test_stopping_between_steps_leaves_nothing_behind():
    case = case_of("sphere")
    steps = reflection_steps(case.view, case.mirror, case.scene)
    next(steps), next(steps)
    steps.close()
    assert_same(reflect(case.view, case.mirror, case.scene), mesh_of("sphere"))


def test_the_input_is_left_as_it_was():
    case = case_of("sphere")
    kept = [array.copy() for mesh in (case.mirror, case.scene)
            for array in (mesh.positions, mesh.triangles, mesh.corner_normals)]
    reflect(case.view, case.mirror, case.scene)
    for before, after in zip(kept, (array for mesh in (case.mirror, case.scene)
                                    for array in (mesh.positions, mesh.triangles, mesh.corner_normals))):
        np.testing.assert_array_equal(before, after)


@pytest.mark.thorough
@pytest.mark.parametrize(("offset", "scale"), [(1e4, 1.0), (0.0, 1e-3), (0.0, 1e3), (50.0, 1e-2)])
@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "flat", "bowl"])
def test_place_and_size_do_not_matter(name, offset, scale):
    case = case_of(name)
    expected = judge(case.view, case.mirror, case.scene, mesh_of(name), truth_of(name))
    case = case.moved(name, np.array([offset, -offset, 0.3 * offset]), scale)
    mesh = reflect(case.view, case.mirror, case.scene)
    numbers = judge(case.view, case.mirror, case.scene, mesh)
    np.testing.assert_allclose([numbers[key] for key in KEYS], [expected[key] for key in KEYS], rtol=0, atol=0.03)
    assert len(mesh.triangles) == pytest.approx(len(mesh_of(name).triangles), rel=0.01)


def test_counts_tell_how_much_each_part_was_needed():
    flat, ball = mesh_of("flat").counts, mesh_of("sphere").counts
    assert flat["cameras"] < 10 < ball["cameras"]
    assert flat["mirror_triangles"] == 2
    assert ball["projections"] >= ball["images"] > 100
    assert ball["candidates"] <= ball["pairs"]
    vertices = len(case_of("sphere").scene.positions)
    assert ball["projections"] < 12 * vertices


@pytest.mark.parametrize("wrong", [{"tolerance": 0.0}, {"tolerance": -1.0}, {"tolerance": float("nan")},
                                   {"tolerance": float("inf")}, {"placement": "ABOVE"}, {"method": "RAYS"},
                                   {"maximum_faces": 0}])
def test_settings_out_of_range_are_refused_in_one_sentence(wrong):
    with pytest.raises(ValueError, match=r"^[A-Z][^.]*\.$"):
        Settings(**wrong)
