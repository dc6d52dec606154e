"""The eye: pixels and rays against each other and against the plain homogeneous formula of OpenGL."""
import numpy as np
import pytest

from core import View


def placed(seed=0):
    """A rigid placement: rotation by QR of a random matrix, some offset."""
    rng = np.random.default_rng(seed)
    rotation, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    rotation *= np.sign(np.linalg.det(rotation))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, rng.normal(size=3) * 5.0
    return matrix


def frustum(left, right, bottom, top, near=0.1, far=100.0):
    """glFrustum's matrix."""
    return np.array([[2 * near / (right - left), 0, (right + left) / (right - left), 0],
                     [0, 2 * near / (top - bottom), (top + bottom) / (top - bottom), 0],
                     [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)], [0, 0, -1, 0]])


def box(left, right, bottom, top, near=0.1, far=100.0):
    """glOrtho's matrix."""
    return np.array([[2 / (right - left), 0, 0, -(right + left) / (right - left)],
                     [0, 2 / (top - bottom), 0, -(top + bottom) / (top - bottom)],
                     [0, 0, -2 / (far - near), -(far + near) / (far - near)], [0, 0, 0, 1]])


VIEWS = {
    "perspective": View(placed(1), frustum(-0.05, 0.05, -0.03, 0.03), (200, 120)),
    "shifted": View(placed(2), frustum(-0.02, 0.07, -0.06, 0.01), (200, 120)),
    "narrow pixels": View(placed(3), frustum(-0.05, 0.05, -0.05, 0.05), (100, 300)),
    "orthographic": View(placed(4), box(-3.0, 3.0, -2.0, 2.0), (300, 200)),
    "shifted orthographic": View(placed(5), box(-1.0, 5.0, -4.0, 0.5), (64, 64)),
    "looking at": View.looking_at((3.0, -5.0, 2.0), (0.5, 0.0, 1.0), (160, 90)),
    "looking at, orthographic": View.looking_at((3.0, -5.0, 2.0), (0.5, 0.0, 1.0), (90, 160), orthographic_scale=4.0),
}


@pytest.fixture(params=VIEWS, ids=list(VIEWS))
def view(request):
    return VIEWS[request.param]


def some_pixels(view, count=200):
    return np.random.default_rng(9).uniform(-0.2, 1.2, (count, 2)) * view.resolution


def test_a_point_on_the_ray_through_a_pixel_lands_in_it(view):
    pixels = some_pixels(view)
    origins, directions = view.rays(pixels)
    np.testing.assert_allclose(np.linalg.norm(directions, axis=1), 1.0, rtol=1e-14)
    for distance in (0.01, 1.0, 1e4):
        # Cancellation in origin + distance * direction - eye is what remains.
        found = view.pixels(origins + distance * directions)
        np.testing.assert_allclose(found, pixels, atol=1e-9 * max(1.0, 0.1 / distance))


def test_pixels_agree_with_the_homogeneous_formula(view):
    points = view.rays(some_pixels(view))[0] + np.random.default_rng(4).uniform(0.5, 3.0, (200, 1)) * view.forward
    points += np.random.default_rng(5).uniform(-0.1, 0.1, (200, 3))
    homogeneous = np.concatenate([points, np.ones((200, 1))], axis=1)
    clip = homogeneous @ np.linalg.inv(view.camera_to_world).T @ view.projection.T
    np.testing.assert_allclose(view.clip(points), clip, atol=1e-11)
    ndc = clip[:, :2] / clip[:, 3:]
    expected = 0.5 * (ndc + 1.0) * view.resolution
    np.testing.assert_allclose(view.pixels(points), expected, rtol=1e-9, atol=1e-8)


def test_view_directions_are_those_of_the_rays(view):
    pixels = some_pixels(view)
    origins, directions = view.rays(pixels)
    found = view.directions(origins + 3.0 * directions)
    np.testing.assert_allclose(found / np.linalg.norm(found, axis=1, keepdims=True), directions, atol=1e-12)
    length = 1.0 if view.orthographic else 3.0
    np.testing.assert_allclose(np.linalg.norm(found, axis=1), length, rtol=1e-12)


