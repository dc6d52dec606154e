"""Projection against exact integer arithmetic, and against mirrors whose reflections are known in closed form."""
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from core import project
from tests.core.exact import exact_roots

UNIT = 2.0 ** -53


def seen(vertices, rays, weights, distance):
    """P = Q(W) + s R(W)."""
    return np.einsum("nk,nkc->nc", weights, vertices + distance[:, None, None] * rays)


def mirrored(vertices, normals, eye):
    """The cameras' rays R = d - 2 (d . n) n of an eye."""
    d = vertices - eye
    return d - 2.0 * (d * normals).sum(axis=-1, keepdims=True) * normals


def random_pairs(rng, n):
    vertices, rays = rng.normal(size=(2, n, 3, 3))
    weights, distance = rng.dirichlet([1.0, 1.0, 1.0], n), rng.uniform(0.01, 3.0, n)
    return vertices, rays, weights, distance


def family(name, n=1000):
    """Pairs (vertices, rays, points) of one kind."""
    rng = np.random.default_rng(sum(map(ord, name)))
    v, r, w, s = random_pairs(rng, n)
    if name == "outside":
        return v, r, rng.normal(size=(n, 3))
    if name == "thin triangle":
        along = v[:, 0] + (v[:, 1] - v[:, 0]) * rng.uniform(0, 1, (n, 1))
        v[:, 2] = along + rng.normal(size=(n, 3)) * 10.0 ** -rng.uniform(2, 10, (n, 1))
    if name == "small triangle":
        v, r = v[:, :1] + v * 1e-6, r[:, :1] + r * 1e-6
    if name == "far from the origin":
        v = v + [1e6, -3e6, 2e6]
    if name == "close to the mirror":
        s = 10.0 ** -rng.uniform(2, 14, n)
    if name == "far away":
        s = 10.0 ** rng.uniform(2, 12, n)
    p = seen(v, r, w, s)
    if name == "nearly coplanar":
        flat = 10.0 ** -rng.uniform(2, 16, n)
        v[:, :, 2] *= flat[:, None]
        r[:, :, 2] *= flat[:, None]
        p[:, 2] *= flat
    if name == "tiny":
        v, p = v * 1e-130, p * 1e-130
    if name == "huge":
        v, r, p = v * 1e130, r * 1e-20, p * 1e130
    if name == "few digits":
        v, r, p = (np.round(4.0 * a) for a in (v, r, p))
    return v, r, p


@pytest.mark.parametrize("name", [
    "random", "outside", "nearly coplanar", "thin triangle", "small triangle", "tiny", "huge", "far from the origin",
    "close to the mirror", "far away", "few digits"])
def test_against_exact_arithmetic(name):
    """Images are the exact ones, wherever a hundred units of rounding in the data could not change that."""
    vertices, rays, points = family(name)
    images = project(vertices, rays, points)
    normals = np.cross(vertices[:, 1] - vertices[:, 0], vertices[:, 2] - vertices[:, 0])
    side = np.sign(np.einsum("nc,nkc->n", normals, rays))
    compared = 0
    for k, exact in enumerate(map(exact_roots, vertices, rays, points)):
        mine = np.flatnonzero(images.pair == k)
        assert images.degenerate[k] == (exact is None)
        if exact is None:
            assert len(mine) == 0
            continue
        sure = True
        for root in exact:
            if root.weights is None or root.multiplicity > 1:
                sure = False
                continue
            loose_s, loose_w = 100 * UNIT * root.distance_condition, 200 * UNIT * root.weight_condition
            if max(loose_s, loose_w) > 1e-3:
                sure = False
                continue
            near = mine[np.abs(images.distance[mine] - root.distance) <= (loose_s + 4 * UNIT) * root.distance]
            assert len(near) == 1 or abs(min(root.weights)) <= loose_w or min(root.weights) < 0.0
            assert len(near) == 0 or min(root.weights) >= -loose_w
            assert len(near) <= 1
            np.testing.assert_allclose(images.weights[near], np.array([root.weights] * len(near)).reshape(-1, 3),
                                       rtol=0, atol=loose_w + 8 * UNIT)
            assert side[k] == 0 or (images.parity[near] == root.sign * side[k]).all()
            compared += 1
        if sure:
            inside = sum(min(root.weights) >= -200 * UNIT * root.weight_condition for root in exact)
            assert len(mine) <= inside
    assert compared > len(points) // 3
    assert (np.diff(images.pair) >= 0).all() and images.pair.dtype == np.int64 and images.parity.dtype == np.int8
    assert (images.weights >= 0.0).all() and (images.distance > 0.0).all()
    np.testing.assert_allclose(images.weights.sum(axis=1), 1.0, rtol=4 * UNIT)


def sheared(rng, vertices, rays, points):
    """The same pairs under integer maps of determinant 1 and shifts, still exact."""
    n = len(points)
    lower, upper = np.tile(np.eye(3, dtype=int), (2, n, 1, 1))
    for i, k in ((1, 0), (2, 0), (2, 1)):
        lower[:, i, k], upper[:, k, i] = rng.integers(-2, 3, (2, n))
    turn, shift = np.swapaxes(lower @ upper, 1, 2), rng.integers(-50, 51, (n, 1, 3))
    return tuple(map(np.float64, (vertices @ turn + shift, rays @ turn, (points[:, None] @ turn + shift)[:, 0])))


