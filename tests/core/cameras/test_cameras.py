"""Cameras: which triangles of a mirror get one, what they share, and where they end."""
import numpy as np
import pytest

from core import TriangleMesh, View
from core.cameras.camera_splitting import in_picture
from core.cameras.mirror_map import MirrorMap
from core.cameras.shading_horizon import cut_at_horizon
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.ray_hits import first_hits
from tests.oracles.true_map import case_of, true_rays, truth_of, view_rays


def facing(view, mirror):
    """How much each triangle is turned to the eye, by the angle of its own normal."""
    middles = mirror.positions[mirror.triangles].mean(axis=1)
    return -(mirror.face_normals() * view_rays(view, middles)[1]).sum(axis=1)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("name", ["sphere", "sphere_ico", "sphere_ortho", "torus", "sphere_far", "sphere_small"])
def test_of_a_closed_mirror_the_side_towards_the_eye_is_taken_whatever_its_winding(name, turned):
    case = case_of(name)
    mirror = case.mirror
    if turned:
        mirror = TriangleMesh(mirror.positions, mirror.triangles[:, ::-1], mirror.corner_normals[:, ::-1])
    towards = facing(case.view, case.mirror)
    chosen = np.zeros(len(towards), dtype=bool)
    chosen[visible_triangles(case.view, mirror)] = True
    np.testing.assert_array_equal(chosen[np.abs(towards) > 1e-6], (towards > 0.0)[np.abs(towards) > 1e-6])


@pytest.mark.thorough
@pytest.mark.parametrize("name", SCENES)
def test_every_triangle_that_a_pixel_shows_has_a_camera(name):
    case = case_of(name)
    shown = np.unique(truth_of(name).mirror_triangle)
    assert np.isin(shown[shown >= 0], visible_triangles(case.view, case.mirror)).all()


def test_open_mirrors_show_both_sides():
    case = case_of("bowl")
    chosen = visible_triangles(case.view, case.mirror)
    np.testing.assert_array_equal(chosen, np.arange(len(case.mirror.triangles)))


def test_from_inside_a_closed_mirror_its_inner_side_is_seen():
    ball = shapes.combine(shapes.icosphere((0.0, 0.0, 0.0), 2.0, 2))
    view = View.looking_at((0.5, 0.3, -0.2), (1.0, 1.0, 0.0), (64, 64))
    assert len(visible_triangles(view, ball)) == len(ball.triangles)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("kind", ["perspective", "orthographic"])
def test_of_each_body_of_one_mesh_the_side_that_hides_the_other_is_taken(kind, turned):
    """Beside each other, and a room round them, each wound as it likes: what rays meet first, and nothing behind it."""
    bodies = [shapes.icosphere((0.0, 0.0, 0.0), 0.5, 2), shapes.icosphere((0.4, 1.5, 0.3), 0.6, 2)]
    if kind == "perspective":
        bodies.append(shapes.icosphere((0.0, 0.0, 0.0), 6.0, 2))
    meshes = [shapes.combine(body) for body in bodies]
    if turned:
        meshes[0] = TriangleMesh(meshes[0].positions, meshes[0].triangles[:, ::-1])
    mirror = TriangleMesh.joined(meshes)
    view = View.looking_at((4.0, 0.3, 0.2), (0.0, 0.7, 0.1), (96, 96),
                           orthographic_scale=4.0 if kind == "orthographic" else 0.0)
    chosen = visible_triangles(view, mirror)
    origin, ray = view_rays(view, mirror.positions[mirror.triangles].mean(axis=1))
    if view.orthographic:
        origin = origin - 9.0 * ray  # before all of them
    met = np.unique(first_hits(mirror, origin, ray)[0])
    met = met[met >= 0]
    assert len(met) > 100 and np.isin(met, chosen).all()
    # of both balls less than a half
    ball = sum(len(mesh.triangles) for mesh in meshes[:2])
    assert np.count_nonzero(chosen < ball) <= ball // 2
    assert np.count_nonzero(chosen >= ball) == sum(len(mesh.triangles) for mesh in meshes[2:])


def test_triangles_without_area_and_those_seen_edge_on_have_no_camera():
    positions = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 1e-30], [2, 0, 0], [0, 0, 1.0]], dtype=float)
    mirror = TriangleMesh(positions, [[0, 1, 2], [0, 1, 4], [0, 0, 1], [3, 3, 3], [0, 5, 2]])
    view = View.looking_at((0.0, 0.3, 5.0), (0.0, 0.3, 0.0), (64, 64), up=(0.0, 1.0, 0.0))
    np.testing.assert_array_equal(visible_triangles(view, mirror), [0])


def by_place(corners):
    """Corners (n, 3, 6) of triangles, those of each in the order of their places."""
    keys = corners[:, :, :3].round(9).tolist()
    order = [sorted(range(3), key=key.__getitem__) for key in keys]
    return np.take_along_axis(corners, np.array(order)[:, :, None], axis=1)


