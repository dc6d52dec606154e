"""The parallel method: one ray for each mirror triangle, and parallel projection along it in closed form."""
import numpy as np
import pytest

from core import Settings, reflect
from tests.oracles.judge import compare
from tests.oracles.true_map import case_of, mesh_of, size_of, true_rays, truth_of, view_rays

pytestmark = pytest.mark.thorough

NAMES = ["sphere", "sphere_ortho", "flat", "flat_ortho", "water", "bowl", "sphere_small"]


@pytest.mark.parametrize("name", NAMES)
def test_every_corner_is_the_parallel_projection_of_its_point(name):
    case, mesh = case_of(name), mesh_of(name, method="PARALLEL")
    face, vertex = np.repeat(mesh.mirror_face, 3), mesh.triangles.ravel()
    middle = case.mirror.positions[case.mirror.triangles[face]].mean(axis=1)
    _, ray, *_ = true_rays(case.mirror, face, *view_rays(case.view, middle))
    normal, point = case.mirror.face_normals()[face], mesh.reflected_position[vertex]
    # Back along the ray from the point to the triangle's plane.
    distance = ((point - middle) * normal).sum(axis=1) / (ray * normal).sum(axis=1)
    expected = point - distance[:, None] * ray
    size = size_of(case)
    # A ray that grazes the plane magnifies rounding.
    steep = np.abs((ray * normal).sum(axis=1)) > 0.02
    assert steep.mean() > 0.9
    np.testing.assert_allclose(mesh.mirror_position[vertex][steep], expected[steep], rtol=0, atol=1e-8 * size)
    np.testing.assert_allclose(mesh.path_length[vertex][steep], distance[steep], rtol=0, atol=1e-8 * size)
    _, _, weights, _ = true_rays(case.mirror, face, *view_rays(case.view, mesh.mirror_position[vertex]))
    assert weights.min() > -1e-9
    assert (mesh.image_parity == 1).all()


@pytest.mark.parametrize("name", NAMES)
def test_source_weights_are_exact(name):
    case, mesh = case_of(name), mesh_of(name, method="PARALLEL")
    given = np.einsum("fkj,fjx->fkx", mesh.source_weights, case.scene.positions[case.scene.triangles[mesh.source_face]])
    np.testing.assert_allclose(given, mesh.reflected_position[mesh.triangles], rtol=0, atol=1e-11 * size_of(case))
    assert mesh.source_weights.min() > -1e-9
    assert mesh.source_weights.max() < 1.0 + 1e-9


def test_both_methods_agree_on_a_flat_mirror_in_an_orthographic_view():
    case, truth = case_of("flat_ortho"), truth_of("flat_ortho")
    for method in ("GENERAL", "PARALLEL"):
        numbers = compare(case.view, case.mirror, mesh_of("flat_ortho", method=method), truth).numbers
        assert numbers["maximum"] < 1e-6
        # no pixel, of 0.003 %, differs
        assert numbers["uncovered"] < 0.006


def test_the_parallel_method_is_off_by_far_more_on_a_curved_mirror():
    case = case_of("sphere")
    general, parallel = (compare(case.view, case.mirror, mesh_of("sphere", method=method), truth_of("sphere")).numbers
                         for method in ("GENERAL", "PARALLEL"))
    assert parallel["median"] > 5.0 * general["median"]
    assert parallel["uncovered"] > general["uncovered"]


def test_it_needs_no_refinement_of_the_mirror():
    case = case_of("sphere")
    # all of the geometry, none of it by rays
    coarse, fine = (reflect(case.view, case.mirror, case.scene, Settings(tolerance=tolerance, method="PARALLEL",
                                                                         hidden_faces=True))
                    for tolerance in (1.0, 0.01))
    assert coarse.counts["cameras"] == fine.counts["cameras"]
