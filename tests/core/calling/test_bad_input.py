"""Input that no reflection can come of, and input that is merely ugly: one sentence or a finite mesh, nothing else."""
import warnings
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from core import METHODS, PLACEMENTS, ReflectionError, SceneTree, Settings, TriangleMesh, View, reflect
from tests.inputs import shapes
from tests.oracles.true_map import case_of

pytestmark = pytest.mark.slow

SENTENCE = r"^[A-Z][^.!?]*\.$"
VIEW = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.5), (160, 120))
PLATE = shapes.combine(shapes.quad((0.0, 1.0, 0.5), (1.5, 0.2, 0.0), (0.0, 0.0, 1.2)))
BALL = shapes.combine(shapes.icosphere((0.0, 0.0, 0.5), 0.8, 2))
BOX = shapes.combine(shapes.box((0.6, -1.6, 0.3), (0.5, 0.5, 0.6), 0.4),
                     shapes.quad((0.0, 0.0, -0.4), (5.0, 0.0, 0.0), (0.0, 5.0, 0.0)))
EMPTY = TriangleMesh(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))


def assert_sane(mesh, mirror, scene):
    for field in fields(mesh):
        values = getattr(mesh, field.name)
        if isinstance(values, np.ndarray):
            assert np.isfinite(values).all(), field.name
    assert np.isfinite(mesh.estimated_error)
    if mesh.discs is not None:
        assert all(np.isfinite(getattr(mesh.discs, field.name)).all() for field in fields(mesh.discs))
        assert (mesh.discs.radius > 0.0).all() and len(mesh.discs.radius) == len(mesh.positions)
    if len(mesh.triangles):
        assert mesh.triangles.min() >= 0 and mesh.triangles.max() < len(mesh.positions)
        assert mesh.source_face.max() < len(scene.triangles)
        assert mesh.mirror_face.max() < len(mirror.triangles)
        assert mesh.path_length.min() >= 0.0


def reflected(mirror, scene, view=VIEW, **options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        mesh = reflect(view, mirror, scene, Settings(**options))
    assert_sane(mesh, mirror, scene)
    return mesh


def refused(mirror, scene, view=VIEW):
    with pytest.raises(ReflectionError, match=SENTENCE):
        reflect(view, mirror, scene)


def test_a_mirror_or_a_scene_without_faces_is_refused():
    refused(EMPTY, BOX)
    refused(PLATE, EMPTY)
    refused(PLATE, TriangleMesh(np.ones((5, 3)), np.zeros((0, 3), dtype=np.int64)))


def test_a_tree_of_nothing_is_refused():
    with pytest.raises(ValueError, match=SENTENCE):
        reflect(VIEW, PLATE, SceneTree.build(EMPTY))


def test_faces_without_area_alone_are_refused():
    line = TriangleMesh(np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]]), [[0, 1, 2], [0, 0, 1]])
    refused(line, BOX)
    refused(PLATE, line)


@pytest.mark.parametrize("orthographic_scale", [0.0, 6.0])
def test_the_eye_on_the_mirror_is_refused_only_where_it_is(orthographic_scale):
    view = View.looking_at((0.0, 1.0, 0.5), (0.0, -3.0, 0.5), (64, 64), orthographic_scale=orthographic_scale)
    if orthographic_scale:
        assert_sane(reflect(VIEW, PLATE, BOX), PLATE, BOX)
        return
    with pytest.raises(ReflectionError, match=SENTENCE):
        reflect(view, PLATE, BOX)
    corner, right, up = PLATE.positions[0], *(PLATE.positions[[1, 3]] - PLATE.positions[0])
    for across, along in ((0.2, 0.7), (0.9, 0.3), (0.5, 0.0)):
        eye = corner + across * right + along * up
        refused(PLATE, BOX, View.looking_at(eye, (0.0, -3.0, 0.5), (64, 64)))
    # In its plane beside it is no place on it.
    beside = View.looking_at(PLATE.positions[1] + [3.0, 0.4, 1.0], (0.0, -3.0, 0.5), (64, 64))
    with pytest.raises(ReflectionError, match="view"):
        reflect(beside, PLATE, BOX)


def test_a_mirror_behind_the_eye_or_out_of_the_picture_is_refused():
    refused(PLATE, BOX, View.looking_at((0.3, -5.0, 1.5), (0.0, -9.0, 1.5), (64, 64)))
    refused(PLATE, BOX, View.looking_at((0.3, -5.0, 1.5), (40.0, 0.0, 1.5), (64, 64)))


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_numbers_that_are_not_finite_are_refused(value):
    positions = PLATE.positions.copy()
    positions[2, 1] = value
    with pytest.raises(ValueError, match=SENTENCE):
        TriangleMesh(positions, PLATE.triangles)
    normals = PLATE.corner_normals.copy()
    normals[0, 1, 2] = value
    with pytest.raises(ValueError, match=SENTENCE):
        TriangleMesh(PLATE.positions, PLATE.triangles, normals)
    matrix = VIEW.camera_to_world.copy()
    matrix[0, 3] = value
    with pytest.raises(ValueError, match="finite"):
        View(matrix, VIEW.projection, VIEW.resolution)
    # A vertex that no triangle uses may be anything.
    loose = TriangleMesh(np.concatenate([BOX.positions, [[value, 0.0, 0.0]]]), BOX.triangles)
    assert len(reflected(PLATE, loose).triangles) == len(reflected(PLATE, BOX).triangles)


