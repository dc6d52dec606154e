"""Mirrors in mirrors: against a ray tracer that follows the same bounces, and against closed forms of flat mirrors."""
from functools import cache

import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from tests.inputs import shapes
from tests.oracles.raster import rasterise
from tests.oracles.ray_hits import first_hits
from tests.oracles.true_map import picture_areas
from tests.oracles.truth_bounces import trace_bounces

pytestmark = pytest.mark.slow

PIXELS = 256
OTHER_SURFACE = 2.0  # pixels


def _scene() -> TriangleMesh:
    return shapes.combine(shapes.quad((0.0, -1.0, 0.0), (5.0, 0.0, 0.0), (0.0, 5.0, 0.0)),
                          shapes.box((0.3, -1.2, 0.55), (0.6, 0.6, 1.0), 0.4),
                          shapes.icosphere((-1.3, -0.6, 0.75), 0.45, 3))


def _wall(centre, right) -> TriangleMesh:
    return shapes.combine(shapes.quad(centre, right, (0.0, 0.0, 1.4)))


CASES = {
    # the mirror that is looked into, the others
    "corner": (_wall((0.0, 2.0, 1.5), (2.0, 0.0, 0.0)), [_wall((2.1, 0.2, 1.5), (0.0, 1.7, 0.0))]),
    "parallel": (_wall((0.0, 2.0, 1.5), (2.0, 0.0, 0.0)), [_wall((0.1, -6.6, 1.2), (3.5, 0.2, 0.0))]),
    "ball_in_wall": (_wall((0.0, 2.0, 1.5), (2.2, 0.3, 0.0)),
                     [shapes.combine(shapes.icosphere((0.9, 0.6, 1.2), 0.6, 3))]),
    "wall_in_ball": (shapes.combine(shapes.icosphere((-0.2, 0.9, 1.2), 0.8, 3)),
                     [_wall((1.9, -0.4, 1.5), (-0.6, 1.2, 0.0))]),
    # a side of the box is an outline for one end of the wall, and none for the other
    "box_in_wall": (_wall((0.0, 2.0, 1.5), (2.2, 0.3, 0.0)),
                    [shapes.combine(shapes.box((0.4, 1.2, 1.1), (0.7, 0.5, 1.0), 0.5))]),
    "bowl": (shapes.combine(shapes.bowl((0.0, 3.0, 1.2), 1.6, 1.3, 24, 8)), []),
}
CASES["bowl"] = (TriangleMesh(CASES["bowl"][0].positions[:, [0, 2, 1]] * [1.0, -1.0, 1.0] + [0.0, 4.0, -1.6],
                              CASES["bowl"][0].triangles,
                              CASES["bowl"][0].corner_normals[:, :, [0, 2, 1]] * [1.0, -1.0, 1.0]), [])


@cache
def case_of(name: str, orthographic: bool = False):
    mirror, others = CASES[name]
    view = View.looking_at((-0.9, -6.0, 2.3), (0.0, 1.0, 1.3), (PIXELS, PIXELS), field_of_view=0.6,
                           orthographic_scale=4.4 if orthographic else 0.0)
    return view, mirror, _scene(), TriangleMesh.joined([mirror, *others])


@cache
def mesh_of(name: str, depth: int, orthographic: bool = False):
    view, mirror, scene, mirrors = case_of(name, orthographic)
    return reflect(view, mirror, scene, Settings(depth=depth), mirrors)


@cache
def shown_and_truth(name: str, depth: int, orthographic: bool = False):
    view, mirror, scene, mirrors = case_of(name, orthographic)
    mesh = mesh_of(name, depth, orthographic)
    middle = mirror.positions.mean(axis=0)
    single = (mesh.positions - middle).astype(np.float32).astype(np.float64) + middle
    truth = trace_bounces(view, mirror, scene, mirrors, depth)
    return mesh, rasterise(view, single, mesh.triangles), truth


ALL = [(name, depth, orthographic) for name in CASES for depth in (1, 2) for orthographic in (False, True)]
ALL += [("corner", 3, False), ("parallel", 4, False), ("wall_in_ball", 3, False)]


@pytest.mark.parametrize(("name", "depth", "orthographic"), ALL)
def test_the_mesh_shows_what_a_ray_tracer_shows(name, depth, orthographic):
    mesh, shown, truth = shown_and_truth(name, depth, orthographic)
    counted = truth.seen & ~truth.bent
    assert counted.sum() > 2000
    sees, drawn = counted & (truth.source >= 0), shown.triangle >= 0
    source = mesh.source_face[shown.triangle]
    both = sees & drawn
    position = shown.interpolate(mesh.reflected_position, mesh.triangles)
    motion = np.where(truth.motion > 0.0, truth.motion, np.nan)
    displacement = np.linalg.norm(position - truth.position, axis=1) / motion
    wrong = both & ((source != truth.source) & ~(displacement < OTHER_SURFACE))
    uncovered = {"hole": sees & ~drawn, "spill": counted & ~sees & drawn, "wrong": wrong}
    shares = {kind: 100.0 * mask.sum() / counted.sum() for kind, mask in uncovered.items()}
    # deep in the bowl the image of its own rim folds over, and a few pixels of it reach too far
    assert sum(shares.values()) < (0.6 if name == "bowl" and depth > 1 else 0.35), shares
    measured = both & ~wrong & np.isfinite(displacement)
    assert measured.sum() > 0.8 * both.sum()
    assert np.percentile(displacement[measured], 99) < 0.5
    same = measured & (displacement < 0.5)
    bounces = mesh.bounces[shown.triangle]
    assert (bounces[same] == truth.bounces[same]).mean() > 0.995


