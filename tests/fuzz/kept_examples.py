"""Configurations that failed once, as small as they could be made and with round numbers; each says how it failed."""
from __future__ import annotations

import numpy as np

from core import Settings, TriangleMesh, View
from tests.fuzz.drawing.configurations import Configuration
from tests.fuzz.drawing.mirrors import vertex_normals
from tests.inputs import shapes


def _touched_strip() -> Configuration:
    """A triangle shares an edge with the last of four: nothing is left to be cut off behind the mirror, and nothing
    could not be joined."""
    mirror = TriangleMesh([[-1.0, -0.2, 0.29], [-0.6, -0.2, 0.1], [-1.0, 0.2, 0.29], [-0.6, 0.2, 0.1],
                           [-1.0, 0.6, 0.19], [-0.6, 0.6, 0.0], [-1.0, 1.0, 0.0]],
                          [[0, 1, 2], [1, 3, 2], [3, 5, 4], [4, 5, 6]])
    view = View.looking_at((-1.03, -1.56, 0.71), (0.11, -0.19, 0.41), (200, 200), field_of_view=1.5,
                           up=(0.42, -0.45, 0.86))
    scene = TriangleMesh([[-0.29, 1.8, 0.05], [-0.6, 0.6, 0.0], [-1.0, 0.6, 0.19]], [[0, 1, 2]])
    return Configuration("touched strip", view, mirror, scene, Settings(), flat=True)


def _touched_pair() -> Configuration:
    """The same with two triangles."""
    mirror = TriangleMesh([[-0.6, 0.2, 0.1], [-1.0, 0.6, 0.19], [-0.6, 0.6, 0.0], [-1.0, 1.0, 0.0]],
                          [[0, 2, 1], [1, 2, 3]])
    view = View.looking_at((-1.0, -1.6, 0.7), (0.2, 0.0, 0.4), (64, 64), field_of_view=1.5, up=(0.5, -0.3, 0.8))
    scene = TriangleMesh([[-0.29, 1.8, 0.05], [-0.6, 0.6, 0.0], [-1.0, 0.6, 0.19]], [[0, 1, 2]])
    return Configuration("touched pair", view, mirror, scene, Settings(), flat=True)


def _normals_in_any_order() -> Configuration:
    """Flat normals were worked out from the corners as listed, and differed in the last bit."""
    mirror = TriangleMesh([[0.8467, 0.1355, -0.7934], [0.228, -0.3135, -0.7113], [-2.3463, 0.7164, -0.7402]],
                          [[0, 1, 2]])
    view = View.looking_at((6.7, -0.1, 4.3), (0.1, -0.2, -0.1), (64, 64), field_of_view=0.3, up=(-0.5, -0.5, 0.7))
    scene = TriangleMesh([[0.31, -1.105, -0.725], [0.383, 1.049, 0.194], [0.542, 0.28, -1.294]], [[0, 1, 2]])
    return Configuration("normals in any order", view, mirror, scene, Settings(), flat=True)


def _normals_in_any_order_twice() -> Configuration:
    """The same after two bounces, in another number of cameras."""
    mirror = TriangleMesh(
        [[-0.2, 0.6, -0.0477], [0.2, 0.6, 0.0377], [0.6, 0.6, -0.0463], [1.0, 0.6, 0.0467], [-0.6, 1.0, 0.1579],
         [-0.2, 1.0, -0.0178], [0.2, 1.0, -0.0237], [0.6, 1.0, 0.0861]],
        [[0, 5, 4], [0, 1, 5], [1, 6, 5], [1, 2, 6], [2, 7, 6], [2, 3, 7]])
    view = View.looking_at((-5.3, -3.0, 5.2), (0.0, -0.4, -0.2), (64, 64), field_of_view=0.7, up=(0.7, -0.4, 0.6))
    scene = TriangleMesh([[3.6, 0.66, 1.84], [2.98, 0.36, 2.47], [3.71, -1.12, 2.28]], [[0, 1, 2]])
    return Configuration("normals in any order, twice", view, mirror, scene, Settings(depth=2), flat=True)


def _caustic_on_an_edge() -> Configuration:
    """The caustic crosses the diagonal of a quad: a point of it was put on one of the two triangles, and off the
    other."""
    positions = np.array([[0.2, -0.6, -0.096], [0.2, -0.2, 0.0], [0.6, -0.2, 0.096]])
    normals = np.array([[[-0.112, -0.337, 0.935], [-0.337, -0.112, 0.935], [-0.118, -0.118, 0.986]]])
    view = View.looking_at((4.8, 5.9, -2.5), (0.3, -0.1, 0.2), (30, 120), field_of_view=1.5, up=(-0.7, 0.2, -0.7))
    scene = TriangleMesh([[1.407, -1.594, 0.053], [1.042, -0.677, -1.459], [-0.632, -0.359, -0.862],
                          [-0.267, -1.276, 0.65]], [[0, 1, 2], [0, 2, 3]])
    return Configuration("caustic on an edge", view, TriangleMesh(positions, [[0, 2, 1]], normals), scene, Settings())


