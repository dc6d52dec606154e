"""Whole squares: a few faces show what crowds of the mirror's triangles show in a square, exactly where pixels look."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from core.filling import whole_squares
from tests.inputs import shapes
from tests.oracles.judge import compare
from tests.oracles.ray_hits import first_hits
from tests.oracles.true_map import case_of, true_rays, view_rays
from tests.oracles.truth import trace

pytestmark = pytest.mark.thorough

VIEW = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (144, 108), field_of_view=0.5)
ORTHOGRAPHIC = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (144, 108), orthographic_scale=3.0)
ROOM = shapes.combine(shapes.box((0.0, 4.0, 2.0), (9.0, 1.0, 6.0)), shapes.box((0.0, -8.0, 2.0), (9.0, 1.0, 6.0)),
                      shapes.box((-4.0, 0.0, 2.0), (1.0, 9.0, 6.0)), shapes.box((4.0, 0.0, 2.0), (1.0, 9.0, 6.0)))
RAYS = Settings(maximum_memory=1e-4)  # holds hardly a candidate, and leaves everything to rays
POSITIONS, TRIANGLES, NORMALS = shapes.icosphere((0.0, 0.0, 1.0), 0.8, 5)
SMOOTH = TriangleMesh(POSITIONS, TRIANGLES, NORMALS[TRIANGLES])
FACETED = TriangleMesh(POSITIONS, TRIANGLES)


def noisy():
    """A ball whose normals turn by a few degrees from one triangle to the next, each far smaller than a pixel."""
    rng = np.random.default_rng(7)
    turned = NORMALS + rng.normal(0.0, 0.03, NORMALS.shape)
    return TriangleMesh(POSITIONS, TRIANGLES, turned[TRIANGLES])


MIRRORS = {"smooth": SMOOTH, "faceted": FACETED, "noisy": noisy()}


@pytest.mark.parametrize("name", MIRRORS)
@pytest.mark.parametrize("view", [VIEW, ORTHOGRAPHIC], ids=["perspective", "orthographic"])
def test_pixels_show_what_their_rays_meet(name, view):
    mirror = MIRRORS[name]
    mesh = reflect(view, mirror, ROOM, RAYS)
    numbers = compare(view, mirror, mesh, trace(view, mirror, ROOM)).numbers
    assert mesh.counts["crowded"] > 0.9 * mesh.counts["mirror_triangles"]
    # four a square at the most, and parts of the mirror's triangles round its rim
    assert len(mesh.triangles) < 6.5 * mesh.counts["mirror_pixels"] < 0.6 * mesh.counts["mirror_triangles"] * 6.5
    assert numbers["compared"] > 800 and numbers["uncovered"] == numbers["spill_outside"] == 0.0
    # the middles of pixels are a two-hundredth of a pixel beside a corner, over which facets let what is seen leap
    assert numbers["p99"] < (0.3 if name == "faceted" else 0.05) and numbers["maximum"] < 0.5


def test_corners_lie_on_the_mirror_and_have_its_true_rays():
    mesh = reflect(VIEW, SMOOTH, ROOM, RAYS)
    spanning = mesh.triangles[mesh.mirror_face < 0]
    assert len(spanning) > 1000
    corner, source = np.unique(spanning.ravel(), return_index=True)
    # what the eye meets on its way to the corner is the mirror's triangle that it lies on
    origins, directions = view_rays(VIEW, mesh.mirror_position[corner])
    triangle, _ = first_hits(SMOOTH, origins, directions, embree=False)
    place, leaving, _, _ = true_rays(SMOOTH, triangle, origins, directions)
    # a triangle may end a two-hundredth of a pixel before the corner that four faces have in common
    beside = np.abs(place - mesh.mirror_position[corner]).max(axis=1)
    assert (beside < 1e-9).mean() > 0.99 and beside.max() < 1e-5
    # and its ray meets the plane of what it shows there, or what it shows lies on its triangle's rim
    a, b, c = (ROOM.positions[ROOM.triangles[mesh.source_face[mesh.mirror_face < 0][source // 3], k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    with np.errstate(divide="ignore"):
        s = np.einsum("ij,ij->i", a - place, normal) / np.einsum("ij,ij->i", leaving, normal)
    away = np.linalg.norm(place + s[:, None] * leaving - mesh.reflected_position[corner], axis=1)
    weights = mesh.source_weights[mesh.mirror_face < 0].reshape(-1, 3)[source]
    assert ((away < 1e-4) | (weights.min(axis=1) < 1e-12)).all() and (away < 1e-9).mean() > 0.8


def test_squares_that_show_their_middle_beside_its_place_have_four_faces(monkeypatch):
    faces = {}
    for straying in (0.01, 0.25, np.inf):
        monkeypatch.setattr(whole_squares, "STRAYING", straying)
        faces[straying] = len(reflect(VIEW, MIRRORS["noisy"], ROOM, RAYS).triangles)
    assert faces[np.inf] < faces[0.25] < faces[0.01]


def test_squares_do_not_lie_behind_the_mirror(monkeypatch):
    """Where a ring turns away, or passes before itself, a face from one part to the other would lie behind it."""
    case = case_of("torus")

    def sunk() -> float:
        """How far behind the mirror the deepest of many places on faces of squares lies, of its distance."""
        mesh = reflect(case.view, case.mirror, case.scene, RAYS)
        spanning = mesh.triangles[mesh.mirror_face < 0]
        assert len(spanning) > 1000
        weights = np.random.default_rng(3).dirichlet(np.ones(3), (4, len(spanning)))
        spots = np.einsum("sfk,fkx->sfx", weights, mesh.mirror_position[spanning]).reshape(-1, 3)
        origins, directions = view_rays(case.view, spots)
        away = np.linalg.norm(spots - origins, axis=1)
        return ((away - first_hits(case.mirror, origins, directions)[1]) / away).max()
    assert sunk() < 4.0 * whole_squares.GAP
    monkeypatch.setattr(whole_squares.Holders, "_uneven", lambda self, holder, spots: np.zeros(len(holder), dtype=bool))
    assert sunk() > 10.0 * whole_squares.GAP
