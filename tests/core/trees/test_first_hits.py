"""Rays through boxes and through the k-d tree: the triangle that each meets first, against every pair tried."""
import numpy as np
import pytest

from core import SceneTree, TriangleMesh
from core.trees import BoxTree, first_crossed, first_hits
from core.trees.box_tree import LEAF
from tests.inputs import shapes
from tests.oracles.ray_hits import first_hits as brute_first_hits
from tests.oracles.true_map import case_of


def soup(kind):
    rng = np.random.default_rng(11)
    corners = rng.uniform(-1.0, 1.0, (400, 1, 3)) + rng.normal(scale=0.2, size=(400, 3, 3))
    if kind == "flat":
        corners[:, :, 2] = 0.3
    elif kind == "one middle":
        corners -= 0.5 * (corners.min(axis=1, keepdims=True) + corners.max(axis=1, keepdims=True))
    elif kind == "without area":
        corners[::2, 2] = corners[::2, 1]
    elif kind == "one":
        corners = corners[:1]
    elif kind == "far":
        corners += (3e4, -2e4, 1e4)
    return TriangleMesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["any", "flat", "one middle", "without area", "one", "far"])
def test_first_hits_are_those_of_brute_force(kind):
    mesh, rng = soup(kind), np.random.default_rng(5)
    middle = mesh.positions.mean(axis=0)
    origins = rng.normal(scale=2.0, size=(3000, 3))
    directions = rng.uniform(-1.0, 1.0, (3000, 3)) - origins
    # rays along the axes meet the sides of boxes, and those from inside leave the nearest triangles behind them
    directions[:300] = np.eye(3)[rng.integers(0, 3, 300)] * rng.choice([-1.0, 1.0], (300, 1))
    origins[:600] *= 0.2
    origins += middle
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    triangle, distance = brute_first_hits(mesh, origins, directions, embree=False)
    hits = first_hits(BoxTree.build(mesh), origins.T, directions.T, least=1e-7)
    if kind == "flat":
        # triangles on each other are met at one distance: any of them will do
        assert np.array_equal(hits.triangle >= 0, triangle >= 0)
    else:
        assert np.array_equal(hits.triangle, triangle)
    assert (triangle >= 0).sum() > (20 if kind == "one" else 300)
    met = triangle >= 0
    np.testing.assert_allclose(hits.distance[met], distance[met], rtol=0, atol=1e-10 * (1.0 + np.abs(middle).max()))
    assert np.isinf(hits.distance[~met]).all()


def test_a_limit_and_what_is_not_asked_for_are_heeded():
    mesh = shapes.combine(*(shapes.quad((0.0, 0.0, z), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)) for z in (1.0, 2.0, 3.0)))
    tree, up = BoxTree.build(mesh), np.array([[0.0], [0.0], [1.0]])
    origin = np.array([[0.5], [0.2], [0.0]])
    assert first_hits(tree, origin, up).distance[0] == pytest.approx(1.0)
    assert first_hits(tree, origin, up, least=1.5).distance[0] == pytest.approx(2.0)
    assert first_hits(tree, origin, up, asked=lambda ray, triangle: triangle != 0).distance[0] == pytest.approx(2.0)
    assert first_hits(tree, origin, up, limit=np.array([0.9])).triangle[0] == -1


@pytest.mark.parametrize("kind", ["scene", "any", "one middle"])
def test_a_box_tree_holds_every_triangle_once_and_within_its_boxes(kind):
    mesh = case_of("sphere").scene if kind == "scene" else soup(kind)
    tree = BoxTree.build(mesh)
    assert np.array_equal(np.sort(tree.order), np.arange(len(mesh.triangles)))
    leaf = np.flatnonzero(tree.child < 0)
    assert tree.count[leaf].sum() == len(mesh.triangles) and tree.count[leaf].max() <= LEAF
    for node in leaf:
        held = mesh.triangles[tree.order[tree.start[node]:tree.start[node] + tree.count[node]]]
        corners = mesh.positions[held].reshape(-1, 3) - tree.middle
        assert (corners >= tree.low[:, node]).all() and (corners <= tree.high[:, node]).all()
    inner = np.flatnonzero(tree.child >= 0)
    for child in (tree.child[inner], tree.child[inner] + 1):
        assert (tree.low[:, child] >= tree.low[:, inner]).all() and (tree.high[:, child] <= tree.high[:, inner]).all()


@pytest.mark.thorough
@pytest.mark.parametrize("count", [20, 2000])
def test_few_rays_and_many_meet_the_same(count):
    # few go through the tree as cones without width, many through boxes: 400 triangles get boxes for 41 rays
    mesh, rng = soup("any"), np.random.default_rng(6)
    origins = rng.normal(scale=2.0, size=(count, 3))
    directions = mesh.positions[rng.integers(0, len(mesh.positions), count)] + rng.normal(0, 0.1, (count, 3)) - origins
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    tree, asked = SceneTree.of_ordered(mesh), rng.random(len(mesh.triangles)) < 0.5
    half = TriangleMesh(mesh.positions, mesh.triangles[asked])
    for chosen, given in ((np.arange(len(mesh.triangles)), None),
                          (np.flatnonzero(asked), lambda ray, triangle: asked[triangle] & (ray >= 0) & (ray < count))):
        triangle, distance = first_crossed(tree, origins.T, directions.T, 0.5, given)
        expected, far = brute_first_hits(mesh if given is None else half, origins, directions, embree=False)
        sure = far > 0.5
        assert np.array_equal(triangle[sure], np.where(expected >= 0, chosen[expected], -1)[sure])
        assert (triangle >= 0).sum() > count // 3 and (distance > 0.5).all()
    assert ("boxes" in vars(tree)) == (count > 40)
