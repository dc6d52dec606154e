"""The judge of reflection meshes, given meshes whose faults are known."""
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

from core import ReflectionMesh, View
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.judge import HOLE, LEFT_OUT, SAME, SPILL, WRONG_LAYER, compare, judge, write_images
from tests.oracles.truth import trace

pytestmark = pytest.mark.slow

PIXEL = 2.6 / 120


def room(cells=8, orthographic=True, eye=(0.0, -5.0, 0.0), lean=0.0):
    """An upright mirror y = 0, |x|, |z| < 1, and a wall near y = -8 behind the eye whose image lies in the mirror."""
    size = 1.0 if orthographic else 2.2

    def wall(u, v):
        points = np.stack([size * (0.75 * u + 0.05), lean * u - 8.0, size * (0.65 * v - 0.3)], axis=1)
        return points, np.tile([0.0, 1.0, 0.0], (len(u), 1))

    view = View.looking_at(eye, (0.0, 0.0, 0.0), (120, 120), field_of_view=0.5,
                           orthographic_scale=2.6 if orthographic else 0.0)
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    scene = shapes.combine(shapes.sheet(wall, cells, cells))
    return view, mirror, scene, trace(view, mirror, scene)


def exact_mesh(view, scene, layered=True):
    """The wall's image behind a flat mirror, y -> -y, or its projection onto the mirror, slid towards the eye."""
    virtual = scene.positions * [1.0, -1.0, 1.0]
    back = np.broadcast_to(-view.forward, virtual.shape) if view.orthographic else view.eye - virtual
    on_mirror = virtual - (virtual[:, 1] / back[:, 1])[:, None] * back
    count = len(scene.triangles)
    return ReflectionMesh(
        positions=on_mirror + 1e-5 * back if layered else virtual, triangles=scene.triangles,
        reflected_position=scene.positions, mirror_position=on_mirror,
        path_length=np.linalg.norm(virtual - on_mirror, axis=1), image_parity=np.ones(len(virtual), dtype=np.int8),
        source_face=np.arange(count), source_weights=np.broadcast_to(np.eye(3), (count, 3, 3)),
        mirror_face=np.full(count, -1))


def traced_mesh(case):
    """A mesh with a vertex at every corner of a pixel, ray traced, where four corners see one source triangle."""
    (width, height), projection = case.view.resolution, case.view.projection.copy()
    # A picture of one pixel more each way whose centres are the corners of the pixels of this one.
    projection[:2] *= np.array([[width / (width + 1)], [height / (height + 1)]])
    found = trace(View(case.view.camera_to_world, projection, (width + 1, height + 1)), case.mirror, case.scene)
    index = np.arange((width + 1) * (height + 1)).reshape(height + 1, width + 1)
    square = np.stack([index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]], axis=-1).reshape(-1, 4)
    source = found.source_triangle[square]
    square = square[(source[:, 0] >= 0) & (source == source[:, :1]).all(axis=1)]
    triangles = np.concatenate([square[:, [0, 1, 2]], square[:, [0, 2, 3]]])
    q = found.mirror_position
    back = -case.view.forward if case.view.orthographic else (case.view.eye - q) / 6.0
    return ReflectionMesh(
        positions=q + 3e-3 * back, triangles=triangles, reflected_position=found.position, mirror_position=q,
        path_length=found.path_length, image_parity=np.zeros(len(q), dtype=np.int8),
        source_face=found.source_triangle[triangles[:, 0]],
        source_weights=np.broadcast_to(np.eye(3), (len(triangles), 3, 3)), mirror_face=np.full(len(triangles), -1))


@pytest.mark.parametrize("name", SCENES)
def test_a_mesh_with_a_traced_vertex_at_every_corner_of_a_pixel_is_nearly_the_truth(name):
    case = SCENES[name]((256, 256))
    numbers = judge(case.view, case.mirror, case.scene, traced_mesh(case))
    assert numbers["compared"] > 4000
    # What linear interpolation over one pixel leaves.
    assert numbers["median"] < 0.02
    assert numbers["p99"] < 0.2
    assert numbers["wrong_layer"] == 0.0
    assert numbers["spill"] == 0.0
    # Pixels with an edge of a source triangle in them, which the mesh leaves open.
    assert numbers["hole"] < 10.0


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("eye", [(0.0, -5.0, 0.0), (-0.3, -5.0, 0.2)])
def test_the_virtual_image_of_a_flat_mirror_is_without_fault(orthographic, eye):
    view, mirror, scene, truth = room(orthographic=orthographic, eye=eye)
    numbers = judge(view, mirror, scene, exact_mesh(view, scene, layered=False), truth, placement="VIRTUAL")
    assert numbers["compared"] > 500
    assert numbers["maximum"] < 1e-9
    assert numbers["uncovered"] == 0.0


