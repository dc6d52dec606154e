"""Mirrors whose triangles are smaller than a pixel or two, against ray tracing and closed forms."""
from __future__ import annotations

import numpy as np
import pytest

from core import Settings, TriangleMesh, View, draw, reflect
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.judge import judge
from tests.oracles.truth_bounces import trace_bounces

# the 99th percentile of displacements in pixels, as measured; a pixel of each may be uncovered
MEASURED = {"ball": 0.175, "torus": 0.192, "water": 0.177}


def made(shape: tuple) -> TriangleMesh:
    positions, triangles, normals = (*shape, None)[:3]
    return TriangleMesh(positions, triangles, None if normals is None else normals[triangles])


def dense(name: str) -> tuple[View, TriangleMesh, TriangleMesh]:
    """A view, a mirror with triangles of a pixel or two, and what it shows."""
    case = SCENES[{"ball": "sphere"}.get(name, name)]((224, 224))
    mirror = {"ball": lambda: shapes.uv_sphere((0.0, 0.0, 1.3), 1.0, 128, 128),
              "torus": lambda: shapes.torus((0.0, 0.0, 1.2), 1.0, 0.4, 160, 80),
              "water": lambda: (*shapes.water(6.0, 0.1, 3, 128),)}[name]()
    return case.view, made(mirror), case.scene


@pytest.mark.parametrize("name", MEASURED)
def test_pixels_show_what_a_ray_tracer_sees(name):
    view, mirror, scene = dense(name)
    mesh = reflect(view, mirror, scene)
    assert "cameras" not in mesh.counts  # no part of it is made forward
    numbers = judge(view, mirror, scene, mesh)
    assert numbers["uncovered"] < 0.02 and numbers["compared"] > 5000
    assert numbers["p99"] < 1.3 * MEASURED[name]
    # measured: 0.33 to 0.79
    assert len(mesh.triangles) < 0.9 * mesh.counts["mirror_pixels"]


def wall(cells: int) -> TriangleMesh:
    """An upright flat mirror 2 x 2 in the plane y = 0, of so many cells along each side."""
    x, z = np.meshgrid(np.linspace(-1.0, 1.0, cells + 1), np.linspace(0.0, 2.0, cells + 1))
    positions = np.stack((x, 0.0 * x, z), axis=-1).reshape(-1, 3)
    first = (np.arange(cells)[:, None] * (cells + 1) + np.arange(cells)).ravel()
    a, b, c, d = first, first + 1, first + cells + 2, first + cells + 1
    return TriangleMesh(positions, np.concatenate((np.stack((a, b, c), axis=1), np.stack((a, c, d), axis=1))))


EYE = np.array((0.3, -5.0, 1.4))
FLAT_VIEW = View.looking_at(EYE, (0.0, 0.0, 1.0), (120, 120), field_of_view=0.5)
CARD = TriangleMesh(np.array(((-0.5, -1.5, 0.6), (0.4, -1.5, 0.5), (0.2, -1.2, 1.3))), np.array(((0, 1, 2),)))


def test_a_flat_mirror_shows_the_mirror_image():
    """Each vertex lies where the eye sees its mirror image, whose outline is right to a tenth of a pixel."""
    mesh = reflect(FLAT_VIEW, wall(80), CARD)
    assert "cameras" not in mesh.counts and len(mesh.triangles) > 2
    image = mesh.reflected_position * (1.0, -1.0, 1.0)
    assert np.linalg.norm(FLAT_VIEW.pixels(image) - FLAT_VIEW.pixels(mesh.positions), axis=1).max() < 0.1
    np.testing.assert_allclose(mesh.path_length, np.linalg.norm(mesh.reflected_position - mesh.mirror_position, axis=1),
                               rtol=1e-9)
    corners = FLAT_VIEW.pixels(mesh.positions)[mesh.triangles]
    side = np.diff(corners, axis=1)
    area = 0.5 * np.linalg.det(side)
    true = 0.5 * np.linalg.det(np.diff(FLAT_VIEW.pixels(CARD.positions * (1.0, -1.0, 1.0)), axis=0))
    assert (area > 0.0).all() or (area < 0.0).all()
    assert abs(abs(area.sum()) - abs(true)) < 0.005 * abs(true)
    # the image of a flat mirror is not turned over
    assert (mesh.image_parity == 1).all() and (mesh.bounces == 1).all()


