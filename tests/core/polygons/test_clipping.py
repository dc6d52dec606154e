"""Polygons of cameras against points tried one by one: inside the polygon is where all sides are positive."""
import numpy as np
import pytest

from core import TriangleMesh, View
from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.culling.candidates import Candidates, overlapping
from core.geometry.scene_frames import SceneFrames
from core.polygons.clipping import clip
from core.polygons.convex_polygons import Line
from tests.inputs import shapes
from tests.oracles.true_map import case_of


def random_candidates(rng, count, contact):
    sides = rng.normal(size=(3, 3, count)) + 0.4
    ahead = rng.normal(size=(3, count)) if contact else rng.uniform(0.1, 1.0, (3, count))
    return Candidates(None, None, np.arange(count), np.arange(count), sides, ahead, np.zeros((3, 3, count)),
                      np.ones((3, count), dtype=bool))


def inside_polygon(corners, points):
    """Whether points (n, 2) lie in the convex polygon `corners` (k, 2), either way round."""
    following = np.roll(corners, -1, axis=0)
    edge, offset = following - corners, points[:, None] - corners
    turn = edge[:, 0] * offset[..., 1] - edge[:, 1] * offset[..., 0]
    return (turn >= -1e-12).all(axis=1) | (turn <= 1e-12).all(axis=1)


def areas(polygons):
    """Areas of the polygons as parts of their cameras' triangles, signed."""
    u, v = polygons.weights[0], polygons.weights[1]
    after = np.arange(1, len(u) + 1)
    after[polygons.start[1:] - 1] = polygons.start[:-1]
    return np.add.reduceat(u * v[after] - v * u[after], polygons.start[:-1])


@pytest.mark.parametrize("contact", [False, True])
def test_polygons_hold_exactly_the_places_where_all_sides_are_positive(contact):
    rng = np.random.default_rng(89)
    candidates = random_candidates(rng, 300, contact)
    polygons = clip(candidates)
    weights = rng.dirichlet((1.0, 1.0, 1.0), 400)
    values = np.einsum("wi,jip->pwj", weights, candidates.sides)
    values = np.concatenate([values, np.einsum("wi,ip->pw", weights, candidates.ahead)[:, :, None]], axis=2)
    inside, clear = (values > 0.0).all(axis=2), np.abs(values).min(axis=2) > 1e-9
    found = np.zeros_like(inside)
    for index, pair in enumerate(polygons.pair):
        corners = polygons.weights[:2, polygons.start[index]:polygons.start[index + 1]].T
        found[pair] = inside_polygon(corners, weights[:, :2])
    assert 0.05 < inside.mean() < 0.6
    np.testing.assert_array_equal(found[clear], inside[clear])


@pytest.mark.parametrize("contact", [False, True])
def test_each_corner_lies_on_the_two_lines_that_it_names(contact):
    candidates = random_candidates(np.random.default_rng(97), 400, contact)
    polygons = clip(candidates)
    pair = np.repeat(polygons.pair, np.diff(polygons.start))
    np.testing.assert_allclose(polygons.weights.sum(axis=0), 1.0, rtol=0, atol=1e-12)
    lines = np.concatenate([np.broadcast_to(np.eye(3)[:, :, None], (3, 3, len(candidates))), candidates.sides,
                            candidates.ahead[None]])
    for label in (polygons.before, polygons.after):
        value = (lines[label, :, pair] * polygons.weights.T).sum(axis=1)
        assert np.abs(value).max() < 1e-12 * np.abs(lines).max() * 100.0
        assert set(np.unique(label)) == set(range(Line.CONTACT + 1 if contact else Line.CONTACT))
    # The line that starts at a corner ends at the next.
    following = np.arange(1, len(pair) + 1)
    following[polygons.start[1:] - 1] = polygons.start[:-1]
    np.testing.assert_array_equal(polygons.before[following], polygons.after)
    assert (np.diff(polygons.start) >= 3).all() and (np.diff(polygons.start) <= (7 if contact else 6)).all()
    assert (polygons.before != polygons.after).all()