def test_smooth_neighbours_share_corners_and_flat_ones_do_not():
    case = case_of("sphere_ico")
    view, mirror = case.view, case.mirror
    everywhere = three_ray_cameras(MirrorMap(view, mirror), mirror, np.arange(len(mirror.triangles)))
    # At the silhouette each face lifts its rays over itself, and shares none.
    faces = np.flatnonzero(~MirrorMap(view, mirror).grazing)
    assert len(mirror.positions) < everywhere.places.shape[1] < 2 * len(mirror.positions)
    smooth = three_ray_cameras(MirrorMap(view, mirror), mirror, faces)
    assert smooth.places.shape == smooth.rays.shape == (3, len(np.unique(mirror.triangles[faces])))
    flat_mirror = TriangleMesh(mirror.positions, mirror.triangles)
    flat = three_ray_cameras(MirrorMap(view, flat_mirror), flat_mirror, faces)
    assert flat.places.shape == (3, 3 * len(faces))
    for cameras, mesh in ((smooth, mirror), (flat, flat_mirror)):
        places = mesh.positions[mesh.triangles[faces]]
        normal = mesh.corner_normals[faces].reshape(-1, 3)
        direction = view.directions(places.reshape(-1, 3))
        expected = direction - 2.0 * (direction * normal).sum(axis=1, keepdims=True) * normal
        expected = np.concatenate((places, expected.reshape(-1, 3, 3)), axis=2)
        given = np.concatenate((cameras.places, cameras.rays))[:, cameras.corners].transpose(1, 2, 0)
        np.testing.assert_allclose(by_place(given), by_place(expected), rtol=0, atol=1e-13)


def test_a_parallel_camera_shares_nothing_and_has_one_ray():
    case = case_of("sphere_ico")
    faces = visible_triangles(case.view, case.mirror)
    cameras = three_ray_cameras(MirrorMap(case.view, case.mirror, parallel=True), case.mirror, faces)
    rays = cameras.rays[:, cameras.corners]
    assert cameras.rays.shape == (3, 3 * len(faces))
    np.testing.assert_array_equal(rays[:, :, 1], rays[:, :, 0])
    np.testing.assert_array_equal(rays[:, :, 2], rays[:, :, 0])


@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "torus", "cylinder"])
def test_cameras_are_cut_where_their_rays_would_begin_to_enter_the_mirror(name):
    case = case_of(name)
    mirror_map = MirrorMap(case.view, case.mirror)
    whole = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    parts = cut_at_horizon(whole)
    sizes = []
    for cameras in (whole, parts):
        a, b, c = (cameras.places.T[cameras.corners[:, k]] for k in range(3))
        sizes.append(np.linalg.norm(np.cross(b - a, c - a), axis=1))
    # The parts fill their triangles.
    given, found = (np.bincount(cameras.face, weights=size, minlength=len(case.mirror.triangles))
                    for cameras, size in zip((whole, parts), sizes))
    np.testing.assert_allclose(found, given, rtol=1e-9)
    weights = np.random.default_rng(101).dirichlet((1.0, 1.0, 1.0), 20)

    def mixed(cameras):
        places = np.einsum("wk,xnk->nwx", weights, cameras.places[:, cameras.corners]).reshape(-1, 3)
        *_, bent = true_rays(case.mirror, np.repeat(cameras.face, 20), *view_rays(case.view, places))
        bent = bent.reshape(-1, 20)
        return np.minimum(bent.mean(axis=1), 1.0 - bent.mean(axis=1))

    # Before, some cameras see the horizon inside them; after, it is their edge, but for its bend.
    before, after = (mixed(cameras) for cameras in (whole, parts))
    assert (before * sizes[0]).sum() > 0.0
    assert (after * sizes[1]).sum() < 0.1 * (before * sizes[0]).sum()
    assert len(parts) > len(whole)


@pytest.mark.thorough
@pytest.mark.parametrize("name", SCENES)
def test_cameras_in_the_picture_are_those_that_pixels_show(name):
    case = case_of(name)
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    chosen = in_picture(cameras)
    shown = np.unique(truth_of(name).mirror_triangle)
    assert chosen[np.isin(cameras.face, shown)].all()


def test_cameras_beyond_a_side_of_the_picture_or_behind_the_eye_are_left_out():
    view = View.looking_at((0.0, -5.0, 0.0), (0.0, 0.0, 0.0), (64, 64), field_of_view=0.5)
    quads = [shapes.quad(middle, (0.2, 0.0, 0.0), (0.0, 0.0, 0.2)) for middle in
             ((0.0, 0.0, 0.0), (9.0, 0.0, 0.0), (-9.0, 0.0, 0.0), (0.0, 0.0, 9.0), (0.0, 0.0, -9.0), (0.0, -10.0, 0.0))]
    mirror = shapes.combine(*quads)
    cameras = three_ray_cameras(MirrorMap(view, mirror), mirror, visible_triangles(view, mirror))
    np.testing.assert_array_equal(in_picture(cameras), [True, True] + [False] * 10)
