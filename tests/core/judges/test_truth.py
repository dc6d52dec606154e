"""The ray traced truth against closed forms and against every ray tried on every triangle."""
import numpy as np
import pytest

from core import TriangleMesh, View
from tests.inputs import shapes
from tests.inputs.scenes import SCENES, flat, sphere
from tests.oracles.every_pair import every_pair, pixel_centres
from tests.oracles.ray_hits import EMBREE, first_hits, plane_hits
from tests.oracles.truth import trace

pytestmark = pytest.mark.slow

ENGINES = [False, True] if EMBREE else [False]


@pytest.mark.parametrize("embree", ENGINES)
@pytest.mark.parametrize("offset", [0.0, 1e5])
@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_first_hits_agree_with_every_pair_tried(embree, offset, scale):
    rng = np.random.default_rng(3)
    corners = rng.normal(size=(60, 3)) * scale + offset
    mesh = TriangleMesh(corners, rng.permutation(60).reshape(-1, 3))
    origins = rng.normal(size=(300, 3)) * 4.0 * scale + offset
    directions = rng.normal(size=(300, 3)) * scale + offset - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    triangle, distance = first_hits(mesh, origins, directions, embree=embree)
    expected, length = every_pair(mesh, origins, directions)
    assert 50 < (expected >= 0).sum() < 250
    np.testing.assert_array_equal(triangle, expected)
    np.testing.assert_allclose(distance, length, rtol=1e-11 * (1.0 + offset / scale))


@pytest.mark.parametrize("embree", ENGINES)
def test_a_ray_that_leaves_a_convex_surface_never_meets_it(embree):
    mesh = shapes.combine(shapes.icosphere((3.0, -2.0, 1.0), 0.7, 3))
    rng = np.random.default_rng(5)
    triangle = rng.integers(0, len(mesh.triangles), 4000)
    weights = rng.dirichlet((0.3, 0.3, 0.3), 4000)
    weights[:1000, 0] = 0.0
    weights[:1000] /= weights[:1000].sum(axis=1, keepdims=True)
    q = np.einsum("nk,nkx->nx", weights, mesh.positions[mesh.triangles[triangle]])
    normal = mesh.face_normals()[triangle]
    directions = np.cross(normal, rng.normal(size=(4000, 3)))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    # Up by more than the angle to a neighbour, which a ray from the very edge would otherwise enter.
    directions = directions + 0.2 * normal
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    hit, _ = first_hits(mesh, q, directions, leaving=triangle, embree=embree)
    assert (hit == -1).all()


@pytest.mark.parametrize("embree", ENGINES)
def test_a_ray_that_leaves_along_its_triangle_meets_what_is_there(embree):
    """In single precision it begins on the triangle, a step further too."""
    half, rng = (0.622, 0.572, 0.824), np.random.default_rng(6)
    sides = [np.roll(((part, 0, 0), (0, half[(k + 1) % 3], 0), (0, 0, half[(k + 2) % 3])), k, axis=1)
             for k in range(3) for part in (-half[k], half[k])]
    box = shapes.combine(*(shapes.quad(*side) for side in sides))
    q = np.column_stack((rng.uniform(-0.5, 0.0, 2000), np.full(2000, -half[1]), rng.uniform(-0.5, 0.5, 2000)))
    directions = np.column_stack((np.full(2000, -1.0), rng.uniform(0.001, 0.1, 2000), rng.uniform(-0.4, 0.4, 2000)))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    own, _ = first_hits(box, q + (0, 0.1, 0), np.tile((0.0, -1.0, 0.0), (2000, 1)), embree=False)
    hit, distance = first_hits(box, q, directions, leaving=own, embree=embree)
    assert (hit >= 0).all() and not (hit == own).any()
    met = np.abs((q + distance[:, None] * directions) / half).max(axis=1)
    np.testing.assert_allclose(met, 1.0, atol=1e-9)


