"""Placement: the picture stays, and nearer paths lie nearer to the eye, in single precision too."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.raster import rasterise
from tests.oracles.ray_hits import plane_hits
from tests.oracles.true_map import case_of, mesh_of

pytestmark = pytest.mark.slow


def rounded(mesh, case):
    middle = case.mirror.positions.mean(axis=0)
    return (mesh.positions - middle).astype(np.float32).astype(np.float64) + middle


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL", "SURFACE"])
@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "sphere_shift", "sphere_far", "flat", "flat_ortho", "bowl"])
def test_every_vertex_stays_on_its_view_ray(name, placement):
    case, mesh = case_of(name), mesh_of(name, placement=placement)
    rounding = 1e-7 if name == "sphere_far" else 1e-9
    np.testing.assert_allclose(case.view.pixels(mesh.positions), case.view.pixels(mesh.mirror_position), rtol=0,
                               atol=rounding)


@pytest.mark.parametrize("name", SCENES)
def test_layers_lie_a_little_before_the_mirror(name):
    case, mesh = case_of(name), mesh_of(name)
    nearer = case.view.depths(mesh.mirror_position) - case.view.depths(mesh.positions)
    size = np.ptp(case.mirror.positions, axis=0).max()
    assert nearer.min() >= -1e-12 * size * (1e4 if name == "sphere_far" else 1.0)
    assert (nearer > 1e-5 * size).mean() > 0.98
    assert nearer.max() < 0.05 * size


@pytest.mark.parametrize("name", SCENES)
def test_a_shorter_path_from_one_place_is_drawn_nearer(name):
    case, mesh = case_of(name), mesh_of(name)
    depth = case.view.depths(mesh.mirror_position)
    slide = (depth - case.view.depths(mesh.positions)) / (1.0 if case.view.orthographic else depth)
    # In a perspective the virtual depth decides, which is the path over the viewing distance.
    path = mesh.path_length / (1.0 if case.view.orthographic else np.linalg.norm(
        mesh.mirror_position - case.view.eye, axis=1))
    # Next to the place where mirror and scene touch, less room is left.
    far = path > 0.03 * (np.ptp(mesh.mirror_position, axis=0).max() if case.view.orthographic else 1.0)
    assert far.mean() > 0.8
    rise = np.diff(slide[far][np.argsort(path[far])])
    assert (rise > 1e-6 * slide.max()).mean() < 0.03
    ranks = [np.argsort(np.argsort(values[far])) for values in (path, slide)]
    assert np.corrcoef(*ranks)[0, 1] < -0.9


@pytest.mark.parametrize("name", ["flat", "flat_ortho", "sphere", "sphere_ortho", "cylinder"])
def test_where_layers_overlap_the_pixel_shows_the_shortest_path_in_single_precision(name):
    case, mesh = case_of(name), mesh_of(name)
    shown = rasterise(case.view, rounded(mesh, case), mesh.triangles)
    # Path length, and the depth of the mirror: what lies on a hidden part of it is hidden whatever its path.
    values = np.stack((mesh.path_length, case.view.depths(mesh.mirror_position)), axis=1)
    path, depth = shown.interpolate(np.column_stack((values, values[:, 0])), mesh.triangles)[:, :2].T
    # Every face on its own, so that no depth order is asked for.
    width = case.view.resolution[0]
    pixels = case.view.pixels(mesh.positions)[mesh.triangles]
    wide = np.flatnonzero(np.ptp(pixels, axis=1).max(axis=1) > 4.0)
    found = []
    for face in wide[:: max(1, len(wide) // 800)]:
        low, high = np.ceil(pixels[face].min(axis=0) - 0.5), np.floor(pixels[face].max(axis=0) - 0.5)
        low, high = np.maximum(low, 0).astype(int), np.minimum(high, np.array(case.view.resolution) - 1).astype(int)
        x, y = (grid.ravel() for grid in np.meshgrid(np.arange(low[0], high[0] + 1), np.arange(low[1], high[1] + 1)))
        if not len(x):
            continue
        one = TriangleMesh(mesh.positions[mesh.triangles[face]], [[0, 1, 2]])
        _, weights = plane_hits(one, np.zeros(len(x), dtype=np.int64), *case.view.rays(np.stack([x, y], axis=1) + 0.5))
        inside = weights.min(axis=1) > 1e-3
        found.append(np.column_stack(((y * width + x)[inside], weights[inside] @ values[mesh.triangles[face]])))
    pixel, face_path, face_depth = np.concatenate(found).T
    pixel = pixel.astype(int)
    assert (shown.triangle[pixel] >= 0).all()
    nearer = np.ptp(case.mirror.positions, axis=0).max() * 0.05
    assert (depth[pixel] < face_depth + nearer).all()
    on_it = face_depth < depth[pixel] + nearer
    shortest = np.full(len(path), np.inf)
    np.minimum.at(shortest, pixel[on_it], face_path[on_it])
    seen = np.isfinite(shortest)
    assert seen.sum() > 300
    # Path lengths curve between vertices, within faces by far less than from layer to layer.
    assert (path[seen] < shortest[seen] + 0.02 * shortest[seen] + 0.02).mean() > 0.99


@pytest.mark.parametrize("orthographic", [False, True])
def test_two_sheets_a_thousandth_apart_keep_their_order(orthographic):
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    sheets = [shapes.quad((0.0, -1.0 - gap, 0.0), (0.0, 0.0, 0.5), (0.5, 0.0, 0.0)) for gap in (0.001, 0.0)]
    view = View.looking_at((0.6, -6.0, 0.9), (0.0, 0.0, 0.0), (200, 200), field_of_view=0.5,
                           orthographic_scale=2.6 if orthographic else 0.0)
    mesh = reflect(view, mirror, shapes.combine(*sheets), Settings())
    shown = rasterise(view, mesh.positions.astype(np.float32).astype(np.float64), mesh.triangles)
    source = mesh.source_face[shown.triangle[shown.triangle >= 0]]
    assert len(source) > 500
    near, far = (source >= 2).sum(), (source < 2).sum()
    # Of the farther sheet no more shows than its rim beside the nearer one.
    assert far < 0.02 * near


def test_virtual_images_lie_at_the_depth_of_the_path():
    for name in ("sphere", "sphere_ortho", "bowl"):
        case, mesh = case_of(name), mesh_of(name, placement="VIRTUAL")
        behind = np.linalg.norm(mesh.positions - mesh.mirror_position, axis=1)
        assert (case.view.depths(mesh.positions) >= case.view.depths(mesh.mirror_position) - 1e-12).all()
        assert (np.abs(behind - mesh.path_length) < 1e-9).mean() > 0.9
