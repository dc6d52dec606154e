"""The core's door: a right argument in any guise gives the same result."""
import re
import warnings
from dataclasses import fields, replace
from fractions import Fraction

import numpy as np
import pytest

from core import PointTree, ReflectionError, SceneTree, Settings, TriangleMesh, View, project, reflect
from tests.inputs.scenes import SCENES
from tests.inputs.small_scene import MIRROR, POSITIONS, SCENE, TRIANGLES, VIEW, looking
from tests.oracles.judge import judge
from tests.oracles.truth import trace

NAN, INF = float("nan"), float("inf")


def same(one, other):
    for field in fields(one):
        values = getattr(one, field.name)
        if isinstance(values, np.ndarray):
            np.testing.assert_array_equal(values, getattr(other, field.name), err_msg=field.name)


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


GUISES = {
    "list": lambda array: array.tolist(),
    "tuple": lambda array: tuple(map(tuple, array)),
    "float32": lambda array: array.astype(np.float32 if array.dtype.kind == "f" else np.int32),
    "float16": lambda array: array.astype(np.float16 if array.dtype.kind == "f" else np.uint8),
    "longdouble": lambda array: array.astype(np.longdouble if array.dtype.kind == "f" else np.uint64),
    "big endian": lambda array: array.astype(array.dtype.newbyteorder(">")),
    "objects": lambda array: array.astype(object),
    "columns first": np.asfortranarray,
    "backwards": lambda array: np.ascontiguousarray(array[::-1])[::-1],
    "every second": lambda array: np.repeat(array, 2, axis=0)[::2],
    "read-only": read_only,
}


@pytest.mark.thorough
@pytest.mark.parametrize("guise", GUISES)
@pytest.mark.parametrize("method", ["GENERAL", "POINTS"])
def test_the_same_arrays_in_any_guise_give_the_same_mesh(guise, method):
    # all coordinates are small binary fractions, which every precision holds
    given = GUISES[guise]
    mirror, scene = (TriangleMesh(given(mesh.positions), given(mesh.triangles)) for mesh in (MIRROR, SCENE))
    for mesh, plain in ((mirror, MIRROR), (scene, SCENE)):
        assert mesh.positions.dtype == np.float64 and mesh.triangles.dtype == np.int64
        same(plain, mesh)
    one, other = (reflect(VIEW, *meshes, Settings(method=method)) for meshes in ((MIRROR, SCENE), (mirror, scene)))
    assert len(one.positions) > 0
    same(one, other)


@pytest.mark.parametrize("guise", GUISES)
def test_the_same_view_in_any_guise(guise):
    placement, projection = (np.array([[0.0, 0, 1, 2], [1, 0, 0, -4], [0, 1, 0, 3], [0, 0, 0, 1]]),
                             np.array([[1.5, 0, 0.25, 0], [0, 2, 0, 0], [0, 0, -1, -0.125], [0, 0, -1, 0]]))
    given = GUISES[guise]
    same(View(placement, projection, (64, 48)), View(given(placement), given(projection), (64, 48)))


def test_integers_and_fractions_are_coordinates():
    same(TriangleMesh(np.round(POSITIONS), TRIANGLES), TriangleMesh(np.round(POSITIONS).astype(np.int8), TRIANGLES))
    exact = [[Fraction(x) for x in place] for place in POSITIONS]
    same(MIRROR, TriangleMesh(exact, TRIANGLES))


