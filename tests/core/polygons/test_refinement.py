"""Refinement: a smaller tolerance gives less error, flat things stay whole, and bounds are kept."""
import numpy as np
import pytest

from core import SceneTree, Settings, reflect
from core.cameras.camera_splitting import in_picture, split_cameras
from core.cameras.mirror_map import MirrorMap
from core.cameras.mirror_refinement import refine_mirror
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.culling.scene_and_mirrors import SceneAndMirrors
from core.geometry.scene_frames import SceneFrames
from core.polygons.covering import Overlaps
from core.polygons.outline_refinement import refine_for_outlines
from core.support import BESIDE_EDGES
from core.trees.cones import Cones
from tests.oracles.judge import compare
from tests.oracles.true_map import case_of, mesh_of, true_rays, truth_of, view_rays

pytestmark = pytest.mark.slow

FAR = 10.0


def cameras_of(case):
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    return cameras.select(in_picture(cameras))


def picture_size(case, cameras):
    a, b, c = (case.view.pixels(cameras.places.T)[cameras.corners[:, k]] for k in range(3))
    return 0.5 * np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def misses(case, cameras, samples=12):
    """Ways (3, n) across the true rays by which interpolated rays miss them at the distance FAR, at random places
    inside the cameras, and the ways (2, 3, n) of the true points there for a move of one pixel right and up. None where
    normals are bent."""
    weights = np.random.default_rng(103).dirichlet((1.0, 1.0, 1.0), samples)
    places, rays = (np.einsum("wk,xnk->nwx", weights, given[:, cameras.corners]).reshape(-1, 3)
                    for given in (cameras.places, cameras.rays))
    face = np.repeat(cameras.face, samples)
    _, ray, _, bent = true_rays(case.mirror, face, *view_rays(case.view, places))

    def across(way):
        return way - (way * ray).sum(axis=1, keepdims=True) * ray
    missed = FAR * across(rays / np.linalg.norm(rays, axis=1, keepdims=True) - ray)
    pixels, motion = case.view.pixels(places), []
    for step in ((0.02, 0.0), (0.0, 0.02)):
        q, turned, *_ = true_rays(case.mirror, face, *case.view.rays(pixels + step))
        motion.append(across(q + FAR * turned - places - FAR * ray) / 0.02)
    return missed[~bent].T, np.stack(motion)[:, ~bent].transpose(0, 2, 1)


def straying(case, cameras):
    """Pixels by which the rays miss: the way across the ray over the longest way of its point for one pixel."""
    missed, motion = misses(case, cameras)
    return np.linalg.norm(missed, axis=0) / np.linalg.norm(motion, axis=1).max(axis=0)


def displaced(case, cameras):
    """Pixels by which pictures of points at the distance FAR are displaced, solved in the ways of their points for a
    pixel right and up. None where the two are the same way, as on a fold."""
    missed, (right, up) = misses(case, cameras)
    uu, uv, vv = (right * right).sum(axis=0), (right * up).sum(axis=0), (up * up).sum(axis=0)
    a, b, area = (missed * right).sum(axis=0), (missed * up).sum(axis=0), uu * vv - uv**2
    clear = area > 1e-4 * uu * vv
    moved = np.stack((vv * a - uv * b, uu * b - uv * a))[:, clear] / area[clear]
    return np.linalg.norm(moved, axis=0)


@pytest.mark.parametrize("tolerance", [1.0, 0.3, 0.1])
@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "cylinder", "torus", "bowl"])
def test_refined_cameras_stray_by_less_than_the_tolerance(name, tolerance):
    case = case_of(name)
    cameras = cameras_of(case)
    refined, _ = refine_mirror(cameras, tolerance, FAR, 1_000_000)
    before, after = straying(case, cameras), straying(case, refined)
    assert np.percentile(after, 99) < tolerance
    if name != "bowl":
        assert np.percentile(after, 99) < np.percentile(before, 99)
        assert len(refined) > len(cameras)
    assert picture_size(case, refined).sum() == pytest.approx(picture_size(case, cameras).sum(), rel=0.02)


@pytest.mark.parametrize("name", ["torus", "bowl", "water"])
def test_what_is_bent_one_way_alone_strays_little_beside_its_edges(name):
    case = case_of(name)
    refined, _ = refine_mirror(cameras_of(case), 0.4, FAR, 1_000_000)
    assert np.percentile(displaced(case, refined), 99.9) < 1.1 * BESIDE_EDGES * 0.4


@pytest.mark.parametrize("name", ["flat", "flat_ortho"])
def test_a_flat_mirror_stays_whole_at_any_tolerance(name):
    case = case_of(name)
    cameras = cameras_of(case)
    refined, limited = refine_mirror(cameras, 1e-6, FAR, 1_000_000)
    assert len(refined) == len(cameras) == 2
    assert not limited


