"""Projection against mirrors whose reflections are known in closed form; test_families.py has exact arithmetic."""
import numpy as np
import pytest
from scipy.optimize import brentq

from core import project
from tests.inputs.family_tools import mirrored, random_pairs, seen
from tests.inputs.integer_families import cusps, folds
from tests.oracles.exact_pairs import ExactPairs


@pytest.mark.thorough
@pytest.mark.parametrize("scale", [1.0, 2.0 ** -30, 2.0 ** 20])
@pytest.mark.parametrize("multiplicity, kind", [(2, folds), (3, cusps)])
def test_exact_caustic_points_are_one_image_of_parity_zero(multiplicity, kind, scale):
    v, r, p, w, s = kind(np.random.default_rng(5), 1200)
    images = project(v * scale, r, p * scale)
    near = (np.abs(images.distance / scale - s[images.pair]) < 1e-3) & \
        (np.abs(images.weights - w[images.pair]).max(axis=1) < 1e-2)
    count = np.bincount(images.pair[near & (images.parity == 0)], minlength=len(p))
    # Not where the moved triangle is thinner than what its corners move in the time by which a triple root may be off.
    roots = ExactPairs(v, r, p).roots()
    some = np.unique(roots.cubic[roots.multiplicity == multiplicity])
    a, b, c = np.moveaxis(v + s[:, None, None] * r, 1, 0)
    ways = 3e-4 * s * np.linalg.norm(r, axis=2).sum(axis=1)
    wide = np.linalg.norm(np.cross(b - a, c - a), axis=1) > ways * np.linalg.norm((b - a, c - a), axis=2).sum(axis=0)
    some = some[wide[some]]
    assert len(some) > 1000
    np.testing.assert_array_equal(count[some], 1)
    assert (np.bincount(images.pair, minlength=len(p))[some] <= 2).all()


def test_triangle_that_shrinks_to_a_point_or_a_line_is_no_image():
    """All rays, or all rays across one direction, meet at s = 1, where the cubic vanishes for every point."""
    rng = np.random.default_rng(9)
    vertices = rng.integers(-20, 21, (500, 3, 3)).astype(float)
    focus = rng.integers(-20, 21, (500, 1, 3)).astype(float)
    to_point = focus - vertices
    for rays in (to_point, to_point * [1.0, 1.0, 0.0]):
        points = focus[:, 0] + (0.0 if rays is to_point else rng.integers(-3, 4, (500, 1)) * np.array([0, 0, 1.0]))
        images = project(vertices, rays, points)
        assert (np.abs(images.distance - 1.0) > 1e-9).all()


@pytest.mark.parametrize("offset, scale", [(0.0, 1.0), (1e4, 1.0), (0.0, 1e-6), (0.0, 1e9)])
@pytest.mark.parametrize("flipped", [False, True])
def test_flat_mirror_shows_the_mirrored_point(offset, scale, flipped):
    rng = np.random.default_rng(10)
    n = 5000
    vertices = rng.normal(size=(n, 3, 3)) * [1.0, 1.0, 0.0]
    eye, points = rng.normal(size=(2, n, 3)) + [0.0, 0.0, 4.0]
    ghost = points * [1.0, 1.0, -1.0]
    part = eye[:, 2] / (eye[:, 2] - ghost[:, 2])
    hit = eye + part[:, None] * (ghost - eye)
    a, b, c = np.moveaxis(vertices[..., :2], 1, 0)
    area = np.linalg.det(np.stack((b - a, c - a), axis=1))
    weights = np.stack([np.linalg.det(np.stack((y - x, hit[:, :2] - x), axis=1)) / area
                        for x, y in ((b, c), (c, a), (a, b))], axis=1)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    place = [(q @ turn.T) * scale + offset for q in (vertices, eye[:, None], points)]
    vertices, eye, points = place
    normal = np.broadcast_to(turn[:, 2], vertices.shape)
    order = [0, 2, 1] if flipped else [0, 1, 2]
    images = project(vertices[:, order], mirrored(vertices, normal, eye)[:, order], points)
    well = (np.abs(weights).min(axis=1) > 1e-6) & (np.abs(area) > 1e-3)
    seen_here = well & (weights > 0).all(axis=1)
    k = images.pair[well[images.pair]]
    np.testing.assert_array_equal(k, np.flatnonzero(seen_here))
    assert len(k) > 100 and (images.parity == 1).all()
    at = np.einsum("nk,nkc->nc", images.weights, vertices[images.pair][:, order])[well[images.pair]]
    expected = hit[k] @ turn.T * scale + offset
    reach = np.abs(place[0] - place[2][:, None]).max() + offset
    assert np.abs(at - expected).max() < 1e-12 * reach
    length = ((1.0 - part) / part)[k]
    np.testing.assert_allclose(images.distance[well[images.pair]], length, rtol=1e-12 * max(1.0, offset))


