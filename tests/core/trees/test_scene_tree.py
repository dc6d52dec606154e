"""The k-d tree and its trace against every camera tried on every triangle."""
import numpy as np
import pytest

from core import SceneTree, TriangleMesh, project
from core.trees import Bound, bounded_trace
from core.trees.cones import Cones
from tests.inputs.random_cameras import cameras_of, moved, random_cameras
from tests.oracles.every_pair import every_pair
from tests.oracles.ray_hits import plane_hits

RNG = np.random.default_rng(17)


def soup(count, size=0.3, spread=3.0):
    middles = RNG.uniform(-spread, spread, (count, 1, 3))
    return (middles + RNG.normal(scale=size, size=(count, 3, 3))).reshape(-1, 3)


def joined(count):
    """Triangles on shared, clustered vertices."""
    middles = np.repeat(2.0 * RNG.normal(size=(4, 3)), count, axis=0)
    points = middles + RNG.normal(scale=0.2, size=(4 * count, 3))
    return points, RNG.permuted(np.tile(np.arange(4 * count), (3, 1)), axis=1).T


SPREAD_OUT = soup(200)
DATA = {
    "random": (SPREAD_OUT, np.arange(600).reshape(-1, 3)),
    "large": (soup(3000, 0.05), np.arange(9000).reshape(-1, 3)),
    "joined": joined(100),
    "duplicate_points": (np.repeat(soup(30), 8, axis=0), RNG.integers(0, 720, (200, 3))),
    "one_place": (np.full((600, 3), 0.7) + 1e-13 * RNG.normal(size=(600, 3)), np.arange(600).reshape(-1, 3)),
    "in_a_plane": (SPREAD_OUT * [1.0, 1.0, 0.0] + [0.0, 0.0, 1.5], np.arange(600).reshape(-1, 3)),
    "near_a_line": (SPREAD_OUT * [1.0, 1e-7, 1e-7], np.arange(600).reshape(-1, 3)),
    "one_triangle": (soup(1), np.array([[0, 1, 2]])),
    "fewer_than_a_bucket": (soup(5), np.arange(15).reshape(-1, 3)),
    "large_and_small": (np.concatenate([soup(20, 4.0), soup(180, 0.01)]), np.arange(600).reshape(-1, 3)),
}
PLACES = {"here": (1.0, 0.0), "far": (1.0, 1e5), "small": (1e-4, 0.0), "large": (1e4, 0.0)}


def case(data, place):
    positions, triangles = DATA[data]
    scale, offset = PLACES[place]
    cameras = random_cameras(np.random.default_rng(23), 60)
    return TriangleMesh(positions * scale + offset, triangles), moved(cameras, scale, offset)


@pytest.mark.thorough
@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("data", DATA)
def test_the_trace_meets_every_triangle_that_a_camera_sees(data, place):
    mesh, cameras = case(data, place)
    cones = Cones.around(cameras)
    tree = SceneTree.build(mesh)
    mesh = tree.mesh
    cone, triangle, visited = tree.trace(cones)
    met = np.zeros((len(cameras), len(mesh.triangles)), dtype=bool)
    met[cone, triangle] = True
    assert len(cone) == met.sum()
    areal = np.zeros(len(mesh.triangles), dtype=bool)
    areal[tree.order] = True
    # A vertex that projects, and a ray that hits: the triangle must be met.
    needed = np.zeros_like(met)
    used = np.unique(mesh.triangles)
    camera, vertex = (index.ravel() for index in np.meshgrid(np.arange(len(cameras)), used, indexing="ij"))
    corners = cameras.corners[camera]
    found = project(cameras.places.T[corners], cameras.rays.T[corners], mesh.positions[vertex]).pair
    seen = np.zeros((len(cameras), len(mesh.positions)), dtype=bool)
    seen[camera[found], vertex[found]] = True
    needed |= seen[:, mesh.triangles].any(axis=2)
    if data not in ("one_place", "near_a_line", "duplicate_points", "large"):
        weights = np.random.default_rng(29).dirichlet((1.0, 1.0, 1.0), 8)
        origins = np.einsum("wk,xnk->nwx", weights, cameras.places[:, cameras.corners]).reshape(-1, 3)
        rays = np.einsum("wk,xnk->nwx", weights, cameras.rays[:, cameras.corners]).reshape(-1, 3)
        some = np.flatnonzero(areal)
        hit, _ = every_pair(TriangleMesh(mesh.positions, mesh.triangles[some]), origins, rays)
        needed[np.repeat(np.arange(len(cameras)), 8)[hit >= 0], some[hit[hit >= 0]]] = True
    assert not (needed & areal & ~met).any()
    # No more than every sphere tried on every cone would give.
    sphere = tree.triangle_spheres
    every = cones.touch(np.repeat(np.arange(len(cameras)), len(mesh.triangles)),
                        np.tile(sphere[:3], (1, len(cameras))), np.tile(sphere[3], len(cameras))).reshape(met.shape)
    assert not (met & ~(every & areal)).any()