def _caustic_after_two_bounces() -> Configuration:
    """As above, in a saddle that is seen in itself."""
    positions = np.array([[0.2, -0.2, 0.0], [0.2, 0.2, 0.0], [0.2, 0.6, -0.096], [0.6, 0.2, 0.096], [0.6, 0.6, 0.0]])
    normals = np.array([[[-0.233, 0.0, 0.972], [-0.233, 0.0, 0.972], [-0.232, 0.116, 0.966]],
                        [[-0.232, 0.116, 0.966], [-0.227, 0.227, 0.947], [-0.227, 0.227, 0.947]]])
    view = View.looking_at((0.5, 7.7, -2.0), (0.3, 0.0, 0.1), (64, 64), field_of_view=2.8, up=(-0.7, 0.2, 0.7))
    scene = TriangleMesh([[0.695, 0.756, -0.255], [-0.888, -2.723, -0.1], [4.285, -3.143, 1.804]], [[0, 1, 2]])
    return Configuration("caustic after two bounces", view, TriangleMesh(positions, [[0, 3, 1], [1, 4, 2]], normals),
                         scene, Settings(depth=2))


def _parallel_eye_in(surface: tuple, eye, target, name: str) -> Configuration:
    """The eye of a parallel view has no place from which a side could be told: in a closed mirror it was refused, or
    saw a part of what it should."""
    view = View.looking_at(eye, target, (64, 64), orthographic_scale=1.0, up=(1.0, 0.1, 0.2))
    scene = shapes.combine(shapes.quad((0.1, -0.2, 0.3), (0.4, 0.0, 0.1), (0.0, 0.4, 0.1)))
    return Configuration(name, view, shapes.combine(surface), scene, Settings())


def _crowd() -> Configuration:
    """Two triangles that see each other from close by, and a third that stands on them: work without an end."""
    mirror = TriangleMesh([[-0.6, -0.2, 0.0594], [-0.2, -0.2, 0.0967], [-0.6, 0.2, 0.0563], [-0.2, 0.2, -0.1907]],
                          [[0, 1, 2], [1, 3, 2]])
    view = View.looking_at((-0.5, 0.0, -0.2), (0.5, 0.3, 0.1), (200, 200), orthographic_scale=2.0,
                           up=(-0.3, 0.1, 0.9))
    scene = TriangleMesh([[0.115, -0.01, -0.383], [-0.6, -0.2, 0.0594], [-1.0, -0.2, -0.0514]], [[0, 1, 2]])
    return Configuration("crowd", view, mirror, scene, Settings(depth=2), flat=True)


def _crowd_of_bent_normals() -> Configuration:
    """The same in two faces of a pipe whose normals turn the rays into it."""
    positions = np.array([[-0.35, 0.606, 1.0], [0.35, 0.606, -1.0], [0.35, 0.606, 1.0], [0.7, 0.0, -1.0],
                          [0.7, 0.0, 1.0]])
    normals = np.array([[[0.891, 0.406, 0.201], [0.679, 0.693, -0.244], [0.884, -0.31, 0.35]],
                        [[0.532, 0.665, -0.524], [-0.545, 0.749, -0.376], [0.679, 0.693, -0.244]]])
    view = View.looking_at((-0.33, -0.07, 0.37), (0.1, 0.53, -0.31), (64, 64), orthographic_scale=2.0,
                           up=(-0.76, -0.16, -0.63))
    scene = TriangleMesh([[-1.554, -8.568, 1.459], [-3.614, -9.657, 0.416], [-5.038, -7.672, 1.156],
                          [-2.342, -3.507, 3.982], [-4.403, -4.596, 2.939], [-5.827, -2.611, 3.679]],
                         [[3, 5, 4], [0, 2, 1]])
    return Configuration("crowd of bent normals", view, TriangleMesh(positions, [[3, 2, 4], [1, 0, 2]], normals),
                         scene, Settings(depth=2))