@pytest.mark.parametrize("guise", [guise for guise in GUISES if guise != "tuple"])
def test_normals_and_pairs_in_any_guise(guise):
    given = GUISES[guise]
    normals = np.array([[[0, 0, 1], [0.5, 0, 1], [0, 0.25, 1]]] * 2)
    same(TriangleMesh(POSITIONS, TRIANGLES, normals), TriangleMesh(POSITIONS, TRIANGLES, given(normals)))
    vertices, rays = np.array([[[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]]), np.array([[[0.0, 0, 1], [0, 0, 1], [0, 0, 1]]])
    points = np.array([[0.25, 0.25, 2.0]])
    found = project(vertices, rays, points)
    assert found.pair.tolist() == [0]
    same(found, project(given(vertices), given(rays), given(points)))


def test_nothing_is_a_mesh():
    for positions in ([], np.zeros((0, 3)), POSITIONS):
        for triangles in ([], np.zeros((0, 3)), np.zeros((0, 3), dtype=np.uint8)):
            for normals in (None, [], np.zeros((0, 3, 3))):
                mesh = TriangleMesh(positions, triangles, normals)
                assert mesh.triangles.shape == (0, 3) and mesh.corner_normals.shape == (0, 3, 3)
                assert mesh.positions.shape == (len(positions), 3)
    assert not len(SceneTree.build(mesh)) and len(PointTree.build(mesh)) == 4


def test_meshes_are_joined_however_they_come():
    assert TriangleMesh.joined([]).positions.shape == (0, 3)
    assert TriangleMesh.joined([MIRROR]) is MIRROR
    same(TriangleMesh.joined([MIRROR, SCENE]), TriangleMesh.joined(iter((MIRROR, SCENE))))
    same(MIRROR, TriangleMesh.joined((TriangleMesh([], []), MIRROR)))


@pytest.mark.parametrize(("wide", "plain"), [
    ({"tolerance": np.float32(0.5)}, {"tolerance": 0.5}), ({"tolerance": np.array(0.5)}, {"tolerance": 0.5}),
    ({"tolerance": 2}, {"tolerance": 2.0}), ({"tolerance": np.uint8(2)}, {"tolerance": 2.0}),
    ({"tolerance": Fraction(1, 4)}, {"tolerance": 0.25}), ({"depth": np.int8(2)}, {"depth": 2}),
    ({"depth": np.array(3)}, {"depth": 3}), ({"maximum_faces": np.uint64(7)}, {"maximum_faces": 7}),
    ({"placement": np.str_("VIRTUAL")}, {"placement": "VIRTUAL"}), ({"maximum_memory": INF}, {"maximum_memory": INF}),
    ({"maximum_memory": np.float16(4)}, {"maximum_memory": 4.0})])
def test_settings_take_numbers_of_any_kind(wide, plain):
    assert Settings(**wide) == Settings(**plain)
    (name, value), = plain.items()
    assert type(getattr(Settings(**wide), name)) is type(value)


def test_more_bounces_than_there_are_cost_nothing():
    plain = reflect(VIEW, MIRROR, SCENE, Settings(depth=2))
    for depth in (10 ** 6, 2 ** 62):
        same(plain, reflect(VIEW, MIRROR, SCENE, Settings(depth=depth, maximum_faces=2 ** 62)))


@pytest.mark.parametrize(("settings", "kind"), [(Settings(), PointTree), (Settings(method="POINTS"), SceneTree)])
def test_a_tree_of_the_other_kind_serves(settings, kind):
    same(reflect(VIEW, MIRROR, SCENE, settings), reflect(VIEW, MIRROR, kind.build(SCENE), settings))


def test_an_unused_vertex_may_be_anything():
    for value in (NAN, INF, 1e308):
        loose = [TriangleMesh(np.concatenate((mesh.positions, [[value, 0.0, -value]])), mesh.triangles)
                 for mesh in (MIRROR, SCENE)]
        for method in ("GENERAL", "POINTS"):
            with warnings.catch_warnings():
                warnings.simplefilter("error")
                mesh = reflect(VIEW, *loose, Settings(method=method))
            same(mesh, reflect(VIEW, MIRROR, SCENE, Settings(method=method)))


@pytest.mark.parametrize("size", [1e300, 1e155, 1e-155, 1e-300, 5e-324])
def test_normals_of_any_length_tell_their_direction(size):
    normals = np.array([[[1.0, 0.0, 2.0], [-3.0, 1.0, 2.0], [0.0, 0.0, 1.0]]] * 2)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mesh = TriangleMesh(POSITIONS, TRIANGLES, normals * size)
    expected = normals / np.linalg.norm(normals, axis=2, keepdims=True)
    np.testing.assert_allclose(mesh.corner_normals, expected, rtol=1e-15 if size > 1e-320 else 0, atol=1e-15)


@pytest.mark.thorough
@pytest.mark.parametrize("method", ["GENERAL", "PARALLEL", "POINTS"])
@pytest.mark.parametrize("size", [1e-300, 1e-100, 1e-60, 1e-40, 1e38])
@pytest.mark.parametrize("part", ["scene", "mirror", "all"])
def test_very_large_and_very_small_meshes(part, size, method):
    mirror, scene = (TriangleMesh(mesh.positions * (size if part in (name, "all") else 1.0), mesh.triangles)
                     for name, mesh in (("mirror", MIRROR), ("scene", SCENE)))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            view = looking(eye=np.array((0, -4, 3)) * (size if part == "all" else 1.0))
            mesh = reflect(view, mirror, scene, Settings(method=method))
        except ReflectionError as error:
            assert re.match(r"^[A-Z][^.!?\n]*\.$", str(error))
            return
    for field in fields(mesh):
        values = getattr(mesh, field.name)
        assert not isinstance(values, np.ndarray) or np.isfinite(values).all()


def test_the_largest_picture_is_blenders():
    for resolution in ((65536, 65536), (1, 65536), np.array([64, 48]), [np.uint16(64), 48]):
        view = replace(VIEW, resolution=resolution)
        assert view.resolution == tuple(resolution) and type(view.resolution[0]) is int
        mesh = reflect(view, MIRROR, SCENE, Settings(maximum_faces=10_000))
        assert np.isfinite(mesh.positions).all()


def test_up_that_does_not_tell_is_replaced():
    for eye in np.concatenate((np.eye(3), -np.eye(3))):
        for up in ((0, 0, 0), eye, -1e30 * eye, 1e-300 * eye, (0, 0, 1), (0, 1e-40, 0)):
            axes = looking(eye=3.0 * eye, up=up).camera_to_world[:3, :3]
            np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-15)
            np.testing.assert_array_equal(axes[:, 2], eye)


