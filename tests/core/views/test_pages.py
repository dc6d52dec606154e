"""Pages: no two triangles of a page cover one pixel, and nearer ones are on lower pages."""
from __future__ import annotations

import numpy as np
import pytest

from core import View, draw, pages_of


def triangles_at_random(seed: int, count: int) -> tuple[View, np.ndarray, np.ndarray]:
    """Small triangles that face the eye at different depths, and do not cross."""
    rng = np.random.default_rng(seed)
    middle = rng.uniform(-1.0, 1.0, (count, 1, 3)) * (1.0, 1.0, 0.0)
    depth = rng.permutation(count)[:, None, None] * np.array((0.0, 0.0, 1.0)) / count
    corners = middle + depth + rng.uniform(-0.5, 0.5, (count, 3, 3)) * (1.0, 1.0, 0.0)
    view = View.looking_at((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (48, 48), field_of_view=0.5)
    return view, corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)


@pytest.mark.parametrize("seed", range(4))
def test_no_two_triangles_of_a_page_cover_a_pixel(seed):
    view, positions, triangles = triangles_at_random(seed, 12)
    page = pages_of(view, positions, triangles)
    alone = [draw(view, positions, triangles[number:number + 1]) for number in range(len(triangles))]
    for one in range(len(triangles)):
        for other in range(one):
            shared = (alone[one].triangle >= 0) & (alone[other].triangle >= 0)
            if shared.any():
                assert page[one] != page[other]
                nearer = alone[one].depth[shared] < alone[other].depth[shared]
                assert (nearer == (page[one] < page[other])).all()


def test_what_does_not_overlap_is_on_one_page():
    view = View.looking_at((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (48, 48), field_of_view=0.5)
    positions = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0.5), (-1, 1, -0.5)], dtype=float)
    assert pages_of(view, positions, np.array([(0, 1, 2), (0, 2, 3)])).tolist() == [0, 0]
    assert pages_of(view, positions, np.zeros((0, 3), dtype=int)).tolist() == []