def test_faces_are_large_where_all_is_even_and_meet_without_gaps():
    """No vertex lies within an edge of another face, and the inner edges all have two faces."""
    floor = made(shapes.quad((0.0, -2.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0)))
    mesh = reflect(FLAT_VIEW, wall(80), floor)
    assert len(mesh.triangles) < 0.25 * mesh.counts["mirror_pixels"]
    spots = FLAT_VIEW.pixels(mesh.mirror_position)
    for face in np.unique(mesh.source_face):
        triangles = mesh.triangles[mesh.source_face == face]
        ends = np.sort(np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])]), axis=1)
        edges, count = np.unique(ends, axis=0, return_counts=True)
        assert count.max() == 2
        own = spots[np.unique(triangles)]
        start, way = spots[edges[:, 0]], spots[edges[:, 1]] - spots[edges[:, 0]]
        length = np.linalg.norm(way, axis=1)
        offset = own[None] - start[:, None]
        along = (offset * way[:, None]).sum(axis=2) / length[:, None]
        away = np.abs(offset[..., 0] * way[:, None, 1] - offset[..., 1] * way[:, None, 0]) / length[:, None]
        assert not ((away < 1e-6) & (along > 1e-6) & (along < length[:, None] - 1e-6)).any()


def dish_and_card() -> tuple[View, TriangleMesh, TriangleMesh]:
    """A deep dish that sees itself, and a card before it."""
    view = View.looking_at((0.6, -3.0, 5.5), (0.0, 0.0, 0.4), (100, 100), field_of_view=0.6)
    mirror = made(shapes.bowl((0.0, 0.0, 1.0), 1.0, 1.45, 96, 48))
    return view, mirror, made(shapes.box((0.2, -0.2, 1.6), (0.5, 0.5, 0.2), 0.4))


@pytest.mark.parametrize("depth", [1, 3])
def test_a_dish_sees_itself_as_often_as_is_asked_for(depth):
    view, mirror, scene = dish_and_card()
    mesh = reflect(view, mirror, scene, Settings(depth=depth))
    truth = trace_bounces(view, mirror, scene, mirror, depth)
    drawn = draw(view, mesh.positions, mesh.triangles)
    shown = np.where(drawn.triangle >= 0, mesh.source_face[drawn.triangle], -1)
    bounces = np.where(drawn.triangle >= 0, mesh.bounces[drawn.triangle], 0)
    asked = truth.seen & ~truth.bent
    wrong = asked & ((np.maximum(truth.source, -1) != shown) | ((shown >= 0) & (bounces != truth.bounces)))
    assert wrong.sum() < 0.004 * asked.sum()
    assert mesh.bounces.max(initial=1) <= depth


def test_an_automatic_depth_leaves_next_to_nothing():
    view, mirror, scene = dish_and_card()
    mesh = reflect(view, mirror, scene, Settings(depth=0))
    assert mesh.counts["left_pixels"] < 0.004 * mesh.counts["mirror_pixels"] or mesh.counts["depth"] == 8
    assert mesh.bounces.max() > 1


def test_large_parts_of_a_mirror_are_still_made_forward():
    """A ball of small triangles above a flat part of two: both show what they show alone."""
    ball = made(shapes.uv_sphere((0.0, -0.5, 2.6), 0.4, 96, 96))
    view = View.looking_at((0.3, -5.0, 1.8), (0.0, 0.0, 1.6), (160, 160), field_of_view=0.7)
    floor = made(shapes.quad((0.0, -2.0, 0.0), (8.0, 0.0, 0.0), (0.0, 8.0, 0.0)))
    both = TriangleMesh.joined((wall(1), ball))
    mesh = reflect(view, both, floor, mirrors=both)
    # some of the ball's pixels show the flat part
    assert mesh.counts["mirror_triangles"] == 2 and 0 < mesh.counts["left_pixels"] < 200
    numbers = judge(view, both, floor, mesh)
    assert numbers["uncovered"] < 0.05 and numbers["p99"] < 0.5


def test_a_coarse_tolerance_takes_fewer_rays_and_faces():
    view, mirror, scene = dense("torus")
    fine, coarse = (reflect(view, mirror, scene, Settings(tolerance=tolerance)) for tolerance in (0.5, 4.0))
    assert len(coarse.triangles) < 0.25 * len(fine.triangles)
    assert judge(view, mirror, scene, coarse)["p99"] < 4.0
