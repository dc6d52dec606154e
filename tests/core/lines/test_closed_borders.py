"""Faces that lie side by side and show one surface going on share their vertices: by hand, and in results."""
import numpy as np
import pytest

from core import ReflectionMesh, TriangleMesh, View, reflect, with_borders_closed
from core.geometry import doubled_areas, shared_edges
from tests.inputs import dense_scenes, scenes

VIEW = View.looking_at((0.0, 0.0, 10.0), (0.0, 0.0, 0.0), (1000, 1000), up=(0.0, 1.0, 0.0))
BORDERS_OF_A_SQUARE = 4


def sheet(places, faces, source_face, points=None) -> ReflectionMesh:
    """A result in the plane z = 0, seen from above, whose faces show triangles of a scene that lies there too."""
    places = np.array(places, dtype=np.float64)
    points = places if points is None else np.array(points, dtype=np.float64)
    faces, source_face = np.array(faces), np.array(source_face)
    return ReflectionMesh(places, faces, points, places, np.ones(len(places)), np.ones(len(places), dtype=np.int8),
                          source_face, np.broadcast_to(np.eye(3), (len(faces), 3, 3)).copy(),
                          np.zeros(len(faces), dtype=np.int64))


def scene(*corners) -> TriangleMesh:
    return TriangleMesh(np.array(corners, dtype=np.float64).reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))


def borders(mesh: ReflectionMesh) -> int:
    _, _, edge = shared_edges(mesh.triangles)
    return int((np.bincount(edge.ravel()) == 1).sum())


LOWER, UPPER = ((0, 0, 0), (1, 0, 0), (0, 1, 0)), ((1, 0, 0), (1, 1, 0), (0, 1, 0))
STANDING = ((1, 0, 0), (1, 0, 1), (0, 1, 0))
HALVES = [*LOWER, *UPPER]


@pytest.mark.parametrize("what, other, owner, apart, expected", [
    ("goes on", UPPER, [0, 0], 0.0, BORDERS_OF_A_SQUARE),
    ("another object", UPPER, [0, 1], 0.0, 6),
    ("a crease", STANDING, [0, 0], 0.0, 6),
    ("far behind", UPPER, [0, 0], 0.5, 6)])
def test_two_halves_of_a_square_become_one_where_the_surface_goes_on(what, other, owner, apart, expected):
    points = np.array(HALVES, dtype=np.float64)
    points[3:, 2] -= apart
    halves = sheet(HALVES, [[0, 1, 2], [3, 4, 5]], [0, 1], points)
    closed = with_borders_closed(halves, VIEW, scene(LOWER, other), np.array(owner))
    assert borders(halves) == 6 and borders(closed) == expected, what
    assert len(closed.positions) == (4 if expected == BORDERS_OF_A_SQUARE else 6)


def test_a_face_is_split_at_vertices_on_its_side_and_shows_what_it_did():
    """Its neighbours are three, of which two end in the middle of its side, in turn."""
    third = [(1 - share, share, 0) for share in (0, 1 / 3, 2 / 3, 1)]
    places = [*LOWER, *(corner for start, end in zip(third, third[1:]) for corner in (start, (1, 1, 0), end))]
    mesh = sheet(places, np.arange(12).reshape(-1, 3), [0, 1, 1, 1])
    closed = with_borders_closed(mesh, VIEW, scene(LOWER, UPPER), np.zeros(2, dtype=int))
    assert borders(closed) == BORDERS_OF_A_SQUARE and len(closed.triangles) == 6 and len(closed.positions) == 6
    of_lower = closed.source_face == 0
    shown = np.einsum("fck,ki->fci", closed.source_weights[of_lower], np.array(LOWER, dtype=np.float64))
    np.testing.assert_allclose(shown, closed.reflected_position[closed.triangles[of_lower]], atol=1e-12)
    area = doubled_areas(closed.positions[closed.triangles][:, :, :2])
    assert (area > 0.0).all() and area.sum() == pytest.approx(2.0)


@pytest.mark.thorough
@pytest.mark.parametrize("given", [scenes.sphere((512, 512)), dense_scenes.posts_in_water((256, 256))],
                         ids=lambda given: given.name)
def test_results_cover_the_same_with_fewer_borders(given):
    mesh, owner = reflect(given.view, given.mirror, given.scene), np.zeros(len(given.scene.triangles), dtype=int)
    closed = with_borders_closed(mesh, given.view, given.scene, owner)
    before, after = (np.abs(doubled_areas(given.view.pixels(part.positions)[part.triangles])).sum()
                     for part in (mesh, closed))
    assert abs(after - before) < 1e-4 * before
    assert borders(closed) < 0.9 * borders(mesh)
    assert (closed.source_weights >= 0.0).all() and np.allclose(closed.source_weights.sum(axis=2), 1.0)
