"""A small scene for calls by the core's door: a bent mirror on the ground, its like behind it, and an eye before it."""
import numpy as np

from core import TriangleMesh, View

POSITIONS = np.array([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.25], [-1.0, 1.0, 0.0]])
TRIANGLES = np.array([[0, 1, 2], [0, 2, 3]])
MIRROR = TriangleMesh(POSITIONS, TRIANGLES)
SCENE = TriangleMesh(0.5 * POSITIONS + [0.0, 3.0, 2.0], TRIANGLES)
VIEW = View.looking_at((0.0, -4.0, 3.0), (0.0, 0.0, 0.0), (64, 64))


def looking(**given):
    return View.looking_at(**{"eye": (0, -4, 3), "target": (0, 0, 0), "resolution": (64, 64), **given})
