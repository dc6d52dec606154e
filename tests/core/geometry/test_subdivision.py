"""Splitting at marked edges: no area lost, no crack, no corner of one triangle on another's edge."""
import itertools

import numpy as np
import pytest

from core.geometry.subdivision import parent_side, shared_edges, split
from tests.inputs import shapes

MARKS = np.array(list(itertools.product((False, True), repeat=3)))


def six_points(a, b, c):
    return np.stack([a, b, c, 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)], axis=-2)


def signed_areas(corners):
    u, v = corners[..., 1, :] - corners[..., 0, :], corners[..., 2, :] - corners[..., 0, :]
    return 0.5 * (u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


@pytest.mark.parametrize("marked", MARKS)
def test_children_fill_their_parent_and_keep_its_turn(marked):
    parent, local = split(marked[None])
    points = six_points(*np.array([[0.0, 0.0], [4.0, 0.0], [1.0, 3.0]]))
    areas = signed_areas(points[local])
    assert (parent == 0).all()
    assert (areas > 0.0).all()
    assert areas.sum() == 6.0
    assert len(parent) == 1 + marked.sum()
    # Exactly the middles of marked edges are used.
    np.testing.assert_array_equal(np.isin([3, 4, 5], local), marked)
    # No corner lies inside an edge of a child: each inner edge is there once each way.
    edges = np.stack([local, np.roll(local, -1, axis=1)], axis=2).reshape(-1, 2)
    inner = edges[parent_side(local).ravel() == 3]
    forth, back = {tuple(e) for e in inner}, {tuple(e[::-1]) for e in inner}
    assert forth == back and len(forth) == len(inner)


@pytest.mark.parametrize("marked", MARKS)
def test_parent_side_names_the_edge_that_holds_a_childs_edge(marked):
    _, local = split(marked[None])
    points = six_points(*np.array([[0.0, 0.0], [4.0, 0.0], [1.0, 3.0]]))
    for child, sides in zip(local, parent_side(local)):
        for k, side in enumerate(sides):
            p, q = points[child[k]], points[child[(k + 1) % 3]]
            holds = [abs(np.linalg.det([b - a, p - a])) + abs(np.linalg.det([b - a, q - a])) < 1e-12
                     for a, b in ((points[0], points[1]), (points[1], points[2]), (points[2], points[0]))]
            assert holds.index(True) == side if any(holds) else side == 3


def test_shared_edges_lists_each_edge_once():
    triangles = shapes.icosphere((0.0, 0.0, 0.0), 1.0, 2)[1]
    ends, first, edge = shared_edges(triangles)
    expected = {tuple(sorted((t[k], t[(k + 1) % 3]))) for t in triangles.tolist() for k in range(3)}
    assert {tuple(e) for e in ends.tolist()} == expected
    assert len(ends) == len(expected) == 3 * len(triangles) // 2
    pairs = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2), axis=2)
    np.testing.assert_array_equal(ends[edge], pairs)
    np.testing.assert_array_equal(pairs.reshape(-1, 2)[first], ends)


def test_a_split_mesh_stays_closed_and_loses_no_volume():
    positions, triangles, _ = shapes.icosphere((0.0, 0.0, 0.0), 1.0, 2)
    rng = np.random.default_rng(83)
    for share in (0.05, 0.5, 1.0):
        ends, _, edge = shared_edges(triangles)
        chosen = rng.random(len(ends)) < share
        parent, local = split(chosen[edge])
        new = len(positions) + np.cumsum(chosen) - 1
        children = np.take_along_axis(np.concatenate([triangles, new[edge]], axis=1)[parent], local, axis=1)
        points = np.concatenate([positions, positions[ends[chosen]].mean(axis=1)])
        forth = np.stack([children, np.roll(children, -1, axis=1)], axis=2).reshape(-1, 2)
        assert len(np.unique(forth, axis=0)) == len(forth)
        assert {tuple(e) for e in forth.tolist()} == {tuple(e) for e in forth[:, ::-1].tolist()}
        volume = np.linalg.det(points[children]).sum()
        assert volume == pytest.approx(np.linalg.det(positions[triangles]).sum(), rel=1e-12)


def test_nothing_is_split_where_there_is_nothing():
    parent, local = split(np.zeros((0, 3), dtype=bool))
    assert parent.shape == (0,) and local.shape == (0, 3)
    ends, first, edge = shared_edges(np.zeros((0, 3), dtype=np.int64))
    assert ends.shape == (0, 2) and len(first) == 0 and edge.shape == (0, 3)
