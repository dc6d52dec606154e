"""Mirrors that the eye's plane cuts: what lies behind the eye is not seen, and all that lies before it is."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from core.visibility.eye_plane import triangles_before_eye
from tests.inputs import shapes
from tests.oracles.judge import judge

PANES = [shapes.quad(np.random.default_rng(seed).uniform(-1.2, 1.2, 3),
                     *np.random.default_rng(seed).normal(0.0, 0.25, (2, 3))) for seed in range(60)]
ROOM = shapes.combine(shapes.box((0.0, 0.0, 0.0), (4.0, 4.0, 4.0), 0.3))
FLOOR = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (0.0, 30.0, 0.0)))
OVER_THE_FLOOR = shapes.combine(shapes.icosphere((0.0, 3.0, 1.0), 1.0, 3))


@pytest.mark.thorough
@pytest.mark.parametrize("way", [(0.3, 1.0, 0.2), (-1.0, 0.2, -0.4), (0.0, 0.0, -1.0)])
def test_an_orthographic_eye_in_a_closed_mirror_sees_its_inner_sides_and_misses_nothing(way):
    view, scene = View.looking_at((0.0, 0.0, 0.0), way, (160, 160), orthographic_scale=2.0), shapes.combine(*PANES)
    mesh = reflect(view, ROOM, scene)
    numbers = judge(view, ROOM, scene, mesh)
    assert numbers["compared"] > 300
    # no pixel, of 0.004 %, differs
    assert numbers["uncovered"] < 0.006 and numbers["p99"] < 1e-6
    assert mesh.counts["mirror_pixels"] == 160 * 160
    assert mesh.counts["missed"] == 0 and mesh.counts["probes"] > 5


def test_an_orthographic_eye_partly_in_a_closed_mirror_sees_both_sides():
    # the picture is wider than the room: its outer walls are seen beside the section
    view = View.looking_at((0.0, 0.0, 0.0), (0.4, 1.0, 0.3), (160, 160), orthographic_scale=7.0)
    scene = shapes.combine(shapes.icosphere((3.4, 1.4, 0.6), 0.8, 2), *PANES)
    numbers = judge(view, ROOM, scene, reflect(view, ROOM, scene))
    assert numbers["compared"] > 1000
    # no pixel, of 0.004 % and more, differs
    assert numbers["uncovered"] < 0.01


@pytest.mark.thorough
@pytest.mark.parametrize("depth", [1, 2])
def test_a_floor_that_runs_on_behind_the_eye_is_seen_and_followed(depth):
    view = View.looking_at((0.0, -6.0, 2.0), (0.0, 3.0, 0.5), (256, 192))
    wall = shapes.combine(shapes.quad((0.0, 6.0, 2.0), (4.0, 0.0, 0.0), (0.0, 0.0, 2.0)))
    mesh = reflect(view, FLOOR, OVER_THE_FLOOR, Settings(depth=depth), TriangleMesh.joined([FLOOR, wall]))
    x, y = np.meshgrid(np.arange(256) + 0.5, np.arange(192) + 0.5)
    origin, ray = view.rays(np.stack((x.ravel(), y.ravel()), axis=1))
    met = origin - origin[:, 2:] / ray[:, 2:] * ray
    seen = ((ray[:, 2] < 0.0) & (np.abs(met[:, :2]) < 30.0).all(axis=1)).sum()
    assert mesh.counts["mirror_pixels"] == pytest.approx(seen, rel=0.02)
    assert set(np.unique(mesh.bounces)) == set(range(1, depth + 1))
    assert mesh.filled_share <= 100.0 and not mesh.counts["bounded"]


@pytest.mark.thorough
def test_a_wavy_floor_round_the_eye_is_exact():
    view = View.looking_at((0.3, -1.0, 1.2), (0.0, 3.0, 0.4), (200, 150), field_of_view=1.4)
    water = shapes.combine(shapes.water(12.0, 0.05, 3, 40))
    numbers = judge(view, water, OVER_THE_FLOOR, reflect(view, water, OVER_THE_FLOOR))
    assert numbers["compared"] > 1500
    # measured: 0.065 and 0.0133
    assert numbers["p99"] < 0.12 and numbers["uncovered"] < 0.025


def test_what_stands_beside_and_behind_the_eye_still_hides():
    # a sheet from behind the eye to far before it, before a wall: both are parts of one mirror
    sheet = shapes.quad((-0.5, 2.0, 0.0), (0.3, 6.0, 0.0), (0.0, 0.0, 2.0))
    wall = shapes.quad((0.0, 9.0, 0.0), (9.0, 0.0, 0.0), (0.0, 0.0, 3.0))
    mirror = shapes.combine(sheet, wall)
    scene = shapes.combine(shapes.icosphere((-3.0, 1.0, 0.0), 1.2, 2), shapes.icosphere((3.0, 1.0, 0.0), 1.2, 2))
    view = View.looking_at((0.0, -1.0, 0.0), (0.0, 9.0, 0.0), (200, 150), field_of_view=1.2)
    numbers = judge(view, mirror, scene, reflect(view, mirror, scene))
    assert numbers["compared"] > 250
    # measured: none, and 0.008
    assert numbers["uncovered"] < 0.01 and numbers["p99"] < 0.016


def test_what_stands_on_the_mirror_hides_nothing_with_what_lies_behind_an_orthographic_eye():
    # a sheet leans towards the eye, and over it: the floor under its end is seen, that near its foot is not
    sheet = shapes.quad((0.0, 0.0, 0.5), (2.0, 0.0, 0.0), (0.0, -2.0, 0.5))
    wall = shapes.quad((0.0, 4.0, 1.0), (4.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    floor, scene = shapes.combine(shapes.quad((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 3.0, 0.0))), \
        shapes.combine(sheet, wall)
    view = View.looking_at((0.0, -1.0, 0.2), (0.0, 1.0, -0.6), (160, 160), orthographic_scale=3.0)
    numbers = judge(view, floor, scene, reflect(view, floor, scene))
    assert numbers["compared"] > 2000
    # no pixel differs
    assert numbers["uncovered"] < 0.01 and numbers["p99"] < 1e-6


def test_parts_before_the_eye_cover_what_lies_before_it_and_nothing_else():
    rng = np.random.default_rng(11)
    mesh = TriangleMesh(rng.normal(size=(60, 3)), np.arange(60).reshape(-1, 3))
    view = View.looking_at((0.0, 0.0, 0.0), (0.0, 1.0, 0.0), (64, 64), orthographic_scale=2.0)
    parts, owner = triangles_before_eye(view, mesh, np.arange(20))
    assert (parts.positions[parts.triangles][:, :, 1] >= -1e-12).all()

    def areas(corners):
        return 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
    found = np.bincount(owner, areas(parts.positions[parts.triangles]), 20)
    # of each triangle, the part of a fine sampling that lies before the plane
    weights = rng.dirichlet((1.0, 1.0, 1.0), 40000)
    share = ((mesh.positions[mesh.triangles][:, None] * weights[None, :, :, None]).sum(axis=2)[..., 1] > 0).mean(axis=1)
    np.testing.assert_allclose(found, share * areas(mesh.positions[mesh.triangles]), atol=0.03)


