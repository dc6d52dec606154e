"""Pieces of what a mirror shows, against the mirrored scene of a flat mirror and against every pair."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, picture_pieces, reflect

VIEW = View.looking_at((0.3, -4.0, 3.0), (0.0, 0.0, 0.0), (320, 240))
WIDE = TriangleMesh(np.array([[-9.0, -9, 0], [9, -9, 0], [9, 9, 0], [-9, 9, 0]]), np.array([[0, 1, 2], [0, 2, 3]]))
SHEET = TriangleMesh(np.array([[-1.5, -0.5, 0.5], [1.2, -0.4, 0.3], [1.0, 1.9, 1.5], [-0.8, 1.0, 2.0]]),
                     np.array([[0, 1, 2], [0, 2, 3]]))
TURNED = np.array([1.0, 1.0, -1.0])


def mirrored_pixels(scene, face, weights):
    """Where a flat mirror at z = 0 shows points of the scene."""
    points = np.einsum("nk,nkc->nc", weights, scene.positions[scene.triangles[face]])
    return VIEW.pixels(points * TURNED)


def inside(count: int) -> np.ndarray:
    """Barycentric coordinates of random points, the same of each triangle (count, 3)."""
    return np.random.default_rng(4).dirichlet((1.0, 1.0, 1.0), count)


@pytest.mark.parametrize("placement", ["SURFACE", "LAYERED", "VIRTUAL"])
def test_a_flat_mirror_shows_every_point_of_a_piece_where_the_mirrored_scene_has_it(placement):
    mesh = reflect(VIEW, WIDE, SHEET, Settings(placement=placement, tolerance=0.25))
    pieces = picture_pieces(VIEW, mesh)
    assert np.abs(np.linalg.det(pieces.weights)).sum() == pytest.approx(2.0, abs=1e-6)
    for share in inside(7):
        shown = np.einsum("k,nkc->nc", share, pieces.pixels)
        off = shown - mirrored_pixels(SHEET, pieces.face, np.einsum("k,nkc->nc", share, pieces.weights))
        assert np.linalg.norm(off, axis=1).max() < 0.36


def test_a_face_that_is_seen_at_an_angle_is_split():
    # the virtual image of a flat mirror is exact on whole faces, and linear on none of them
    mesh = reflect(VIEW, WIDE, SHEET, Settings(placement="VIRTUAL"))
    coarse, fine = picture_pieces(VIEW, mesh, 1e9), picture_pieces(VIEW, mesh)
    middle = np.full((len(coarse.face), 3), 1.0 / 3.0)
    off = coarse.pixels.mean(axis=1) - mirrored_pixels(SHEET, coarse.face, np.einsum("nk,nkc->nc", middle,
                                                                                     coarse.weights))
    assert np.linalg.norm(off, axis=1).max() > 3.0
    assert len(fine.face) > 4 * len(coarse.face)


def two_mirrors() -> TriangleMesh:
    """One mesh of two flat mirrors: a large one on the ground, and a small one that leans beside it."""
    low = np.array([[-3.0, -3, 0], [3, -3, 0], [3, 3, 0], [-3, 3, 0]])
    lean = np.array([[-0.6, 2.2, 0.4], [0.6, 2.2, 0.4], [0.6, 2.6, 2.4], [-0.6, 2.6, 2.4]])
    return TriangleMesh(np.concatenate((low, lean)), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))


def test_of_several_images_the_first_is_the_largest():
    sheet = TriangleMesh(np.array([[-0.5, 0.2, 0.5], [0.5, 0.2, 0.5], [0.5, 1.0, 0.7], [-0.5, 1.0, 0.7]]),
                         np.array([[0, 1, 2], [0, 2, 3]]))
    pieces = picture_pieces(VIEW, reflect(VIEW, two_mirrors(), sheet))
    u, v = pieces.pixels[:, 1] - pieces.pixels[:, 0], pieces.pixels[:, 2] - pieces.pixels[:, 0]
    area = np.bincount(pieces.image, np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))
    assert len(area) >= 2 and (np.diff(area) <= 0.0).all() and area[1] > 100.0
    first = pieces.image == 0
    off = pieces.pixels[first].mean(axis=1) - mirrored_pixels(sheet, pieces.face[first],
                                                              pieces.weights[first].mean(axis=1))
    assert np.linalg.norm(off, axis=1).max() < 1.0


@pytest.mark.parametrize("hidden", [False, True])
def test_an_image_that_something_nearer_hides_comes_after_those_that_are_seen(hidden):
    """A screen below a sheet hides it in the large mirror on the ground, but not in the small one that leans."""
    view = View.looking_at((0.3, -4.0, 3.0), (0.0, 1.0, 0.5), (320, 240))
    sheet = np.array([[-0.3, 0.6, 0.6], [0.3, 0.6, 0.6], [0.3, 1.0, 0.7], [-0.3, 1.0, 0.7]])
    screen = np.array([[-0.9, -0.2, 0.3], [0.9, -0.2, 0.3], [0.9, 1.4, 0.3], [-0.9, 1.4, 0.3]])
    scene = TriangleMesh(np.concatenate((sheet, screen if hidden else screen + (0.0, 0.0, 1.0))),
                         np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]]))
    pieces = picture_pieces(view, reflect(view, two_mirrors(), scene))
    face, weights = np.repeat([0, 1], 200), inside(400)
    found = pieces.holding(face, weights)
    points = np.einsum("nk,nkc->nc", weights, scene.positions[scene.triangles[face]])
    across = np.cross((1.0, 0.0, 0.0), (0.0, 0.4, 2.0)) / np.hypot(0.4, 2.0)
    leaning = points - 2.0 * ((points - (0.0, 2.2, 0.4)) @ across)[:, None] * across
    shares = np.linalg.solve(pieces.weights[found].swapaxes(1, 2), weights[..., None])
    shown = (shares * pieces.pixels[found]).sum(axis=1)
    assert (found >= 0).all()
    assert np.linalg.norm(shown - view.pixels(leaning if hidden else points * TURNED), axis=1).max() < 1.0


def test_what_lies_beside_the_picture_is_left_out():
    far = TriangleMesh(SHEET.positions + (30.0, 0.0, 0.0), SHEET.triangles)
    both = TriangleMesh(np.concatenate((SHEET.positions, far.positions)),
                        np.concatenate((SHEET.triangles, far.triangles + 4)))
    pieces = picture_pieces(VIEW, reflect(VIEW, TriangleMesh(WIDE.positions * 9.0, WIDE.triangles), both))
    assert set(pieces.face.tolist()) == {0, 1}


@pytest.mark.thorough
def test_the_piece_that_holds_a_point_is_found_as_by_trying_all():
    pieces = picture_pieces(VIEW, reflect(VIEW, two_mirrors(), SHEET))
    rng = np.random.default_rng(7)
    face, weights = rng.integers(0, 3, 400), rng.dirichlet((1.0, 1.0, 1.0), 400)
    found = pieces.holding(face, weights)
    shares = np.einsum("nc,kcj->nkj", weights, np.linalg.inv(pieces.weights))
    holds = (shares > -1e-9).all(axis=2) & (face[:, None] == pieces.face)
    rank = np.where(holds, pieces.image, 10**6).min(axis=1)
    assert ((found >= 0) == holds.any(axis=1)).all() and 100 < (found >= 0).sum() < 400
    hit = np.flatnonzero(found >= 0)
    assert holds[hit, found[hit]].all() and (pieces.image[found[hit]] == rank[hit]).all()