def test_depth_is_the_distance_from_the_eyes_plane(view):
    origins, directions = view.rays(some_pixels(view))
    points = origins + 2.5 * directions
    local = (np.concatenate([points, np.ones((len(points), 1))], axis=1) @ np.linalg.inv(view.camera_to_world).T)[:, :3]
    np.testing.assert_allclose(view.depths(points), -local[:, 2], rtol=1e-11)
    np.testing.assert_allclose(view.depths(origins), 0.0, atol=1e-12)


@pytest.mark.parametrize("resolution", [(640, 360), (360, 640), (512, 512)])
def test_field_of_view_spans_the_wider_side(resolution):
    view = View.looking_at((1.0, 2.0, 3.0), (4.0, -1.0, 0.0), resolution, field_of_view=0.9)
    width, height = resolution
    middle = np.array([[0.5 * width, 0.5 * height]])
    assert view.rays(middle)[1] @ view.forward == pytest.approx(1.0, abs=1e-14)
    half = np.array([[0.5 * width, 0.0]]) if width >= height else np.array([[0.0, 0.5 * height]])
    a, b = view.rays(middle - half)[1][0], view.rays(middle + half)[1][0]
    assert np.arccos(a @ b) == pytest.approx(0.9, abs=1e-12)
    assert view.pixels(np.array([[4.0, -1.0, 0.0]])) == pytest.approx(middle, abs=1e-9)


def test_orthographic_scale_is_the_width_in_scene_units():
    view = View.looking_at((0.0, -3.0, 0.0), (0.0, 0.0, 0.0), (200, 100), orthographic_scale=5.0)
    assert view.orthographic
    corners = view.rays(np.array([[0.0, 0.0], [200.0, 0.0], [0.0, 100.0]]))[0]
    np.testing.assert_allclose(corners[1] - corners[0], [5.0, 0.0, 0.0], atol=1e-12)
    np.testing.assert_allclose(corners[2] - corners[0], [0.0, 0.0, 2.5], atol=1e-12)


def test_up_is_up_and_right_is_right():
    view = View.looking_at((0.0, -3.0, 0.0), (0.0, 0.0, 0.0), (100, 100))
    middle, right, up = view.pixels(np.array([[0.0, 0.0, 0.0], [0.1, 0.0, 0.0], [0.0, 0.0, 0.1]]))
    assert right[0] > middle[0]
    assert up[1] > middle[1]


def test_looking_straight_down_has_a_picture():
    view = View.looking_at((1.0, 1.0, 5.0), (1.0, 1.0, 0.0), (50, 50))
    np.testing.assert_allclose(view.camera_to_world[:3, :3] @ view.camera_to_world[:3, :3].T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(view.pixels(np.array([[1.0, 1.0, 0.0]])), [[25.0, 25.0]], atol=1e-10)


def test_points_in_the_plane_of_a_perspective_eye_have_no_picture():
    view = View.looking_at((0.0, -3.0, 0.0), (0.0, 0.0, 0.0), (10, 10))
    assert not np.isfinite(view.pixels(np.array([[1.0, -3.0, 1.0], [0.0, -3.0, 0.0]]))).any()


@pytest.mark.parametrize(("field", "value"), [
    ("camera_to_world", np.eye(3)), ("camera_to_world", np.full((4, 4), np.nan)),
    ("projection", np.eye(5)), ("projection", np.full((4, 4), np.inf)),
    ("resolution", (0, 10)), ("resolution", (10, -1)),
])
def test_unfit_values_are_refused_by_name(field, value):
    fields = {"camera_to_world": np.eye(4), "projection": np.diag([1.0, 1.0, -1.0, 1.0]), "resolution": (8, 8)}
    View(**fields)
    with pytest.raises(ValueError, match=rf"View\.{field} must be"):
        View(**{**fields, field: value})
