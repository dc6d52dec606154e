"""Every corner of every face against the true reflection map, on all scenes."""
import numpy as np
import pytest

from core import Settings
from tests.inputs.scenes import SCENES
from tests.oracles.true_map import case_of, corners_of, mesh_of, picture_areas, size_of

pytestmark = pytest.mark.thorough

FLAT = ("flat", "flat_ortho")


def share(view, mesh, chosen):
    """The part of the picture's reflection that the chosen faces cover."""
    areas = np.abs(picture_areas(view, mesh))
    return areas[chosen].sum() / areas.sum()


@pytest.mark.parametrize("name", SCENES)
def test_corners_lie_on_the_true_map(name):
    case, mesh = case_of(name), mesh_of(name)
    corners = corners_of(name)
    exact = corners.miss < 1e-9
    if name in FLAT:
        assert exact.all()
        return
    # Where a straight outline passes a vertex by less than the tolerance, a corner may stand in for another.
    assert share(case.view, mesh, exact.all(axis=1)) > 0.97
    # Next to the silhouette, where Cycles bends the normals, a pixel holds whole turns of the ray.
    off = (corners.displacement > Settings().tolerance).any(axis=1) & ~corners.bent.any(axis=1)
    assert share(case.view, mesh, off) < 2e-3


@pytest.mark.parametrize("name", SCENES)
def test_reflected_points_lie_before_the_mirror(name):
    assert corners_of(name).along.min() > -1e-9


@pytest.mark.parametrize("name", SCENES)
def test_path_length_is_the_distance_between_the_two_positions(name):
    mesh = mesh_of(name)
    distance = np.linalg.norm(mesh.reflected_position - mesh.mirror_position, axis=1)
    np.testing.assert_allclose(mesh.path_length, distance, rtol=0, atol=1e-11 * size_of(case_of(name)))


@pytest.mark.parametrize("name", SCENES)
def test_mirror_positions_lie_on_the_mirror_triangle_that_the_face_names(name):
    case, mesh = case_of(name), mesh_of(name)
    corners = corners_of(name)
    rounding = 1e-9 * (1e3 if name == "sphere_far" else 1.0)
    on_mirror = (corners.off_mirror < rounding).all(axis=1) & (corners.weights.min(axis=(1, 2)) > -1e-6)
    assert on_mirror.all() if name in FLAT else share(case.view, mesh, on_mirror) > 0.99


@pytest.mark.parametrize("name", SCENES)
def test_source_weights_give_the_reflected_position_back(name):
    case, mesh = case_of(name), mesh_of(name)
    sources = case.scene.positions[case.scene.triangles[mesh.source_face]]
    given = np.einsum("fkj,fjx->fkx", mesh.source_weights, sources)
    away = np.abs(given - mesh.reflected_position[mesh.triangles]).max(axis=(1, 2)) / size_of(case)
    np.testing.assert_allclose(mesh.source_weights.sum(axis=2), 1.0, rtol=0, atol=1e-9)
    inside = (mesh.source_weights > -1e-9).all(axis=(1, 2)) & (mesh.source_weights < 1.0 + 1e-9).all(axis=(1, 2))
    if name in FLAT:
        assert away.max() < 1e-12
        assert inside.all()
        return
    assert inside.all()
    # A corner shared by two triangles that an outline puts a fraction of a pixel beside both has the point of one.
    assert share(case.view, mesh, away > 1e-9) < 1e-3


@pytest.mark.parametrize("name", SCENES)
def test_all_faces_are_turned_to_the_eye_where_it_sees_fronts(name):
    case, mesh = case_of(name), mesh_of(name)
    sources = case.scene.positions[case.scene.triangles[mesh.source_face]]
    side = np.cross(sources[:, 1] - sources[:, 0], sources[:, 2] - sources[:, 0])
    seen_from = mesh.mirror_position[mesh.triangles].mean(axis=1)
    front = np.where(((seen_from - sources[:, 0]) * side).sum(axis=1) > 0.0, 1.0, -1.0)
    # Faces that are lines in the picture have no side.
    areas = front * picture_areas(case.view, mesh)
    assert areas.min() > -1e-6
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    normal = np.cross(b - a, c - a)
    towards = -(normal * case.view.directions(a)).sum(axis=1)
    assert (front * towards)[areas > 1e-6].min() > 0.0


@pytest.mark.parametrize("name", SCENES)
def test_arrays_fit_each_other_and_are_finite(name):
    case, mesh = case_of(name), mesh_of(name)
    vertices, faces = len(mesh.positions), len(mesh.triangles)
    assert faces > 500
    shapes = {"positions": (vertices, 3), "reflected_position": (vertices, 3), "mirror_position": (vertices, 3),
              "path_length": (vertices,), "image_parity": (vertices,), "triangles": (faces, 3), "source_face": (faces,),
              "source_weights": (faces, 3, 3), "mirror_face": (faces,)}
    for attribute, shape in shapes.items():
        values = getattr(mesh, attribute)
        assert values.shape == shape
        assert np.isfinite(values).all()
    np.testing.assert_array_equal(np.unique(mesh.triangles), np.arange(vertices))
    assert set(np.unique(mesh.image_parity)) <= {-1, 0, 1}
    assert mesh.source_face.min() >= 0 and mesh.source_face.max() < len(case.scene.triangles)
    assert mesh.mirror_face.min() >= -1 and mesh.mirror_face.max() < len(case.mirror.triangles)
    assert mesh.counts["faces"] == faces
    assert all(isinstance(count, int) for count in mesh.counts.values())
    distinct = np.diff(np.sort(mesh.triangles, axis=1), axis=1) > 0
    assert distinct.all()


@pytest.mark.parametrize("name", ["bowl", "torus", "water", "sphere", "cylinder"])
def test_no_face_joins_images_of_different_parity(name):
    mesh = mesh_of(name)
    # At the caustic itself the magnification passes through zero: such corners belong to either side.
    magnified = corners_of(name).magnified
    mixed = (magnified > 0.02).any(axis=1) & (magnified < -0.02).any(axis=1)
    assert share(case_of(name).view, mesh, mixed) < 2e-3


@pytest.mark.parametrize("name", SCENES)
def test_parity_is_the_side_that_the_ray_bundle_shows(name):
    mesh = mesh_of(name)
    magnified = corners_of(name).magnified
    # A vertex on an edge of the mirror has two magnifications, one in the triangle on either side.
    clear = (np.abs(magnified) > 0.05).all(axis=1) & (np.ptp(np.sign(magnified), axis=1) == 0.0)
    low, high = (np.full(len(mesh.positions), value) for value in (2, -2))
    for corner in range(3):
        np.minimum.at(low, mesh.triangles[:, corner], np.sign(magnified[:, corner]).astype(int))
        np.maximum.at(high, mesh.triangles[:, corner], np.sign(magnified[:, corner]).astype(int))
    one_side = (low == high)[mesh.triangles].all(axis=1) & clear
    agrees = (mesh.image_parity[mesh.triangles] == np.sign(magnified)).all(axis=1)
    assert share(case_of(name).view, mesh, one_side) > 0.5
    assert share(case_of(name).view, mesh, one_side & ~agrees) < 3e-3


def test_a_bowl_shows_both_parities_and_a_ball_only_one():
    bowl, ball = mesh_of("bowl"), mesh_of("sphere")
    assert share(case_of("bowl").view, bowl, (bowl.image_parity[bowl.triangles] == -1).all(axis=1)) > 0.005
    assert share(case_of("sphere").view, ball, (ball.image_parity[ball.triangles] == 1).all(axis=1)) > 0.99