@pytest.mark.parametrize("embree", ENGINES)
@pytest.mark.parametrize("orthographic", [False, True])
def test_flat_mirror_sees_what_an_eye_behind_it_sees(embree, orthographic):
    case = flat((48, 40), orthographic=orthographic)
    truth = trace(case.view, case.mirror, case.scene, embree=embree)
    seen = truth.mirror_triangle >= 0
    origins, directions = (values[seen] for values in case.view.rays(pixel_centres(case.view)))
    normal, middle = case.mirror.face_normals()[0], case.mirror.positions.mean(axis=0)
    behind = origins - 2.0 * ((origins - middle) @ normal)[:, None] * normal
    turned = directions - 2.0 * (directions @ normal)[:, None] * normal
    # The mirrored eye looks at the scene through the mirror: only what lies on the mirror's bright side counts.
    to_mirror = ((middle - behind) @ normal) / (turned @ normal)
    start = behind + to_mirror[:, None] * turned
    np.testing.assert_allclose(truth.mirror_position[seen], start, atol=1e-12)
    expected, length = every_pair(case.scene, start, turned)
    assert 100 < (expected >= 0).sum() < len(expected)
    np.testing.assert_array_equal(truth.source_triangle[seen], expected)
    np.testing.assert_allclose(truth.path_length[seen], length, rtol=1e-11)
    hit = expected >= 0
    np.testing.assert_allclose(truth.position[seen][hit], start[hit] + length[hit, None] * turned[hit], atol=1e-11)
    assert not truth.sees_itself.any()
    assert not truth.bent.any()


def test_motion_on_a_floor_below_an_upright_mirror_is_that_of_the_mirrored_view():
    case = flat((64, 64))
    mirror, floor = case.mirror, shapes.combine(shapes.quad((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (0.0, 40.0, 0.0)))
    truth = trace(case.view, mirror, floor)
    met = np.flatnonzero(truth.source_triangle >= 0)
    normal, middle = mirror.face_normals()[0], mirror.positions.mean(axis=0)

    def floor_point(pixels):
        origins, directions = case.view.rays(pixels)
        origins = origins - 2.0 * ((origins - middle) @ normal)[:, None] * normal
        directions = directions - 2.0 * (directions @ normal)[:, None] * normal
        return origins - (origins[:, 2] / directions[:, 2])[:, None] * directions

    centres = pixel_centres(case.view)[met]
    right = floor_point(centres + [0.5, 0.0]) - floor_point(centres - [0.5, 0.0])
    up = floor_point(centres + [0.0, 0.5]) - floor_point(centres - [0.0, 0.5])
    ahead = directions_point_down(case.view, centres + [0.0, 0.5])
    assert ahead.sum() > 200
    np.testing.assert_allclose(truth.jacobian[met][ahead], np.stack([right, up], axis=2)[ahead], rtol=1e-9, atol=1e-9)
    longest = np.maximum(np.linalg.norm(right, axis=1), np.linalg.norm(up, axis=1))
    np.testing.assert_allclose(truth.motion[met][ahead], longest[ahead], rtol=1e-9)


def directions_point_down(view, pixels):
    return view.rays(pixels)[1][:, 2] < -1e-3


def test_motion_at_a_horizon_is_finite():
    # The upper half pixel of some row looks above the floor's horizon; the derivative has to stand in there.
    mirror = shapes.combine(shapes.quad((0.0, 4.0, 1.0), (3.0, 0.0, 0.0), (0.0, 0.0, 3.0)))
    floor = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1e6, 0.0, 0.0), (0.0, 1e6, 0.0)))
    view = View.looking_at((0.0, -4.0, 1.0), (0.0, 4.0, 1.0 - 1e-4), (64, 65))
    truth = trace(view, mirror, floor)
    met = truth.source_triangle >= 0
    assert met.sum() > 500
    assert np.isfinite(truth.motion[met]).all()
    assert (truth.motion[met] > 0.0).all()


def test_ball_tends_to_the_sphere_with_the_square_of_the_triangles_size():
    """Against the ray reflected by the ideal sphere, met by the quadratic of a ray and a sphere."""
    case = sphere((96, 96))
    centre, errors = np.array([0.0, 0.0, 1.3]), []
    floor = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), (0.0, 60.0, 0.0)))
    origins, directions = case.view.rays(pixel_centres(case.view))
    along = np.einsum("ni,ni->n", centre - origins, directions)
    off = np.linalg.norm(origins + along[:, None] * directions - centre, axis=1)
    middle = off < 0.7
    q = origins + (along - np.sqrt(np.maximum(1.0 - off**2, 0.0)))[:, None] * directions
    turned = directions - 2.0 * np.einsum("ni,ni->n", directions, q - centre)[:, None] * (q - centre)
    middle &= turned[:, 2] < -0.3
    point = q - (q[:, 2] / turned[:, 2])[:, None] * turned
    assert middle.sum() > 500
    for subdivisions in (3, 4, 5):
        truth = trace(case.view, shapes.combine(shapes.icosphere(centre, 1.0, subdivisions)), floor)
        assert (truth.source_triangle[middle] >= 0).all()
        errors.append(np.linalg.norm(truth.position[middle] - point[middle], axis=1).mean())
    np.testing.assert_allclose([errors[0] / errors[1], errors[1] / errors[2]], 4.0, rtol=0.1)