def test_lengths_do_not_matter_to_a_direction():
    plain = looking(eye=(1.0, -4.0, 3.0), up=(0.25, 0.5, 1.0))
    for size in (2.0 ** -100, 2.0 ** 100):
        same(plain, looking(eye=(1.0, -4.0, 3.0), up=np.array((0.25, 0.5, 1.0)) * size))
        scaled = looking(eye=np.array((1.0, -4.0, 3.0)) * size, up=(0.25, 0.5, 1.0))
        np.testing.assert_array_equal(plain.camera_to_world[:3, :3], scaled.camera_to_world[:3, :3])


AXES = {
    "mirrored": np.diag((-1.0, 1.0, 1.0)), "turned inside out": -np.eye(3),
    "sheared picture": np.array([[1.0, 0.4, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    "sheared depth": np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.5, 0.2, 1.0]]),
}


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere_ico", "sphere_ortho", "bowl"])
@pytest.mark.parametrize("kind", AXES)
def test_mirrored_and_sheared_cameras_are_right(kind, name, monkeypatch):
    """As Blender leaves them: with columns of unit length, at any angles."""
    case = SCENES[name]((160, 160))
    placement = case.view.camera_to_world.copy()
    if kind == "turned inside out":
        placement[:3, :2] *= -1.0  # the eye still looks where it did
    else:
        placement[:3, :3] = placement[:3, :3] @ AXES[kind]
        placement[:3, :3] /= np.linalg.norm(placement[:3, :3], axis=0)
    view = View(placement, case.view.projection, (160, 160))
    mesh = reflect(view, case.mirror, case.scene)
    # the judges tell depths by the direction in which the eye looks, which is not across a sheared eye's plane
    across = -np.linalg.inv(placement[:3, :3])[2]
    if not view.orthographic:
        monkeypatch.setattr(View, "forward", property(lambda self: across))
    found = judge(view, case.mirror, case.scene, mesh, trace(view, case.mirror, case.scene))
    # measured: up to 0.28 pixels, and 0.065 %, four pixels
    assert found["compared"] > 3000 and found["p99"] < 0.45 and found["uncovered"] < 0.1


@pytest.mark.parametrize("name", ["sphere_ico", "sphere_ortho"])
def test_matrices_in_single_precision_pass(name):
    case = SCENES[name]((64, 64))
    matrices = [getattr(case.view, field).astype(np.float32) for field in ("camera_to_world", "projection")]
    view = View(*matrices, (64, 64))
    assert len(reflect(view, case.mirror, case.scene).triangles) > 100
    for angle in np.arange(200, dtype=np.float32):  # rounding of many turns
        c, s = np.cos(angle), np.sin(angle)
        matrices[0][:3, :3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]], dtype=np.float32) @ matrices[0][:3, :3]
    View(*matrices, (64, 64))
