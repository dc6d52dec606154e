"""The same result, bit for bit, however the vertices, triangles and objects are listed."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, reflect
from core.canonical_order import ordered
from tests import shapes
from tests.scenes import SCENES


def shuffled(rng, mesh):
    """The mesh listed in another order, each triangle begun at any corner, and where its parts come from."""
    vertex, triangle = rng.permutation(len(mesh.positions)), rng.permutation(len(mesh.triangles))
    turn = (rng.integers(0, 3, len(triangle))[:, None] + np.arange(3)) % 3
    named = np.take_along_axis(np.argsort(vertex)[mesh.triangles[triangle]], turn, axis=1)
    normals = np.take_along_axis(mesh.corner_normals[triangle], turn[:, :, None], axis=1)
    return mesh.like(mesh.positions[vertex], named, normals), vertex, triangle, turn


def assert_same_reflection(one, other, scene, mirror):
    """Equal bit for bit, once the numbers of the shuffled scene and mirror are told in those of the others."""
    _, vertex, triangle, turn = scene
    for name in ("positions", "triangles", "reflected_position", "mirror_position", "path_length", "image_parity"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)
    np.testing.assert_array_equal(one.source_face, triangle[other.source_face])
    weights = np.zeros_like(other.source_weights)
    np.put_along_axis(weights, np.broadcast_to(turn[other.source_face][:, None, :], weights.shape),
                      other.source_weights, axis=2)
    np.testing.assert_array_equal(one.source_weights, weights)
    np.testing.assert_array_equal(one.mirror_face, mirror[2][other.mirror_face])
    assert one.counts == other.counts and one.estimated_error == other.estimated_error
    if one.discs is not None:
        np.testing.assert_array_equal(one.discs.source_vertex, vertex[other.discs.source_vertex])
        np.testing.assert_array_equal(one.discs.mirror_face, mirror[2][other.discs.mirror_face])
        weights = np.zeros_like(other.discs.mirror_weights)
        np.put_along_axis(weights, mirror[3][other.discs.mirror_face], other.discs.mirror_weights, axis=1)
        np.testing.assert_array_equal(one.discs.mirror_weights, weights)
        for name in ("radius", "axes"):
            np.testing.assert_array_equal(getattr(one.discs, name), getattr(other.discs, name))


@pytest.mark.parametrize("name", ["sphere", "flat", "cylinder", "bowl", "torus"])
@pytest.mark.parametrize("settings", [Settings(), Settings(method="POINTS"), Settings(method="PARALLEL")],
                         ids=lambda settings: settings.method)
def test_order_does_not_matter(name, settings):
    rng = np.random.default_rng(1)
    case = SCENES[name]((160, 160))
    scene, mirror = shuffled(rng, case.scene), shuffled(rng, case.mirror)
    one = reflect(case.view, case.mirror, case.scene, settings)
    other = reflect(case.view, mirror[0], scene[0], settings)
    assert len(one.positions) > 50
    assert_same_reflection(one, other, scene, mirror)


def test_order_does_not_matter_after_two_bounces():
    rng = np.random.default_rng(2)
    case = SCENES["bowl"]((96, 96))
    scene, mirror = shuffled(rng, case.scene), shuffled(rng, case.mirror)
    one = reflect(case.view, case.mirror, case.scene, Settings(depth=2))
    assert (one.bounces == 2).any()
    assert_same_reflection(one, reflect(case.view, mirror[0], scene[0], Settings(depth=2)), scene, mirror)


def test_order_of_objects_does_not_matter():
    """Boxes that stand in each other, one of them twice at one place, joined in two orders."""
    case = SCENES["sphere"]((160, 160))
    boxes = [shapes.box((x, -1.6, 0.4), (0.7, 0.7, 0.7), turn) for x, turn in ((-1.5, 0.1), (-1.2, 0.6), (1.5, 0.3))]
    boxes.append(boxes[2])
    one, other = (reflect(case.view, case.mirror, shapes.combine(*part)) for part in (boxes, boxes[::-1]))
    np.testing.assert_array_equal(one.positions, other.positions)
    np.testing.assert_array_equal(one.triangles, other.triangles)
    np.testing.assert_array_equal(one.reflected_position, other.reflected_position)
    assert (one.source_face // 12 == 3 - other.source_face // 12)[one.source_face < 24].all()


@pytest.mark.parametrize("kind", ["places", "grid", "doubled"])
def test_ordered_meshes_are_one(kind):
    """Any listing of a mesh gives the same arrays, which are the given ones in another order."""
    rng = np.random.default_rng(3)
    positions = rng.normal(size=(60, 3)) if kind == "places" else rng.integers(-2, 3, (60, 3)).astype(np.float64)
    triangles = np.array([rng.permutation(60)[:3] for _ in range(100)])
    if kind == "doubled":
        triangles = np.concatenate((triangles, triangles[:30]))
    else:
        places = positions[triangles]
        corners = np.sort(places.reshape(-1, 9), axis=1)
        _, once = np.unique(corners, axis=0, return_index=True)
        apart = (places != np.roll(places, 1, axis=1)).any(axis=2).all(axis=1)
        triangles = triangles[np.intersect1d(once, np.flatnonzero(apart))]
    normals = rng.normal(size=(len(triangles), 3, 3))
    mesh = TriangleMesh(positions, triangles, normals)
    one, order = ordered(mesh, shading=True)
    turn = (order.first[:, None] + np.arange(3)) % 3
    np.testing.assert_array_equal(one.positions, mesh.positions[order.vertex])
    named = np.take_along_axis(mesh.triangles[order.triangle], turn, axis=1)
    np.testing.assert_array_equal(order.vertex[one.triangles], named)
    given = np.take_along_axis(mesh.corner_normals[order.triangle], turn[:, :, None], axis=1)
    np.testing.assert_array_equal(one.corner_normals, given)
    assert sorted(order.vertex) == list(range(60)) and sorted(order.triangle) == list(range(len(triangles)))
    for _ in range(5):
        other, _ = ordered(shuffled(rng, mesh)[0], shading=True)
        np.testing.assert_array_equal(one.positions[one.triangles], other.positions[other.triangles])
        np.testing.assert_array_equal(one.corner_normals, other.corner_normals)
        if kind == "places":
            np.testing.assert_array_equal(one.triangles, other.triangles)
    again, same = ordered(one, shading=True)
    np.testing.assert_array_equal(again.triangles, one.triangles)
    np.testing.assert_array_equal(same.triangle, np.arange(len(triangles)))


@pytest.mark.parametrize("scale", [1.0, 1e-3, 7.0])
def test_normals_that_have_unit_length_stay(scale):
    rng = np.random.default_rng(5)
    positions, triangles = rng.normal(size=(300, 3)), np.arange(300).reshape(100, 3)
    normals = scale * rng.normal(size=(100, 3, 3))
    once = TriangleMesh(positions, triangles, normals)
    np.testing.assert_allclose(np.linalg.norm(once.corner_normals, axis=2), 1.0, atol=1e-15, rtol=0.0)
    again = TriangleMesh(positions, triangles, once.corner_normals)
    np.testing.assert_array_equal(again.corner_normals, once.corner_normals)


def test_meshes_without_triangles():
    mesh = TriangleMesh(np.array([[1.0, 0, 0], [0, 1, 0], [-0.0, 1, -1]]), np.zeros((0, 3), dtype=int))
    one, order = ordered(mesh, shading=False)
    assert order.vertex.tolist() == [2, 1, 0] and not len(order.triangle) and not np.signbit(one.positions[0, 0])