@pytest.mark.parametrize("data", DATA)
def test_each_triangle_with_an_area_hangs_at_one_leaf_inside_the_spheres_above_it(data):
    mesh, _ = case(data, "here")
    tree = SceneTree.build(mesh)
    mesh = tree.mesh
    a, b, c = np.moveaxis(mesh.positions[mesh.triangles], 1, 0)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert len(np.unique(tree.order)) == len(tree.order)
    clear = np.flatnonzero(area > 1e-9 * (np.abs(b - a).max(axis=1) + np.abs(c - a).max(axis=1)) ** 2)
    assert np.isin(clear, tree.order).all()
    assert (area[tree.order] > 0.0).all()
    assert len(tree.leaf_start) == 2**tree.depth + 1
    leaf = np.repeat(np.arange(2**tree.depth), np.diff(tree.leaf_start))
    corners = mesh.positions[mesh.triangles[tree.order]]
    for level, sphere in enumerate(tree.spheres):
        node = leaf >> (tree.depth - level)
        away = np.linalg.norm(corners - sphere[:3, node].T[:, None], axis=2).max(axis=1)
        assert (away <= sphere[3, node] * (1.0 + 1e-12) + 1e-15 * np.abs(mesh.positions).max()).all()


def test_zero_area_triangles_are_left_out():
    points = soup(4)
    points[4], points[7] = points[3], 0.5 * (points[6] + points[8])
    points[9:12] = points[9]
    tree = SceneTree.build(TriangleMesh(points, np.arange(12).reshape(-1, 3)))
    np.testing.assert_array_equal(tree.given.triangle[tree.order], [0])


def test_leaves_hold_no_more_than_a_bucket_of_vertices():
    mesh, _ = case("large", "here")
    tree = SceneTree.build(mesh)
    # A triangle hangs at its first vertex, so that a leaf has no more triangles than vertices here.
    assert 2**tree.depth >= 9000 / 4
    assert np.diff(tree.leaf_start).max() <= 4 + 1


def test_the_trace_visits_a_small_part_of_the_tree():
    mesh, cameras = case("large", "here")
    narrow = random_cameras(np.random.default_rng(31), 50, size=0.02, turn=0.02)
    tree = SceneTree.build(mesh)
    cone, _, visited = tree.trace(Cones.around(narrow))
    assert 0 < visited < 0.3 * 50 * 2**tree.depth
    assert len(cone) < 0.1 * 50 * len(mesh.triangles)
    assert len(cameras) == 60


def test_no_cones_meet_nothing():
    mesh, cameras = case("random", "here")
    cone, triangle, visited = SceneTree.build(mesh).trace(Cones.around(cameras.select(np.zeros(0, dtype=np.int64))))
    assert len(cone) == len(triangle) == visited == 0