def test_a_scene_that_the_mirror_does_not_show_gives_an_empty_mesh():
    behind = shapes.combine(shapes.box((0.0, 4.0, 0.5), (0.5, 0.5, 0.5)))
    aside = shapes.combine(shapes.box((90.0, 0.0, 0.5), (0.5, 0.5, 0.5)))
    for scene in (behind, aside):
        for placement in PLACEMENTS:
            mesh = reflected(PLATE, scene, placement=placement)
            assert mesh.triangles.shape == (0, 3)
            assert mesh.positions.shape == (0, 3)
            assert mesh.source_weights.shape == (0, 3, 3)


def with_junk(mesh):
    """Faces without an area, faces twice, and a fan of three faces at one edge, mixed in."""
    a = mesh.triangles[0]
    extra = np.array([[a[0], a[0], a[1]], [a[2], a[2], a[2]], a, a[::-1]])
    points = np.concatenate([mesh.positions, [mesh.positions[a].mean(axis=0) + 0.05]])
    top = len(mesh.positions)
    fan = np.array([[a[0], a[1], top], [a[0], a[1], a[2]], [a[1], a[0], top]])
    return TriangleMesh(points, np.concatenate([extra[:2], mesh.triangles, extra[2:], fan]))


UGLY = {
    "zero_area_duplicates_and_fans": lambda mesh: with_junk(mesh),
    "zero_normals": lambda mesh: TriangleMesh(mesh.positions, mesh.triangles, np.zeros_like(mesh.corner_normals)),
    "inside_out": lambda mesh: TriangleMesh(mesh.positions, mesh.triangles, -mesh.corner_normals),
    "turned": lambda mesh: TriangleMesh(mesh.positions, mesh.triangles[:, ::-1], mesh.corner_normals[:, ::-1]),
    "half_turned": lambda mesh: TriangleMesh(
        mesh.positions, np.where(np.arange(len(mesh.triangles))[:, None] % 2, mesh.triangles[:, ::-1], mesh.triangles)),
    "random_normals": lambda mesh: TriangleMesh(
        mesh.positions, mesh.triangles, np.random.default_rng(5).normal(size=mesh.corner_normals.shape)),
    "sideways_normals": lambda mesh: TriangleMesh(
        mesh.positions, mesh.triangles, np.broadcast_to([1.0, 0.0, 0.0], mesh.corner_normals.shape)),
    "long_normals": lambda mesh: TriangleMesh(mesh.positions, mesh.triangles, 1e8 * mesh.corner_normals),
    "twice": lambda mesh: TriangleMesh(mesh.positions, np.concatenate([mesh.triangles, mesh.triangles]),
                                       np.concatenate([mesh.corner_normals, mesh.corner_normals])),
    "one_triangle": lambda mesh: TriangleMesh(mesh.positions, mesh.triangles[:1]),
    "all_vertices_apart": lambda mesh: TriangleMesh(mesh.positions[mesh.triangles].reshape(-1, 3),
                                                    np.arange(3 * len(mesh.triangles)).reshape(-1, 3),
                                                    mesh.corner_normals),
}


@pytest.mark.parametrize("kind", UGLY)
def test_ugly_mirrors_in_mirrors_give_a_finite_mesh(kind):
    view = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.5), (80, 60))
    mirrors = TriangleMesh.joined([UGLY[kind](BALL), PLATE])
    for method in ("GENERAL", "PARALLEL"):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            mesh = reflect(view, mirrors, BOX, Settings(method=method, depth=2))
        assert_sane(mesh, mirrors, BOX)
        assert mesh.bounces.max(initial=1) <= 2


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("ball", [False, True])
@pytest.mark.parametrize("kind", UGLY)
def test_ugly_mirrors_and_scenes_give_a_finite_mesh(kind, ball, orthographic):
    view = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.5), (160, 120), orthographic_scale=4.0 * orthographic)
    mirror = BALL if ball else PLATE
    for method in METHODS:
        mesh = reflected(UGLY[kind](mirror), BOX, view, method=method)
        if kind not in ("random_normals", "sideways_normals", "one_triangle"):
            # facets of a ball may show none of a box's few vertices
            assert method == "POINTS" or len(mesh.triangles) > 10
        mesh = reflected(mirror, UGLY[kind](BOX), view, method=method)
        # The first triangle of the box alone is turned away.
        assert len(mesh.positions if method == "POINTS" else mesh.triangles) > 0 or kind == "one_triangle"


