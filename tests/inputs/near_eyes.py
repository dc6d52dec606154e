"""Eyes close above mirrors: at random, and above one bent triangle."""
import numpy as np

from core import TriangleMesh, View
from tests.fuzz.drawing.diffuse import drawn_scene
from tests.fuzz.drawing.mirrors import drawn_mirror


def bent_triangle():
    """A triangle whose normals lean outwards by a third of a radian and more."""
    normals = np.array([[(-0.4, -0.3, 1.0), (0.4, -0.3, 1.0), (0.0, 0.5, 1.0)]])
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    corners = np.array([(-2.0, -1.0, 0.0), (2.0, -1.0, 0.0), (0.0, 3.0, 0.0)])
    return TriangleMesh(corners, np.array([(0, 1, 2)]), normals)


def tilted_triangle():
    """A flat triangle that stands steeply."""
    return TriangleMesh(np.array([(-0.429, -1.0, 0.707), (-0.143, -1.0, 0.609), (-0.429, -0.875, 0.567)]),
                        np.array([(0, 1, 2)]))


def above_tilted(height):
    """An eye so high before the middle of that triangle, which looks along it with a wide lens."""
    a, b, c = tilted_triangle().positions
    normal = np.cross(c - a, b - a) / np.linalg.norm(np.cross(c - a, b - a))
    eye = np.array((-0.34, -1.0, 0.675))
    eye += (height - (eye - a) @ normal) * normal
    return View.looking_at(eye, eye - (0.12, -0.71, 0.69), (160, 120), up=(-0.99, -0.16, 0.0), field_of_view=2.4)


def drawn(seed):
    """A mirror, an eye from a ten-thousandth to a tenth above a place on it, looking along it, and a scene."""
    rng = np.random.default_rng(seed)
    _, mirror = drawn_mirror(rng)
    corners = mirror.positions[mirror.triangles[rng.integers(len(mirror.triangles))]]
    up = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    up *= rng.choice([-1.0, 1.0]) / max(np.linalg.norm(up), 1e-9)
    place = rng.dirichlet((1.0, 1.0, 1.0)) @ corners
    height = 10.0 ** rng.uniform(-4.0, -1.0)
    along = np.cross(up, rng.normal(0.0, 1.0, 3))
    along /= np.linalg.norm(along)
    view = View.looking_at(place + height * up, place + rng.choice([0.01, 0.1, 1.0]) * along, (128, 96),
                           up=rng.normal(0.0, 1.0, 3), field_of_view=float(rng.choice([0.2, 0.7, 1.2, 2.0, 2.8])))
    _, scene = drawn_scene(rng, view, mirror)
    return view, mirror, scene