def parts_of_cameras(rng):
    """Places and rays (120, 3, 3) of ten parts of each of twelve cameras."""
    whole = random_cameras(rng, 12)
    weights = rng.dirichlet((1.0, 1.0, 1.0), (12, 10, 3))
    return [np.einsum("xfc,fmkc->fmkx", given[:, whole.corners], weights).reshape(-1, 3, 3)
            for given in (whole.places, whole.rays)]


@pytest.mark.thorough
@pytest.mark.parametrize("family", [None, np.repeat(np.arange(12), 10)])
@pytest.mark.parametrize("data", DATA)
def test_cones_that_meet_more_than_enough_are_full_and_others_meet_all(data, family):
    mesh, _ = case(data, "here")
    cones, tree = Cones.around(cameras_of(*parts_of_cameras(np.random.default_rng(59)))), SceneTree.build(mesh)
    every = bounded_trace(tree, cones, Bound(10**7, np.ones(120)), family=family)
    count = np.bincount(every.cone, minlength=120)
    enough = np.random.default_rng(61).choice([0.0, 0.5 * np.median(count), 2.0 * np.median(count), np.inf], 120)
    found = bounded_trace(tree, cones, Bound(10**7, np.ones(120), enough), family=family)
    assert not (every.full | every.given_up | found.given_up).any()
    assert found.full[count > enough].all() and not found.full[np.isinf(enough)].any()
    left = ~found.full[every.cone]
    assert {*zip(found.cone, found.triangle)} == {*zip(every.cone[left], every.triangle[left])}


def test_what_is_full_is_not_what_is_given_up():
    mesh, _ = case("large", "here")
    cones, tree = Cones.around(cameras_of(*parts_of_cameras(np.random.default_rng(59)))), SceneTree.build(mesh)
    count = np.bincount(bounded_trace(tree, cones, Bound(10**7, np.ones(120))).cone, minlength=120)
    enough = np.where(np.arange(120) % 2, 0.0, np.inf)
    found = bounded_trace(tree, cones, Bound(int(count.max()), np.ones(120), enough))
    assert found.given_up.any() and not (found.given_up & found.full).any() and not found.given_up[1::2].any()
    assert found.full[1::2][count[1::2] > 0].all() and len(found.cone) <= count.max()


@pytest.mark.thorough
@pytest.mark.parametrize("data", DATA)
def test_cones_that_descend_together_meet_what_they_meet_alone(data):
    mesh, _ = case(data, "here")
    rng = np.random.default_rng(37)
    places, rays = parts_of_cameras(rng)
    cones, tree = Cones.around(cameras_of(places, rays)), SceneTree.build(mesh)
    wanted = np.arange(120) % 7 != 3
    pairs, visits = [], []
    for family in (None, np.repeat(np.arange(12), 10)):
        shares = list(tree.traced(cones, wanted, family))
        pairs.append({pair for cone, triangle, _ in shares for pair in zip(cone.tolist(), triangle.tolist())})
        visits.append(sum(visited for *_, visited in shares))
    alone, together = pairs
    # spheres behind a camera may touch its own cone alone: no ray goes there
    missed = np.array(sorted(alone - together), dtype=np.int64).reshape(-1, 2)
    assert len(missed) <= 0.05 * len(alone)
    weights = rng.dirichlet((0.5, 0.5, 0.5), (len(missed), 200))
    origins, directions = (np.einsum("nwk,nkx->nwx", weights, given[missed[:, 0]]).reshape(-1, 3)
                           for given in (places, rays))
    distance, inside = plane_hits(tree.mesh, np.repeat(missed[:, 1], 200), origins, directions)
    assert not ((distance > 0.0) & (inside >= 0.0).all(axis=1)).any()
    assert len(together) <= 1.05 * len(alone) + 5
    assert not {cone for cone, _ in together} & set(np.flatnonzero(~wanted).tolist())
    assert visits[1] < 0.3 * visits[0]