def test_a_camera_that_sees_only_the_inside_of_a_triangle_stays_whole():
    candidates = Candidates(None, None, np.array([0]), np.array([0]), np.full((3, 3, 1), 0.3), np.ones((3, 1)),
                            np.zeros((3, 3, 1)), np.ones((3, 1), dtype=bool))
    polygons = clip(candidates)
    np.testing.assert_array_equal(polygons.weights.T, np.eye(3))
    assert (polygons.before < Line.SCENE_EDGE).all() and (polygons.after < Line.SCENE_EDGE).all()


def test_nothing_is_left_where_a_side_is_negative_everywhere():
    sides = np.full((3, 3, 2), 0.3)
    sides[1, :, 1] = -0.1
    candidates = Candidates(None, None, np.arange(2), np.arange(2), sides, np.ones((3, 2)), np.zeros((3, 3, 2)),
                            np.ones((3, 2), dtype=bool))
    polygons = clip(candidates)
    np.testing.assert_array_equal(polygons.pair, [0])
    empty = clip(candidates.select(np.array([1])))
    assert len(empty.pair) == 0 and empty.weights.shape == (3, 0)


@pytest.mark.parametrize("name", ["flat", "flat_ortho", "sphere", "sphere_ortho"])
def test_triangles_of_one_plane_that_covers_the_view_tile_every_camera(name):
    case = case_of(name)
    view, mirror = case.view, case.mirror
    # A quilt of 6 x 6 quads behind the eye, wide enough for all rays that go back far from the ball's outline.
    faces = visible_triangles(view, mirror)
    mirror_map = MirrorMap(view, mirror)
    cameras = three_ray_cameras(mirror_map, mirror, faces)
    rays = cameras.rays / np.linalg.norm(cameras.rays, axis=0)
    back = -view.forward
    cameras = cameras.select(((rays * back[:, None]).sum(axis=0) > 0.3)[cameras.corners].all(axis=1))
    assert len(cameras) >= 2
    right = view.camera_to_world[:3, 0]
    up = view.camera_to_world[:3, 1]

    def plane(u, v):
        return view.eye + 3.0 * back + u[:, None] * right + v[:, None] * up, np.tile(-back, (len(u), 1))

    quilt = shapes.sheet(plane, 6, 6, (-60.0, 60.0), (-60.0, 60.0))
    scene = TriangleMesh(quilt[0], quilt[1])
    frames = SceneFrames.of(scene, np.arange(len(scene.triangles)))
    camera, column = (index.ravel() for index in
                      np.meshgrid(np.arange(len(cameras)), np.arange(len(scene.triangles)), indexing="ij"))
    candidates = overlapping(cameras, frames, camera, column)
    polygons = clip(candidates)
    covered = np.bincount(candidates.camera[polygons.pair], weights=areas(polygons), minlength=len(cameras))
    # Sides are interpolated linearly, the same way in the triangles on either side of an edge but for their scale.
    np.testing.assert_allclose(covered, 1.0, rtol=0, atol=1e-9 if name.startswith("flat") else 0.02)
    assert areas(polygons).min() > -1e-12


def test_a_mirror_through_a_triangles_plane_is_cut_where_they_touch():
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    view = View.looking_at((0.0, -1.0, 5.0), (0.0, 0.0, 0.0), (64, 64))
    wall = TriangleMesh(np.array([[-9.0, 0.2, -9.0], [9.0, 0.2, -9.0], [0.0, 0.2, 20.0]]), [[0, 1, 2]])
    cameras = three_ray_cameras(MirrorMap(view, mirror), mirror, visible_triangles(view, mirror))
    frames = SceneFrames.of(wall, np.array([0]))
    candidates = overlapping(cameras, frames, np.arange(2), np.zeros(2, dtype=np.int64))
    polygons = clip(candidates)
    assert (polygons.after == Line.CONTACT).any()
    corners = cameras.corners[np.repeat(candidates.camera[polygons.pair], np.diff(polygons.start))]
    places = np.einsum("kn,xnk->nx", polygons.weights, cameras.places[:, corners])
    touching = (polygons.after == Line.CONTACT) | (polygons.before == Line.CONTACT)
    np.testing.assert_allclose(places[touching, 1], 0.2, rtol=0, atol=1e-12)
    # The rays lean away from the eye: the wall is seen before it, not behind.
    assert places[:, 1].max() < 0.2 + 1e-12