def folds(rng, n):
    """Points exactly on the caustic: at s0 the moved triangle holds the origin, and the ray there lies in its plane."""
    w = rng.integers(1, 6, (n, 3))
    w[:, 2] = 1
    a, b = rng.integers(-9, 10, (2, n, 3))
    ra, rb = rng.integers(-5, 6, (2, n, 3))
    ka, kb = rng.integers(-3, 4, (2, n, 1))
    c, rc = -w[:, :1] * a - w[:, 1:2] * b, ka * a + kb * b - w[:, :1] * ra - w[:, 1:2] * rb
    s = rng.choice([1, 2, 4], n)
    moved, rays = np.stack((a, b, c), axis=1), np.stack((ra, rb, rc), axis=1)
    pairs = sheared(rng, moved - s[:, None, None] * rays, rays, np.zeros((n, 3), dtype=int))
    return *pairs, w / w.sum(axis=1, keepdims=True), s


@pytest.mark.parametrize("scale", [1.0, 2.0 ** -30, 2.0 ** 20])
def test_exact_caustic_points_are_one_image_of_parity_zero(scale):
    v, r, p, w, s = folds(np.random.default_rng(5), 1200)
    images = project(v * scale, r, p * scale)
    near = (np.abs(images.distance / scale - s[images.pair]) < 1e-3) & \
        (np.abs(images.weights - w[images.pair]).max(axis=1) < 1e-2)
    count = np.bincount(images.pair[near & (images.parity == 0)], minlength=len(p))
    kinds = np.zeros(4, dtype=int)
    for k, exact in enumerate(map(exact_roots, v, r, p)):
        if exact is None:
            assert images.degenerate[k]
            continue
        multiple = [root for root in exact if root.multiplicity > 1 and root.weights is not None]
        if multiple:
            assert count[k] == 1
            kinds[multiple[0].multiplicity] += 1
            assert (images.pair == k).sum() <= len(exact)
    assert kinds[2] > 1000 and kinds[3] >= 1


@pytest.mark.parametrize("offset", [0.0, 1e6, 2.0 ** 40])
def test_points_on_edges_and_vertices_are_seen(offset):
    rng = np.random.default_rng(6)
    vertices, rays = rng.integers(-64, 65, (2, 3000, 3, 3)).astype(float)
    kinds = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.25, 0.75], [0.75, 0, 0.25]])
    weights, distance = kinds[rng.integers(0, 6, 3000)], rng.choice([0.5, 1.0, 2.0, 4.0], 3000)
    points = seen(vertices, rays, weights, distance)
    images = project(vertices + offset, rays, points + offset)
    near = (np.abs(images.distance / distance[images.pair] - 1.0) < 1e-9) & \
        (np.abs(images.weights - weights[images.pair]).max(axis=1) < 1e-9)
    np.testing.assert_array_equal(np.bincount(images.pair[near], minlength=3000), 1)


def test_points_on_the_mirror_are_not_seen_there():
    rng = np.random.default_rng(7)
    vertices, rays = rng.integers(-64, 65, (2, 2000, 3, 3)).astype(float)
    weights = np.array([[0.25, 0.25, 0.5], [0.5, 0.5, 0.0], [1.0, 0.0, 0.0]])[rng.integers(0, 3, 2000)]
    images = project(vertices, rays, seen(vertices, rays, weights, np.zeros(2000)))
    assert len(images.pair) and images.distance.min() > 1e-6 and not images.degenerate.any()


def test_coplanar_motion_is_degenerate_and_its_like_is_not():
    rng = np.random.default_rng(8)
    v, r, p = (rng.integers(-64, 65, shape) for shape in ((500, 3, 3), (500, 3, 3), (500, 3)))
    v[..., 2] = r[..., 2] = p[..., 2] = 0
    images = project(*sheared(rng, v, r, p))
    assert images.degenerate.all() and len(images.pair) == 0
    p[:, 2] = 1
    assert not project(*sheared(rng, v, r, p)).degenerate.any()


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


def test_winding_and_facing():
    """Any order of the corners gives the same images; `facing` states the side that the rays would otherwise tell."""
    v, r, w, s = random_pairs(np.random.default_rng(12), 2000)
    p = seen(v, r, w, s)
    images = project(v, r, p)
    side = np.sign(np.einsum("nc,nkc->n", np.cross(v[:, 1] - v[:, 0], v[:, 2] - v[:, 0]), r))
    for order in ([1, 2, 0], [0, 2, 1], [2, 1, 0]):
        other = project(v[:, order], r[:, order], p)
        np.testing.assert_array_equal(images.pair, other.pair)
        np.testing.assert_array_equal(images.parity, other.parity)
        np.testing.assert_allclose(images.distance, other.distance, rtol=1e-7)
        np.testing.assert_allclose(images.weights[:, order], other.weights, atol=1e-7)
    np.testing.assert_array_equal(project(v, r, p, facing=side).parity, images.parity)
    np.testing.assert_array_equal(project(v, r, p, facing=-side).parity, -images.parity)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(st.integers(-3, 3), min_size=21, max_size=21))
def test_small_integers(numbers):
    """Small integers meet every degenerate case there is; what is reported must be an image, what is an image found."""
    numbers = np.array(numbers, dtype=float)
    v, r, p = numbers[:9].reshape(3, 3), numbers[9:18].reshape(3, 3), numbers[18:]
    images, exact = project(v[None], r[None], p[None]), exact_roots(v, r, p)
    assert images.degenerate[0] == (exact is None)
    expected = [root for root in exact or [] if root.weights is not None and min(root.weights) >= -1e-12]
    assert len(images.pair) == len(expected)
    for k, root in enumerate(expected):
        assert abs(images.distance[k] - root.distance) <= 1e-4 * root.distance
        assert (images.parity[k] == 0) == (root.multiplicity > 1)


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
