"""What lies beside what: corners across sides, where a surface ends, and parts, against dictionaries of sides."""
from collections import Counter

import numpy as np
import pytest

from core.geometry import borders, connected, corners_beyond
from tests.inputs import shapes


def drawn(seed):
    """Triangles (m, 3) of few vertices, so that sides are met by none, one and several others."""
    rng = np.random.default_rng(seed)
    triangles = rng.integers(0, 14, (int(rng.integers(1, 40)), 3))
    return triangles[(triangles != np.roll(triangles, 1, axis=1)).all(axis=1)]


def sides(triangles):
    """(one end, other end, corner opposite, as an entry of the flattened triangles) of all sides."""
    return [(row[(k + 1) % 3], row[(k + 2) % 3], 3 * number + k)
            for number, row in enumerate(triangles.tolist()) for k in range(3)]


@pytest.mark.parametrize("seed", range(20))
def test_across_a_side_lies_the_only_other_triangle_that_has_it(seed):
    triangles = drawn(seed)
    owners = {}
    for one, other, corner in sides(triangles):
        owners.setdefault(frozenset((one, other)), []).append(corner)
    expected = np.full(triangles.size, -1)
    for pair in owners.values():
        if len(pair) == 2:
            expected[pair] = pair[::-1]
    np.testing.assert_array_equal(corners_beyond(triangles).ravel(), expected)


@pytest.mark.parametrize("seed", range(20))
def test_a_surface_ends_where_a_side_does_not_run_to_and_fro_as_often(seed):
    triangles = drawn(seed)
    count = Counter()
    for one, other, _ in sides(triangles):
        count[one, other] += 1
        count[other, one] -= 1
    expected = np.zeros(15, dtype=bool)
    for (one, other), left in count.items():
        if left:
            expected[[one, other]] = True
    np.testing.assert_array_equal(borders(triangles, 15), expected)


def test_a_ball_ends_nowhere_and_without_a_triangle_at_its_corners():
    triangles = shapes.combine(shapes.icosphere((0.0, 0.0, 0.0), 1.0, 3)).triangles
    count = int(triangles.max()) + 1
    assert not borders(triangles, count).any()
    assert sorted(np.flatnonzero(borders(triangles[1:], count))) == sorted(triangles[0])
    turned = np.concatenate((triangles[:1, ::-1], triangles[1:]))
    assert sorted(np.flatnonzero(borders(turned, count))) == sorted(triangles[0])


@pytest.mark.parametrize("seed", range(20))
def test_what_hangs_together_has_one_number(seed):
    triangles = drawn(seed)
    part = list(range(len(triangles)))
    for _ in triangles:
        for i, one in enumerate(triangles.tolist()):
            for j, other in enumerate(triangles.tolist()):
                if set(one) & set(other):
                    part[i] = part[j] = min(part[i], part[j])
    _, expected = np.unique(part, return_inverse=True)
    np.testing.assert_array_equal(connected(triangles), expected)


def test_of_no_triangles_nothing_is_told():
    none = np.zeros((0, 3), dtype=np.int64)
    assert corners_beyond(none).shape == (0, 3) and not borders(none, 4).any() and not len(connected(none))