def _eye_in_a_facet() -> Configuration:
    """The eye lies in the plane of one side of a pyramid, which is seen edge on: a number too large for its type."""
    positions, _, _ = shapes.quad((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    positions = np.concatenate([positions, [[0.2, 0.1, 0.3]]])
    triangles = np.array([[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]])
    mirror = TriangleMesh(positions, triangles, vertex_normals(positions, triangles)[triangles])
    view = View.looking_at((-1.0, 0.1, -0.3), (0.0, 0.0, 0.0), (64, 64), field_of_view=1.5)
    scene = TriangleMesh([[-1.0, -1.6, -1.7], [0.2, -0.3, -0.6], [0.2, 0.1, 0.3]], [[0, 1, 2]])
    return Configuration("eye in a facet", view, mirror, scene, Settings(method="POINTS"))


def _parallel_in_another_unit() -> Configuration:
    """Parallel rays of unit length were taken for rays as long as the way from the eye."""
    mirror = TriangleMesh([[0.6, 0.2, 0.2083], [0.6, 0.6, 0.375], [1.0, 0.6, 0.7083]], [[0, 2, 1]])
    view = View.looking_at((-0.8, 3.5, 1.7), (0.2, 0.0, 0.0), (30, 120), field_of_view=0.7, up=(-0.9, -0.3, 0.2))
    scene = TriangleMesh([[1.732, -0.431, -0.361], [-1.226, -2.011, 2.379], [-1.195, -1.3, -0.6]], [[0, 1, 2]])
    return Configuration("parallel in another unit", view, mirror, scene,
                         Settings(placement="VIRTUAL", method="PARALLEL"), flat=True)


def _behind_a_fold() -> Configuration:
    """A triangle showed in one facet of a bowl what the other hides."""
    mirror = TriangleMesh([[-0.6, 0.2, 0.2415], [-0.2, 0.2, 0.0483], [-0.2, 0.6, 0.2415], [0.2, 0.6, 0.2415]],
                          [[0, 1, 2], [1, 3, 2]])
    view = View.looking_at((0.33, 0.38, 0.05), (-0.04, 0.43, -0.88), (64, 64), field_of_view=2.8,
                           up=(-0.92, 0.08, 0.37))
    scene = TriangleMesh([[-0.931, -0.131, 0.303], [-0.874, 1.616, 1.531], [0.086, 0.953, 0.572]], [[0, 1, 2]])
    return Configuration("behind a fold", view, mirror, scene, Settings(), flat=True)


def _behind_the_next_side() -> Configuration:
    """Two triangles of a box, which meet at a corner: what the one hides was shown in the other."""
    mirror = TriangleMesh([[-1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [1.0, 1.0, 1.0]],
                          [[0, 1, 2], [1, 3, 4]])
    view = View.looking_at((-0.42, 0.23, 0.14), (-0.02, 0.17, -0.77), (64, 64), field_of_view=1.5,
                           up=(-0.89, -0.27, -0.38))
    scene = TriangleMesh([[1.9, -0.7, 4.3], [-0.4, 3.9, 0.3], [-3.2, -0.7, -3.4]], [[0, 2, 1]])
    return Configuration("behind the next side", view, mirror, scene, Settings(), flat=True)


def _beyond_the_rim() -> Configuration:
    """A corner of an outline lay beside the mirror, beyond its rim."""
    positions = np.array([[-0.7, 0.0, -1.0], [-0.7, 0.0, 1.0], [0.0, -0.7, 1.0]])
    normals = np.array([[[-0.949, -0.316, 0.0], [-0.316, -0.949, 0.0], [-0.949, 0.316, 0.0]]])
    view = View.looking_at((-5.4, -5.5, 2.1), (-0.2, 0.0, -0.4), (64, 64), field_of_view=2.8, up=(-0.1, -0.3, -0.9))
    scene = TriangleMesh([[-2.499, -1.348, -6.317], [-5.601, -1.968, -4.497], [-4.328, -0.042, -1.67]], [[0, 2, 1]])
    return Configuration("beyond the rim", view, TriangleMesh(positions, [[0, 2, 1]], normals), scene, Settings())


BALL, BOX = shapes.icosphere((0.0, 0.0, 0.0), 1.0, 1), shapes.box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
EXAMPLES = {one.name: one for one in (
    _touched_strip(), _touched_pair(), _normals_in_any_order(), _normals_in_any_order_twice(), _caustic_on_an_edge(),
    _caustic_after_two_bounces(), _parallel_eye_in(BALL, (0.1, -0.3, 0.2), (0.2, 1.0, 0.3), "parallel eye in a ball"),
    _parallel_eye_in(BOX, (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), "parallel eye in the middle of a box"), _crowd(),
    _crowd_of_bent_normals(), _eye_in_a_facet(), _parallel_in_another_unit(), _behind_a_fold(), _behind_the_next_side(),
    _beyond_the_rim())}
