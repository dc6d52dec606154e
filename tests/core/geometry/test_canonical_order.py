"""The same result, bit for bit, however the vertices, triangles and objects are listed."""
from itertools import permutations

import numpy as np
import pytest

from core import Settings, TriangleMesh, reflect
from core.geometry.canonical_order import ordered
from tests.inputs import shapes
from tests.inputs.scenes import SCENES

pytestmark = pytest.mark.slow


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
    np.testing.assert_array_equal(one.mirror_face, np.append(mirror[2], -1)[other.mirror_face])
    assert one.counts == other.counts and one.estimated_error == other.estimated_error
    if one.discs is not None:
        np.testing.assert_array_equal(one.discs.source_vertex, vertex[other.discs.source_vertex])
        np.testing.assert_array_equal(one.discs.mirror_face, mirror[2][other.discs.mirror_face])
        weights = np.zeros_like(other.discs.mirror_weights)
        np.put_along_axis(weights, mirror[3][other.discs.mirror_face], other.discs.mirror_weights, axis=1)
        np.testing.assert_array_equal(one.discs.mirror_weights, weights)
        for name in ("radius", "axes"):
            np.testing.assert_array_equal(getattr(one.discs, name), getattr(other.discs, name))


@pytest.mark.parametrize("name", ["sphere", "flat", "flat_ortho", "cylinder", "water", "bowl", "torus"])
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


def triangles_of(kind):
    """Corners (n, 3, 3) of many triangles, of one kind."""
    rng = np.random.default_rng(7)
    corners = rng.normal(size=(20_000, 3, 3))
    if kind == "far":
        corners += 1e4 * rng.normal(size=(20_000, 1, 3))
    if kind == "slivers":
        corners[:, 2] = corners[:, 0] + 0.3 * (corners[:, 1] - corners[:, 0]) + 1e-9 * corners[:, 2]
    if kind == "equal coordinates":
        # many corners share one or two of them, and some their place
        corners = np.where(rng.random(corners.shape) < 0.5, rng.choice([-1.0, -0.0, 0.0, 0.3], corners.shape), corners)
    if kind == "sizes":
        corners *= 10.0 ** rng.uniform(-30.0, 30.0, (20_000, 1, 1))
    return corners


@pytest.mark.parametrize("kind", ["random", "far", "slivers", "equal coordinates", "sizes"])
def test_flat_normals_do_not_depend_on_the_first_corner(kind):
    """To the last bit; and turning a triangle round turns the sign alone."""
    corners = triangles_of(kind)
    positions, triangles = corners.reshape(-1, 3), np.arange(60_000).reshape(-1, 3)
    plain = TriangleMesh(positions, triangles).face_normals()
    # all but the slivers are far from rounding's reach
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    sure = np.linalg.norm(plain, axis=1) > 0.0
    assert sure.mean() > 0.8
    expected = np.cross(u, v)[sure] / np.linalg.norm(np.cross(u, v)[sure], axis=1, keepdims=True)
    np.testing.assert_allclose(plain[sure], expected, rtol=0.0, atol=1e-4 if kind == "slivers" else 1e-9)
    for order in permutations(range(3)):
        even = order in ((0, 1, 2), (1, 2, 0), (2, 0, 1))
        mesh = TriangleMesh(positions, triangles[:, order])
        np.testing.assert_array_equal(mesh.face_normals(), plain if even else -plain)
        np.testing.assert_array_equal(mesh.corner_normals, np.repeat(mesh.face_normals()[:, None], 3, axis=1))
        # zero normals are replaced by the same ones
        given = np.random.default_rng(8).normal(size=(20_000, 3, 3))
        given[::2, 1], given[::3] = 0.0, 0.0
        mended = TriangleMesh(positions, triangles[:, order], given).corner_normals
        none = (given == 0.0).all(axis=2)
        np.testing.assert_array_equal(mended[none], mesh.corner_normals[none])
        np.testing.assert_array_equal(mended[~none], TriangleMesh(positions, triangles, given).corner_normals[~none])


@pytest.mark.parametrize("options", [{}, {"method": "PARALLEL"}, {"method": "POINTS"}, {"depth": 2}],
                         ids=["general", "parallel", "points", "deep"])
@pytest.mark.parametrize("normals", ["none", "some zero"])
@pytest.mark.parametrize("name", ["sphere_ico", "cylinder", "soup"])
def test_order_does_not_matter_without_normals(name, normals, options):
    """Each listing computes the flat normals of its own triangles."""
    rng = np.random.default_rng(4)
    case = SCENES["sphere_ico" if name == "soup" else name]((64, 64))
    mirror, scene = case.mirror, TriangleMesh(case.scene.positions, case.scene.triangles)
    if name == "soup":
        corners = mirror.positions[mirror.triangles[::9]] + rng.normal(scale=0.1, size=(143, 3, 3))
        mirror = TriangleMesh(corners.reshape(-1, 3), np.arange(429).reshape(-1, 3))
    given = None if normals == "none" else np.where(rng.random((len(mirror.triangles), 1, 1)) < 0.5, 0.0,
                                                    mirror.corner_normals)
    mirror = TriangleMesh(mirror.positions, mirror.triangles, given)
    other_mirror, other_scene = shuffled(rng, mirror), shuffled(rng, scene)
    _, _, triangle, turn = other_mirror
    if given is not None:
        given = np.take_along_axis(given[triangle], turn[:, :, None], axis=1)
    listed = TriangleMesh(other_mirror[0].positions, other_mirror[0].triangles, given)
    settings = Settings(tolerance=1.0, **options)
    one = reflect(case.view, mirror, scene, settings)
    other = reflect(case.view, listed, TriangleMesh(other_scene[0].positions, other_scene[0].triangles), settings)
    # facets show few of the vertices
    assert len(one.positions) > (0 if settings.method == "POINTS" else 50)
    assert_same_reflection(one, other, other_scene, other_mirror)


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