def test_on_the_mirror_perspective_leaves_an_error_that_falls_with_the_square_of_the_faces():
    worst = []
    for cells in (4, 8, 16):
        view, mirror, scene, truth = room(cells, orthographic=False, eye=(-1.5, -5.0, 0.5), lean=2.0)
        numbers = judge(view, mirror, scene, exact_mesh(view, scene), truth)
        assert numbers["compared"] > 500
        assert numbers["uncovered"] == 0.0
        worst.append(numbers["median"])
    np.testing.assert_allclose([worst[0] / worst[1], worst[1] / worst[2]], 4.0, rtol=0.15)


def test_a_removed_face_is_a_hole_of_its_pixels():
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    gone = np.isin(mesh.source_face, (5, 40, 77))
    rest = replace(mesh, triangles=mesh.triangles[~gone], source_face=mesh.source_face[~gone])
    result = compare(view, mirror, rest, truth)
    expected = np.isin(truth.source_triangle, (5, 40, 77))
    assert expected.sum() > 20
    np.testing.assert_array_equal(result.kind == HOLE, expected)
    assert result.numbers["hole"] == pytest.approx(100.0 * expected.sum() / (truth.mirror_triangle >= 0).sum())
    assert result.numbers["uncovered"] == result.numbers["hole"]
    assert result.numbers["sunk"] == 0.0
    assert result.numbers["maximum"] < 1e-6


def test_a_shifted_point_is_displaced_by_its_pixels():
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    mesh = replace(mesh, reflected_position=mesh.reflected_position + [0.0, 0.0, 3.7 * PIXEL])
    numbers = judge(view, mirror, scene, mesh, truth)
    np.testing.assert_allclose([numbers[k] for k in ("median", "p95", "p99", "maximum")], 3.7, rtol=1e-6)
    assert numbers["uncovered"] == 0.0


@pytest.mark.parametrize(("shift", "kind"), [(1.5, SAME), (2.5, WRONG_LAYER)])
def test_another_triangle_is_another_surface_when_it_is_far(shift, kind):
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    mesh = replace(mesh, reflected_position=mesh.reflected_position + [shift * PIXEL, 0.0, 0.0],
                   source_face=(mesh.source_face + 1) % len(mesh.source_face))
    result = compare(view, mirror, mesh, truth)
    seen = truth.source_triangle >= 0
    assert (result.kind[seen] == kind).all()
    assert result.numbers["compared"] == (seen.sum() if kind == SAME else 0)
    expected = 0.0 if kind == SAME else 100.0 * seen.sum() / (truth.mirror_triangle >= 0).sum()
    assert result.numbers["wrong_layer"] == pytest.approx(expected)


def test_faces_where_nothing_is_reflected_and_beyond_the_outline_are_spill():
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    # A sheet of 0.2 x 0.8 before the mirror's left edge, half on the mirror, half beyond, away from the wall's image.
    extra, faces, _ = shapes.quad((-1.0, -0.01, 0.0), (0.1, 0.0, 0.0), (0.0, 0.0, 0.4))
    mesh = replace(mesh, positions=np.concatenate([mesh.positions, extra]),
                   reflected_position=np.concatenate([mesh.reflected_position, extra]),
                   triangles=np.concatenate([mesh.triangles, faces + len(mesh.positions)]),
                   source_face=np.concatenate([mesh.source_face, [0, 0]]))
    result = compare(view, mirror, mesh, truth)
    width, height = view.resolution
    x, z = ((np.arange(size) + 0.5 - 0.5 * size) * PIXEL for size in (width, height))
    expected = ((np.abs(z) < 0.4)[:, None] & (np.abs(x + 1.0) < 0.1)).ravel()
    np.testing.assert_array_equal(result.kind == SPILL, expected)
    share = 100.0 / (truth.mirror_triangle >= 0).sum()
    assert result.numbers["spill"] == pytest.approx(share * expected.sum())
    outside = (expected.reshape(height, width) & (x < -1.0)).sum()
    assert outside > 50
    assert result.numbers["spill_outside"] == pytest.approx(share * outside)


