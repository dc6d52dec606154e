"""The z-buffer against every pixel tried on every triangle and against closed forms."""
import numpy as np
import pytest

from core import TriangleMesh, View
from tests.inputs import shapes
from tests.oracles.every_pair import every_pair, pixel_centres
from tests.oracles.raster import rasterise


@pytest.mark.parametrize("orthographic", [False, True])
def test_raster_agrees_with_every_pixel_tried_on_every_triangle(orthographic):
    view = View.looking_at((2.0, -6.0, 3.0), (0.0, 0.0, 0.0), (50, 40), orthographic_scale=4.0 * orthographic)
    rng = np.random.default_rng(11)
    positions = rng.uniform(-2.0, 2.0, (120, 3))
    triangles = np.concatenate([np.arange(120).reshape(-1, 3), rng.integers(0, 30, (20, 3))])
    triangles = triangles[(np.diff(np.sort(triangles, axis=1), axis=1) > 0).all(axis=1)]
    drawn = rasterise(view, positions, triangles)
    origins, directions = view.rays(pixel_centres(view))
    expected, distance = every_pair(TriangleMesh(positions, triangles), origins, directions)
    assert len(np.unique(expected)) > 20
    np.testing.assert_array_equal(drawn.triangle, expected)
    seen = expected >= 0
    np.testing.assert_allclose(drawn.depth[seen], (distance * (directions @ view.forward))[seen], rtol=1e-9)
    points = drawn.interpolate(positions, triangles)[seen]
    np.testing.assert_allclose(points, (origins + distance[:, None] * directions)[seen], atol=1e-9)


def test_raster_leaves_no_crack_where_triangles_meet_at_pixel_centres():
    # A fan about the very centre of a pixel, with spokes through other centres, over the whole picture.
    view = View.looking_at((0.0, 0.0, 5.0), (0.0, 0.0, 0.0), (33, 33), orthographic_scale=33.0)
    angles = np.arange(16) * (np.pi / 8)
    rim = 40.0 * np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=1)
    positions = np.concatenate([[[0.0, 0.0, 0.0]], rim])
    fan = np.stack([np.zeros(16, dtype=int), 1 + np.arange(16), 1 + (np.arange(16) + 1) % 16], axis=1)
    drawn = rasterise(view, positions, fan)
    assert (drawn.triangle >= 0).all()
    np.testing.assert_allclose(drawn.depth, 5.0, rtol=1e-12)


def test_raster_cuts_off_what_lies_behind_the_eye():
    view = View.looking_at((0.3, 0.2, 1.0), (0.3, 8.0, 0.4), (40, 40), field_of_view=1.2)
    positions, triangles, _ = shapes.quad((0.0, 0.0, 0.0), (50.0, 0.0, 0.0), (0.0, 50.0, 0.0))
    drawn = rasterise(view, positions, triangles)
    origins, directions = view.rays(pixel_centres(view))
    with np.errstate(divide="ignore"):
        distance = -origins[:, 2] / directions[:, 2]
    floor = origins + distance[:, None] * directions
    expected = (distance > 0.0) & (np.abs(floor[:, :2]) < 50.0).all(axis=1)
    assert 0.4 < expected.mean() < 0.9
    np.testing.assert_array_equal(drawn.triangle >= 0, expected)
    np.testing.assert_allclose(drawn.interpolate(positions, triangles)[expected], floor[expected], atol=1e-9)


def test_raster_of_nothing_shows_nothing():
    view = View.looking_at((0.0, -1.0, 0.0), (0.0, 0.0, 0.0), (4, 3))
    drawn = rasterise(view, np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))
    assert (drawn.triangle == -1).all()
    assert np.isinf(drawn.depth).all()
    np.testing.assert_array_equal(drawn.interpolate(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)), 0.0)