def test_the_count_of_cameras_is_bounded_and_told():
    case = case_of("sphere")
    cameras = cameras_of(case)
    refined, limited = refine_mirror(cameras, 1e-4, FAR, 3000)
    assert limited
    assert len(refined) < 4 * 3000


def test_split_cameras_lie_in_their_parents_with_true_rays_at_the_middles():
    case = case_of("sphere_ico")
    cameras = cameras_of(case)
    marked = np.random.default_rng(107).random((len(cameras), 3)) < 0.3
    parts, parent, *_ = split_cameras(cameras, marked)
    np.testing.assert_array_equal(parts.face, cameras.face[parent])
    covered = np.bincount(parent, weights=picture_size(case, parts), minlength=len(cameras))
    np.testing.assert_allclose(covered, picture_size(case, cameras), rtol=1e-9, atol=1e-9)
    corner_face = np.repeat(parts.face, 3)
    places, rays = parts.places.T[parts.corners.ravel()], parts.rays.T[parts.corners.ravel()]
    origins, directions = view_rays(case.view, places)
    _, expected, _, _ = true_rays(case.mirror, corner_face, origins, directions)
    # Next to the silhouette, neighbours bend the ray of a corner that they share in two ways.
    clear = (case.mirror.face_normals()[corner_face] * directions).sum(axis=1) < -0.25
    assert clear.mean() > 0.7
    given = rays / np.linalg.norm(rays, axis=1, keepdims=True)
    np.testing.assert_allclose(given[clear], expected[clear], rtol=0, atol=1e-8)
    # Each edge in the middle of which a neighbour was split is split here too.
    edges = np.sort(np.stack([parts.corners, np.roll(parts.corners, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, uses = np.unique(edges, axis=0, return_counts=True)
    before = np.sort(np.stack([cameras.corners, np.roll(cameras.corners, -1, axis=1)], axis=2), axis=2).reshape(-1, 2)
    _, uses_before = np.unique(before, axis=0, return_counts=True)
    assert uses.max() == uses_before.max() == 2
    whole = np.sum(uses_before == 1)
    assert whole <= (uses == 1).sum() <= 2 * whole


@pytest.mark.parametrize("name", ["sphere", "bowl", "flat"])
def test_the_error_falls_with_the_tolerance_down_to_a_twentieth_of_a_pixel(name):
    case, truth = case_of(name), truth_of(name)
    errors, faces = [], []
    for tolerance in (2.0, 0.5, 0.1, 0.05):
        mesh = mesh_of(name, tolerance=tolerance)
        errors.append(compare(case.view, case.mirror, mesh, truth).numbers["p99"])
        faces.append(len(mesh.triangles))
        assert errors[-1] < tolerance
    assert (np.diff(errors) < 0.0).all()
    # with two pixels, squares of a whole pixel are shown by rays in single places, which may take a few faces more
    assert (np.diff(faces[1:]) > 0).all() and faces[0] < 1.3 * faces[1]


def test_the_bound_on_faces_is_kept_and_told():
    case = case_of("sphere")
    mesh = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.01, maximum_faces=12_000))
    free = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.05))
    assert len(free.triangles) > 20_000
    # of cameras, and of faces
    assert mesh.counts["limited"] > 0 and mesh.counts["bounded"] == 2
    assert free.counts["bounded"] == 0
    assert len(mesh.triangles) < 40_000
    assert np.isfinite(mesh.positions).all()


@pytest.mark.parametrize("name", ["sphere", "torus", "bowl"])
def test_no_edge_is_split_for_nothing(name):
    mesh = mesh_of(name, tolerance=0.5)
    pixels = case_of(name).view.pixels(mesh.mirror_position)[mesh.triangles]
    shortest = np.linalg.norm(pixels - np.roll(pixels, 1, axis=1), axis=2).min(axis=1)
    assert (shortest < 1e-4).sum() < 0.002 * len(mesh.triangles)
    assert mesh.counts["limited"] == 0


def test_the_bound_on_candidates_is_kept_and_told():
    case = case_of("sphere")
    cameras = cameras_of(case)
    tree = SceneTree.build(case.scene)
    camera, triangle, _ = tree.trace(Cones.around(cameras))
    seen, column = np.unique(triangle, return_inverse=True)
    frames, met = SceneFrames.of(tree.mesh, seen), SceneAndMirrors(tree, case.mirror)
    candidates = Overlaps.of(cameras, frames, (camera, column), met).in_sight(last=True)
    whole, _, free = refine_for_outlines(candidates, 0.25, 1_000_000, met, last=True)
    bounded, _, limited = refine_for_outlines(candidates, 0.25, 1000, met, last=True)
    assert free < limited
    assert limited > 20
    assert len(bounded) < len(whole)