@pytest.mark.parametrize("name", ["corner", "parallel", "ball_in_wall", "wall_in_ball", "box_in_wall", "bowl"])
def test_mirrors_hide_what_lies_behind_them(name):
    _, shown, truth = shown_and_truth(name, 1)
    ends = truth.seen & ~truth.bent & (truth.source == -2)
    assert ends.sum() > 100
    assert (shown.triangle[ends] < 0).mean() > 0.99


def test_deeper_light_only_adds_to_the_picture():
    for name in ("corner", "ball_in_wall"):
        shallow, deep = (shown_and_truth(name, depth) for depth in (1, 2))
        once = (shallow[2].source >= 0) & (shallow[1].triangle >= 0)
        first = [mesh.source_face[shown.triangle] for mesh, shown, _ in (shallow, deep)]
        assert (first[0][once] == first[1][once]).mean() > 0.995
        assert (deep[0].bounces == 2).sum() > 100


def test_paths_are_as_long_as_the_light_goes():
    for name in ("corner", "parallel", "ball_in_wall", "wall_in_ball"):
        mesh, shown, truth = shown_and_truth(name, 2)
        twice = (truth.bounces == 2) & (truth.source >= 0) & (shown.triangle >= 0) & ~truth.bent
        twice &= (mesh.source_face[shown.triangle] == truth.source) & (mesh.bounces[shown.triangle] == 2)
        assert twice.sum() > 200
        path = shown.interpolate(np.repeat(mesh.path_length[:, None], 3, axis=1), mesh.triangles)[:, 0]
        # between vertices the lengths are interpolated
        assert np.percentile(np.abs(path[twice] / truth.path_length[twice] - 1.0), [50, 95]).max() < 0.05


@pytest.mark.parametrize("placement", ["LAYERED", "SURFACE", "VIRTUAL"])
def test_two_flat_mirrors_show_the_point_mirrored_twice(placement):
    view, mirror, scene, mirrors = case_of("corner")
    mesh = reflect(view, mirror, scene, Settings(depth=2, placement=placement), mirrors)
    point = mesh.reflected_position.copy()
    # first in the wall at x = 2.1, then in the wall at y = 2
    point[:, 0] = 4.2 - point[:, 0]
    point[:, 1] = 4.0 - point[:, 1]
    twice = np.unique(mesh.triangles[(mesh.bounces == 2) & (mesh.source_face >= 0)])
    assert len(twice) > 30
    np.testing.assert_allclose(view.pixels(mesh.positions[twice]), view.pixels(point[twice]), rtol=0, atol=1e-6)
    np.testing.assert_allclose(mesh.path_length[twice],
                               np.linalg.norm(point[twice] - mesh.mirror_position[twice], axis=1), rtol=1e-9)
    assert (mesh.image_parity[twice] == 1).all()


def test_convex_mirrors_never_see_themselves():
    ball = shapes.combine(shapes.icosphere((0.0, 1.0, 1.2), 0.8, 3))
    view = case_of("corner")[0]
    once, thrice = (reflect(view, ball, _scene(), Settings(depth=depth)) for depth in (1, 3))
    assert once.counts["occluded"] == 0
    np.testing.assert_array_equal(once.positions, thrice.positions)
    np.testing.assert_array_equal(once.triangles, thrice.triangles)


@pytest.mark.parametrize("name", ["corner", "ball_in_wall"])
def test_points_behind_mirrors_are_left_out(name):
    view, mirror, scene, mirrors = case_of(name)
    scene = TriangleMesh.joined([scene, shapes.combine(shapes.icosphere((3.2, -0.2, 1.2), 0.5, 3)),
                                 shapes.combine(shapes.icosphere((1.2, -0.6, 1.2), 0.4, 3))])
    alone, among = (reflect(view, mirror, scene, Settings(method="POINTS"), seen) for seen in (None, mirrors))
    assert 100 < len(among.positions) < len(alone.positions)
    way = among.reflected_position - among.mirror_position
    length = np.linalg.norm(way, axis=1)
    # the mirror's own triangles are the first of all
    _, distance = first_hits(mirrors, among.mirror_position, way / length[:, None], leaving=among.discs.mirror_face)
    assert (distance > length * (1.0 - 1e-9)).all()


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("kind", ["cube", "tetrahedron"])
def test_a_closed_room_of_mirrors_shows_nothing_of_what_lies_outside(kind, turned):
    """Light that leaves a wall right beside the next meets that, also after the second bounce."""
    if kind == "cube":
        room = shapes.combine(shapes.box((0.0, 0.0, 0.0), (2.0, 2.0, 2.0)))
    else:
        corners = np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1.0)])
        room = TriangleMesh(1.7 * corners, [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]])
    if turned:
        room = TriangleMesh(room.positions, room.triangles[:, ::-1])
    outside = shapes.combine(shapes.icosphere((0.0, 0.0, 0.0), 8.0, 2))
    view = View.looking_at((0.1, 0.2, 0.3), (1.0, 0.2, 0.1), (256, 256), field_of_view=1.5)
    for tolerance in (0.5, 0.1):
        mesh = reflect(view, room, outside, Settings(tolerance, "SURFACE", depth=2))
        assert np.abs(picture_areas(view, mesh)).sum() < 1e-9