@pytest.mark.parametrize("embree", ENGINES)
def test_two_mirrors_at_a_right_angle_see_each_other_where_geometry_says(embree):
    """Walls x = 0 (y, z in 0..2) and y = 0 (x, z in 0..2), seen along (-1, -2, 0): a ray that meets y = 0 at x leaves
    along (-1, 2, 0) and meets x = 0 at y = 2 x, so the wall sees itself where 2 x < 2; from x = 0 at y it leaves along
    (1, -2, 0) and meets y = 0 at x = y / 2 always."""
    wall_x = shapes.quad((0.0, 1.0, 1.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    wall_y = shapes.quad((1.0, 0.0, 1.0), (-1.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    mirror = shapes.combine(wall_x, wall_y)
    backdrop = shapes.combine(shapes.quad((0.0, 30.0, 0.0), (60.0, 0.0, 0.0), (0.0, 0.0, 60.0)))
    view = View.looking_at((5.0, 10.0, 1.0), (0.5, 1.0, 1.0), (60, 60), orthographic_scale=4.0)
    truth = trace(view, mirror, backdrop, embree=embree)
    on_x, on_y = np.isin(truth.mirror_triangle, (0, 1)), np.isin(truth.mirror_triangle, (2, 3))
    assert on_x.sum() > 100
    assert on_y.sum() > 100
    assert truth.sees_itself[on_x].all()
    x = truth.mirror_position[on_y, 0]
    np.testing.assert_array_equal(truth.sees_itself[on_y], x < 1.0)


def test_bent_where_the_reflected_ray_would_enter_the_triangle():
    """A mirror z = 0 seen straight from above whose normals lean by an angle a: the ray leaves at 2 a from the
    upright, hence cos(2 a) against the threshold of 0.01; the same from below, two-sided."""
    limit = 0.5 * np.arccos(0.01)
    for side in (1.0, -1.0):
        view = View.looking_at((0.0, 0.0, 5.0 * side), (0.0, 0.0, 0.0), (8, 8), orthographic_scale=1.0)
        for angle, bent in ((limit - 1e-6, False), (limit + 1e-6, True), (0.0, False), (1.2, True)):
            points, faces, _ = shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
            normals = np.broadcast_to([np.sin(angle), 0.0, np.cos(angle)], (4, 3))
            mirror = shapes.combine((points, faces, normals))
            scene = shapes.combine(shapes.quad((0.0, 0.0, 9.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
            truth = trace(view, mirror, scene)
            assert (truth.bent == bent).all()


def test_what_stands_before_the_mirror_hides_it():
    view = View.looking_at((0.0, -4.0, 0.0), (0.0, 0.0, 0.0), (20, 20), orthographic_scale=2.0)
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    screen = shapes.combine(shapes.quad((-1.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 2.0)))
    truth = trace(view, mirror, screen)
    left = pixel_centres(view)[:, 0] < 10.0
    np.testing.assert_array_equal(truth.mirror_triangle >= 0, ~left)
    np.testing.assert_allclose(truth.scene_depth[left], 3.0, rtol=1e-12)
    np.testing.assert_allclose(truth.mirror_depth, 4.0, rtol=1e-12)
    assert (truth.source_triangle == -1).all()


@pytest.mark.parametrize("name", ["sphere", "water", "bowl", "torus", "cylinder"])
def test_truth_moves_with_the_scene(name):
    case = SCENES[name]((40, 40))
    moved = case.moved("moved", (3e3, -5e3, 2e3), 10.0)
    here, there = (trace(c.view, c.mirror, c.scene) for c in (case, moved))
    assert (here.source_triangle >= 0).sum() > 50
    np.testing.assert_array_equal(here.source_triangle, there.source_triangle)
    np.testing.assert_array_equal(here.sees_itself, there.sees_itself)
    met = here.source_triangle >= 0
    np.testing.assert_allclose(there.position[met], here.position[met] * 10.0 + [3e3, -5e3, 2e3], atol=1e-6)
    np.testing.assert_allclose(there.motion[met], here.motion[met] * 10.0, rtol=1e-6)


def test_plane_hits_far_from_the_origin():
    offset = np.array([1e6, -2e6, 5e5])
    mesh = TriangleMesh(np.array([[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]) + offset, [[0, 1, 2]])
    distance, weights = plane_hits(mesh, np.zeros(1, dtype=int), np.array([[1.0, 2.0, 8.0]]) + offset,
                                   np.array([[0.0, 0.0, -2.0]]))
    np.testing.assert_allclose(distance, 4.0, rtol=1e-12)
    np.testing.assert_allclose(weights, [[0.25, 0.25, 0.5]], atol=1e-12)
