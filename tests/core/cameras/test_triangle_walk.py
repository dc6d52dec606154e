"""Places beside the mirror are brought back to what the eye sees nearest."""
import numpy as np

from core import TriangleMesh, View
from core.cameras import MirrorMap, brought_back, distance_from

BESIDE = 1.5  # pixels
ALONG = np.linspace(0.0, 1.0, 401)[:, None]


def test_a_place_beside_a_triangle_goes_to_what_is_seen_nearest_of_its_rim():
    """However flat the triangle is seen: in space that may be far away. By as many places along the rim."""
    rng = np.random.default_rng(71)
    eye = np.array((0.0, -4.0, 0.0))
    view = View.looking_at(eye, (0, 0, 0), (200, 200))
    count = 0
    for slope in np.repeat((1.0, 0.1, 0.03), 20):
        corners = rng.uniform(-0.8, 0.8, (3, 3))
        corners[:, 2] = slope * (corners[:, 2] + 0.2 * (corners[:, 1] - eye[1]))
        mirror_map = MirrorMap(view, TriangleMesh(corners, np.array([[0, 1, 2]])))
        sides = np.roll(corners, -1, axis=0) - corners
        rim = view.pixels((corners[:, None] + ALONG * sides[:, None]).reshape(-1, 3))
        uv = rng.dirichlet((1.0, 1.0, 1.0), 400).T[:2] * 4.0 - 1.0
        face = np.zeros(400, dtype=np.int64)
        places = mirror_map.places(face, uv)
        nearest = np.linalg.norm(view.pixels(places.T)[:, None] - rim[::10], axis=2).min(axis=1)
        outside = np.minimum(uv.min(axis=0), 1.0 - uv.sum(axis=0)) < 0.0
        face, places = (one[..., outside & (nearest < BESIDE)] for one in (face, places))
        if not len(face):
            continue
        found, away = brought_back(mirror_map, face, places)
        least = np.linalg.norm(view.pixels(places.T)[:, None] - rim, axis=2).min(axis=1)
        moved = np.linalg.norm(view.pixels(found.T) - view.pixels(places.T), axis=1)
        assert (moved - least).max() < 0.3
        np.testing.assert_allclose(moved, away)
        assert distance_from(mirror_map, face, found).max() < 1e-12
        count += len(face)
    assert count > 300