def test_orthographic_flat_mirror_has_only_a_linear_factor():
    vertices = np.array([[[0.0, 0, 0], [4, 0, 0], [0, 4, 0]]])
    rays = np.broadcast_to([1.0, 0.0, 2.0], (1, 3, 3))
    images = project(vertices, rays, np.array([[2.0, 1.0, 2.0]]))
    assert images.distance.tolist() == [1.0] and images.weights.tolist() == [[0.5, 0.25, 0.25]]
    assert images.parity.tolist() == [1]


def icosphere(levels):
    golden = (1.0 + 5.0 ** 0.5) / 2.0
    corners = np.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]], dtype=float)
    points = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    points /= np.linalg.norm(points[0])
    near = np.linalg.norm(points[:, None] - points, axis=2) < 1.1
    a, b, c = (axis.ravel() for axis in np.indices((12, 12, 12)))
    chosen = near[a, b] & near[b, c] & near[c, a] & (a < b) & (b < c)
    triangles = points[np.stack((a, b, c), axis=1)[chosen]]
    for _ in range(levels):
        a, b, c = np.moveaxis(triangles, 1, 0)
        ab, bc, ca = a + b, b + c, c + a
        ab, bc, ca = (m / np.linalg.norm(m, axis=1, keepdims=True) for m in (ab, bc, ca))
        triangles = np.concatenate([np.stack(t, axis=1) for t in
                                    ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])
    return triangles


def alhazen(eye, point):
    """Where the unit sphere mirrors `point` to `eye`: equal angles, found in their plane by bisection."""
    x = eye / np.linalg.norm(eye)
    y = point - (point @ x) * x
    y /= np.linalg.norm(y)

    def difference(angle):
        n = np.cos(angle) * x + np.sin(angle) * y
        cosines = [(to - n) @ n / np.linalg.norm(to - n) for to in (eye, point)]
        return cosines[0] - cosines[1]

    angle = brentq(difference, 0.0, np.arctan2(point @ y, point @ x), xtol=1e-15)
    return np.cos(angle) * x + np.sin(angle) * y


def test_sphere_converges_to_alhazens_point():
    """One image of parity 1 per point on finer and finer spheres, its error shrinking as h^2."""
    rng = np.random.default_rng(11)
    eye = np.array([0.3, -0.2, 5.0])
    points = rng.normal(size=(40, 3)) + [0.0, 0.0, 3.5]
    truth = np.array([alhazen(eye, point) for point in points])
    errors = []
    for levels in (2, 3, 4):
        triangles = icosphere(levels)
        facing = triangles[(triangles * (eye - triangles)).sum(axis=2).min(axis=1) > 0.0]
        m = len(facing)
        vertices = np.tile(facing, (len(points), 1, 1))
        images = project(vertices, mirrored(vertices, vertices, eye), np.repeat(points, m, axis=0))
        which = images.pair // m
        np.testing.assert_array_equal(np.bincount(which, minlength=len(points)), 1)
        assert (images.parity == 1).all()
        at = np.einsum("nk,nkc->nc", images.weights, vertices[images.pair])
        errors.append(np.linalg.norm(at - truth, axis=1).mean())
    assert errors[0] < 0.02
    assert 3.2 < errors[0] / errors[1] < 4.8 and 3.2 < errors[1] / errors[2] < 4.8