def test_a_mesh_behind_the_mirror_is_hidden_by_it():
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene, layered=False)
    numbers = judge(view, mirror, scene, mesh, truth)
    seen = 100.0 * (truth.source_triangle >= 0).sum() / (truth.mirror_triangle >= 0).sum()
    assert numbers["hole"] == pytest.approx(seen)
    assert numbers["sunk"] == pytest.approx(seen)
    assert numbers["compared"] == 0
    assert np.isnan(numbers["median"])


def test_a_mesh_behind_the_scene_is_hidden_by_it():
    view, mirror, scene, _ = room()
    screen = shapes.quad((0.0, -1.0, 0.0), (0.3, 0.0, 0.0), (0.0, 0.0, 0.8))
    both = shapes.combine((scene.positions, scene.triangles, None), screen)
    truth = trace(view, mirror, both)
    result = compare(view, mirror, exact_mesh(view, scene), truth)
    assert (truth.source_triangle >= len(scene.triangles)).sum() == 0
    assert result.numbers["uncovered"] == 0.0
    assert 100 < result.numbers["compared"] < (room()[3].source_triangle >= 0).sum()


def test_what_the_mirror_sees_of_itself_is_left_out():
    view, mirror, scene, _ = room()
    shield = shapes.quad((0.3, -7.0, 0.0), (0.2, 0.0, 0.0), (0.0, 0.0, 0.2))
    mirror = shapes.combine((mirror.positions, mirror.triangles, None), shield)
    truth = trace(view, mirror, scene)
    empty = replace(exact_mesh(view, scene), triangles=np.zeros((0, 3), dtype=np.int64),
                    source_face=np.zeros(0, dtype=np.int64))
    result = compare(view, mirror, empty, truth)
    assert truth.sees_itself.sum() == pytest.approx(0.16 / PIXEL**2, rel=0.1)
    np.testing.assert_array_equal(result.kind == LEFT_OUT, truth.sees_itself)
    np.testing.assert_array_equal(result.kind == HOLE, (truth.source_triangle >= 0) & ~truth.sees_itself)
    counted = (truth.mirror_triangle >= 0).sum() - truth.sees_itself.sum()
    assert result.numbers["mirror_pixels"] == counted
    assert result.numbers["sees_itself"] > 1.0


def test_single_precision_rounds_about_the_mirror():
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    exact, rounded = (compare(view, mirror, mesh, truth, single_precision=single) for single in (False, True))
    shift = np.nanmax(np.abs(exact.position - rounded.position))
    assert 1e-10 < shift < 1e-6
    # measured: none; a pixel is 0.012 %
    assert rounded.numbers["uncovered"] < 0.025


def test_images_show_the_kinds_in_their_colours(tmp_path):
    view, mirror, scene, truth = room()
    mesh = exact_mesh(view, scene)
    gone = np.isin(mesh.source_face, (5, 40, 77))
    rest = replace(mesh, triangles=mesh.triangles[~gone], source_face=mesh.source_face[~gone])
    result = compare(view, mirror, rest, truth)
    paths = write_images(tmp_path / "new", "room", scene, rest, truth, result)
    assert [path.name for path in paths] == ["room_error.png", "room_kinds.png", "room_picture.png"]
    error, kinds, picture = (imread(path) for path in paths)
    assert error.shape[:2] == (120, 120)
    assert picture.shape[:2] == (120, 240)
    red = (kinds[::-1, :, 0] > 0.9) & (kinds[::-1, :, 1] < 0.3)
    np.testing.assert_array_equal(red.ravel(), result.kind == HOLE)
    differs = (picture[:, :120] != picture[:, 120:]).any(axis=2)[::-1].ravel()
    np.testing.assert_array_equal(differs, result.kind == HOLE)
