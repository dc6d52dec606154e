"""A ball against Alhazen's problem: where on a sphere is a point seen? By bisection in the plane through the centre."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from tests.inputs import shapes

pytestmark = pytest.mark.slow

CENTRE, RADIUS = np.array([0.3, -0.2, 1.1]), 0.9


def alhazen(towards_eye, points):
    """Where on the unit sphere about the origin `points` (n, 3) are seen; `towards_eye` gives directions to the eye.

    At the angle a from the eye's side, the tangents' angles of incidence and reflection balance in one place only.
    """
    eye = towards_eye(np.zeros((1, 3)))[0]
    first = np.broadcast_to(eye / np.linalg.norm(eye), points.shape)
    across = points - (points * first).sum(axis=1, keepdims=True) * first
    second = across / np.linalg.norm(across, axis=1, keepdims=True)
    low, high = np.zeros(len(points)), np.arctan2((points * second).sum(axis=1), (points * first).sum(axis=1))
    for _ in range(80):
        angle = 0.5 * (low + high)
        normal = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * second
        tangent = -np.sin(angle)[:, None] * first + np.cos(angle)[:, None] * second
        balance = sum((unit(way) * tangent).sum(axis=1) for way in (towards_eye(normal), points - normal))
        low, high = np.where(balance > 0.0, angle, low), np.where(balance > 0.0, high, angle)
    return normal


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def ball_case(orthographic):
    rng = np.random.default_rng(11)
    middles = np.repeat(CENTRE + unit(rng.normal(size=(80, 3))) * rng.uniform(2.0, 5.0, (80, 1)), 3, axis=0)
    points = middles + rng.normal(scale=0.15, size=(240, 3))
    scene = TriangleMesh(points, np.arange(240).reshape(-1, 3))
    view = View.looking_at(CENTRE + [0.5, -4.0, 1.5], CENTRE, (512, 512), field_of_view=0.6,
                           orthographic_scale=2.2 if orthographic else 0.0)

    def towards_eye(places):
        if orthographic:
            return np.broadcast_to(-view.forward, places.shape)
        return (view.eye - CENTRE) / RADIUS - places

    local = (points - CENTRE) / RADIUS
    seen = alhazen(towards_eye, local)
    # Near the outline the triangles of the ball show the eye less than the ball does.
    good = ((unit(towards_eye(seen)) * seen).sum(axis=1) > 0.25) & ((unit(local - seen) * seen).sum(axis=1) > 0.25)
    return view, scene, CENTRE + RADIUS * seen, good


@pytest.mark.parametrize("orthographic", [False, True])
def test_images_of_points_in_a_ball_approach_alhazens_with_the_square_of_its_triangles(orthographic):
    view, scene, expected, good = ball_case(orthographic)
    np.testing.assert_array_less(60, good.sum())
    errors = []
    for subdivisions in (2, 3, 4, 5):
        mirror = shapes.combine(shapes.icosphere(CENTRE, RADIUS, subdivisions))
        mesh = reflect(view, mirror, scene, Settings(tolerance=0.1))
        gap = np.linalg.norm(mesh.reflected_position[:, None] - scene.positions[good], axis=2)
        away = np.linalg.norm(mesh.mirror_position[:, None] - expected[good], axis=2)
        errors.append(np.where(gap < 1e-12, away, np.inf).min(axis=0))
    errors = np.array(errors) / RADIUS
    # The edges of the coarsest ball are 0.3 long and halve each time.
    assert errors[0].max() < 0.1
    root = np.sqrt((errors**2).mean(axis=1))
    np.testing.assert_allclose(root[:-1] / root[1:], 4.0, atol=0.9)
    assert errors[3].max() < 1.5e-3


@pytest.mark.parametrize("orthographic", [False, True])
def test_each_point_is_seen_in_one_place_of_a_ball(orthographic):
    view, scene, _, good = ball_case(orthographic)
    mesh = reflect(view, shapes.combine(shapes.icosphere(CENTRE, RADIUS, 3)), scene, Settings(tolerance=0.1))
    pixels = view.pixels(mesh.mirror_position)
    for point in scene.positions[good]:
        images = pixels[np.linalg.norm(mesh.reflected_position - point, axis=1) < 1e-12]
        assert len(images) >= 1
        assert np.ptp(images, axis=0).max() < 0.5
