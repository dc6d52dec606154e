"""How mirrors must stand to show what they show, against mirrors that stand so."""
import numpy as np

from core import View, reflecting_normals
from core.result import halfway


def test_a_plane_is_found_from_what_it_shows():
    """Seen by mirrored images, from an eye and along parallel rays."""
    rng = np.random.default_rng(4)
    normal = np.array((0.3, -0.5, 0.8)) / np.linalg.norm((0.3, -0.5, 0.8))
    spots = rng.normal(size=(200, 3))
    spots -= (spots @ normal)[:, None] * normal
    for scale in (0.0, 3.0):
        view = View.looking_at((0.5, -2.0, 4.0), (0.0, 0.0, 0.0), (64, 64), orthographic_scale=scale)
        sight = view.directions(spots)
        onwards = sight - 2.0 * (sight @ normal)[:, None] * normal
        shown = spots + onwards * rng.uniform(0.1, 3.0, (200, 1))
        assert np.abs(reflecting_normals(view, spots, shown) - normal).max() < 1e-12
        # on the mirror itself
        towards = -sight / np.linalg.norm(sight, axis=1, keepdims=True)
        assert np.abs(reflecting_normals(view, spots, spots) - towards).max() < 1e-12


def test_what_goes_straight_on_meets_no_mirror():
    assert (halfway(np.array([[1.0], [0.0], [0.0]]), np.array([[2.0], [0.0], [0.0]])) == 0.0).all()