def test_turning_triangles_and_normals_round_changes_nothing_on_a_mirror():
    # Mirrors are two-sided, and the sign of a normal does not matter to a reflection.
    plain = shown_parts(reflected(PLATE, BOX))
    assert plain.sum() > 5.0
    for kind in ("inside_out", "turned", "half_turned", "zero_normals", "long_normals", "all_vertices_apart"):
        np.testing.assert_allclose(shown_parts(reflected(UGLY[kind](PLATE), BOX)), plain, rtol=0, atol=1e-9)


def shown_parts(mesh):
    """Which part of each triangle of the box is seen, by the areas in its own weights."""
    u, v = mesh.source_weights[:, 1] - mesh.source_weights[:, 0], mesh.source_weights[:, 2] - mesh.source_weights[:, 0]
    return np.bincount(mesh.source_face, np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]), len(BOX.triangles))


@pytest.mark.parametrize("mirror", [PLATE, BALL], ids=["plate", "ball"])
def test_a_scene_that_is_the_mirror_or_cuts_it_gives_a_finite_mesh(mirror):
    reflected(mirror, mirror)
    wall = shapes.combine(shapes.quad((0.0, 0.0, 0.5), (0.0, 3.0, 0.3), (0.0, 0.0, 2.0)))
    assert len(reflected(mirror, wall).triangles) > 0
    assert len(reflected(wall, mirror).triangles) > 0


@pytest.mark.parametrize("ratio", [1e6, 1e-6])
@pytest.mark.parametrize("ball", [False, True])
def test_a_million_times_larger_or_smaller_scene_gives_a_finite_mesh(ratio, ball):
    mirror = BALL if ball else PLATE
    scene = TriangleMesh(BOX.positions * ratio + [0.0, -1.5, 0.4], BOX.triangles)
    reflected(mirror, scene)
    # And a mirror as much smaller or larger than its scene.
    eye = np.array([0.0, 0.0, 0.5]) + ratio * np.array([0.3, -5.0, 1.0])
    view = View.looking_at(eye, (0.0, 0.0, 0.5), (160, 120))
    middle = np.array([0.0, 0.0, 0.5])
    reflected(TriangleMesh((mirror.positions - middle) * ratio + middle, mirror.triangles), BOX, view)


def test_one_pixel_and_long_thin_pictures_work():
    for resolution in ((1, 1), (2000, 1), (3, 700)):
        view = View(VIEW.camera_to_world, VIEW.projection, resolution)
        reflected(BALL, BOX, view)


def test_an_eye_inside_a_closed_mirror_sees_its_inner_side():
    view = View.looking_at((0.2, 0.1, 0.4), (0.0, 1.0, 0.5), (160, 120), field_of_view=1.2)
    inside = shapes.combine(shapes.quad((0.0, -0.3, 0.5), (0.4, 0.0, 0.0), (0.0, 0.0, 0.4)))
    assert len(reflected(BALL, inside, view).triangles) > 20


def test_far_coordinates_of_a_case_that_would_lose_all_digits_stay_finite():
    case = case_of("sphere", 128).moved("far", np.full(3, 1e9))
    reflected(case.mirror, case.scene, case.view)


coordinate = st.one_of(st.integers(-2, 2).map(float), st.floats(-2.0, 2.0, width=32))
point = st.tuples(coordinate, coordinate, coordinate)


@st.composite
def meshes(draw):
    count = draw(st.integers(3, 7))
    positions = np.array([draw(point) for _ in range(count)])
    corner = st.integers(0, count - 1)
    triangles = [[draw(corner) for _ in range(3)] for _ in range(draw(st.integers(1, 4)))]
    normals = None
    if draw(st.booleans()):
        normals = np.array([[draw(point) for _ in range(3)] for _ in triangles])
    return TriangleMesh(positions, triangles, normals)


@settings(max_examples=150, derandomize=True, deadline=None, suppress_health_check=list(HealthCheck), database=None)
@given(meshes(), meshes(), point, st.booleans(), st.sampled_from(PLACEMENTS), st.sampled_from(METHODS))
def test_any_small_meshes_give_a_finite_mesh_or_one_sentence(mirror, scene, eye, orthographic, placement, method):
    eye = np.array(eye) * 2.0
    if np.linalg.norm(eye) < 0.1:
        eye = np.array([0.0, -4.0, 1.0])
    view = View.looking_at(eye, (0.0, 0.0, 0.0), (48, 32), field_of_view=1.2, orthographic_scale=5.0 * orthographic)
    try:
        # A tenth of a million faces is more than any of these needs.
        mesh = reflect(view, mirror, scene, Settings(placement=placement, method=method, maximum_faces=20_000))
    except ReflectionError as error:
        assert str(error).endswith(".") and str(error).count(".") == 1
        return
    assert_sane(mesh, mirror, scene)