@pytest.mark.parametrize("trough, behind", [(True, -1), (False, 1)])
def test_concave_mirrors_turn_over_beyond_the_focus(trough, behind):
    """Parabolic mirrors seen along the axis: a trough sends all rays through a line and turns the picture over once, a
    paraboloid sends them through a point and turns it over twice at once."""
    x = np.array([[[0.1, 0.0], [0.3, 0.05], [0.15, 0.2]]])
    bent = x * [1.0, 0.0] if trough else x
    vertices = np.concatenate((x, (bent ** 2).sum(axis=2, keepdims=True) / 4.0), axis=2)
    normals = np.concatenate((-bent / 2.0, np.ones((1, 3, 1))), axis=2)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    rays = np.broadcast_to([0.0, 0.0, -1.0], (1, 3, 3))
    rays = rays - 2.0 * (rays * normals).sum(axis=2, keepdims=True) * normals
    middle = np.full((1, 3), 1.0 / 3.0)
    for order in ([0, 1, 2], [1, 0, 2]):
        for s, parity in ((0.5, 1), (1.5, behind)):
            images = project(vertices[:, order], rays[:, order], seen(vertices, rays, middle, np.array([s])))
            near = np.abs(images.distance - s) < 1e-9
            assert images.parity[near].tolist() == [parity]


def test_winding():
    """Any order of the corners gives the same images."""
    v, r, w, s = random_pairs(np.random.default_rng(12), 2000)
    p = seen(v, r, w, s)
    images = project(v, r, p)
    for order in ([1, 2, 0], [0, 2, 1], [2, 1, 0]):
        other = project(v[:, order], r[:, order], p)
        np.testing.assert_array_equal(images.pair, other.pair)
        np.testing.assert_array_equal(images.parity, other.parity)
        np.testing.assert_allclose(images.distance, other.distance, rtol=1e-7)
        np.testing.assert_allclose(images.weights[:, order], other.weights, atol=1e-7)


@pytest.mark.thorough
def test_chunks_and_order_do_not_matter():
    v, r, w, s = random_pairs(np.random.default_rng(13), 40000)
    p = seen(v, r, w, s)
    whole = project(v, r, p)
    some = np.random.default_rng(14).permutation(40000)[:500]
    part = project(v[some], r[some], p[some])
    for k, pair in enumerate(some):
        np.testing.assert_array_equal(part.distance[part.pair == k], whole.distance[whole.pair == pair])
        np.testing.assert_array_equal(part.weights[part.pair == k], whole.weights[whole.pair == pair])
    assert np.abs(seen(v[whole.pair], r[whole.pair], whole.weights, whole.distance) - p[whole.pair]).max() < 1e-9


@pytest.mark.thorough
@pytest.mark.parametrize("size", [2.0 ** -90, 2.0 ** 90, 2.0 ** -210, 2.0 ** 210])
def test_pairs_of_other_sizes_change_nothing(size):
    v, r, w, s = random_pairs(np.random.default_rng(16), 2000)
    p = seen(v, r, w, s)
    for grown in (1.0, size):
        together = project(np.concatenate((v, size * v)), np.concatenate((r, grown * r)), np.concatenate((p, size * p)))
        alone, others = project(v, r, p), project(size * v, grown * r, size * p)
        for name in ("distance", "weights", "parity", "degenerate"):
            expected = np.concatenate((getattr(alone, name), getattr(others, name)))
            np.testing.assert_array_equal(getattr(together, name), expected)


def test_what_is_not_finite_is_told_wherever_it_stands():
    v, r, w, s = random_pairs(np.random.default_rng(17), 300)
    p = seen(v, r, w, s)
    for k in range(3):
        for strange in (np.nan, np.inf, -np.inf):
            given = [v.copy(), r.copy(), p.copy()]
            given[k][k + 7, ..., k] = strange
            with pytest.raises(ValueError, match="finite"):
                project(*given)


@pytest.mark.parametrize("n", [1, 2, 100])
def test_arguments_stay_as_they_were(n):
    v, r, w, s = random_pairs(np.random.default_rng(15), n)
    given = [v, r, seen(v, r, w, s)]
    before = [array.copy() for array in given]
    project(*given)
    for array, copy in zip(given, before):
        np.testing.assert_array_equal(array, copy)


def test_none_and_bad_input():
    images = project(np.zeros((0, 3, 3)), np.zeros((0, 3, 3)), np.zeros((0, 3)))
    assert images.pair.shape == images.distance.shape == images.parity.shape == images.degenerate.shape == (0,)
    assert images.weights.shape == (0, 3)
    one = np.ones((1, 3, 3))
    assert project(one, one, np.ones((1, 3))).degenerate.all()
    with pytest.raises(ValueError, match="same n"):
        project(one, one, np.ones((2, 3)))
    with pytest.raises(ValueError, match="finite"):
        project(one, one, np.full((1, 3), np.nan))
