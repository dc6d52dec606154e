"""Crowds: what is too much for the picture or the memory is shown by rays, within bounds, and the result says so."""
import time
import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

import core.whole_faces.whole as whole_room
from core import SceneTree, Settings, TriangleMesh, View, reflect
from core.cameras import covered_pixels, pixels_of, with_pieces
from core.cameras.camera_splitting import in_picture
from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.culling.scene_and_mirrors import SceneAndMirrors
from core.filling import limits
from core.filling.limits import Limits
from core.filling.picture_squares import first_side, in_squares
from core.filling.shown_triangles import met_in_turn
from core.support.crowding import crowded
from core.visibility.eye_plane import cut_before_eye
from tests.inputs import shapes
from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare
from tests.oracles.raster import rasterise
from tests.oracles.true_map import case_of, mesh_of, truth_of
from tests.oracles.truth import trace
from tests.oracles.truth_bounces import trace_bounces

pytestmark = pytest.mark.slow

VIEW = View.looking_at((0.3, -5.0, 1.5), (0.0, 0.0, 0.5), (96, 72))


def soup(count, seed, size=0.8):
    """Triangles across each other in a ball of radius about one."""
    rng = np.random.default_rng(seed)
    middles = rng.normal(0.0, 0.5, (count, 1, 3))
    return TriangleMesh((middles + rng.normal(0.0, size, (count, 3, 3))).reshape(-1, 3),
                        np.arange(3 * count).reshape(-1, 3))


@pytest.mark.parametrize("name", ["sphere", "flat", "water", "bowl"])
def test_rays_alone_show_the_right_thing_in_every_pixel(name):
    # a memory that holds hardly a candidate leaves everything to rays
    case, truth = case_of(name), truth_of(name)
    mesh = reflect(case.view, case.mirror, case.scene, Settings(maximum_memory=1e-4))
    numbers = compare(case.view, case.mirror, mesh, truth).numbers
    assert mesh.counts["crowded"] > 0 and mesh.counts["rays"] < 1.1 * mesh.counts["mirror_pixels"]
    assert 30.0 < mesh.filled_share <= 100.0
    # the ray through each pixel's middle is traced, so that there what it meets is shown
    assert numbers["p99"] < 0.4 and numbers["median"] < 0.01
    assert numbers["uncovered"] < 0.01 and numbers["spill_outside"] == 0.0
    assert mesh.counts["missed"] == 0


@pytest.mark.parametrize("name", SCENES)
def test_ordinary_scenes_need_hardly_a_ray(name):
    counts = mesh_of(name).counts
    assert counts["crowded"] == counts["open"] == 0
    # on the ring's rim all of the scene is seen in a few thousandths of its pixels, on a ball's in single ones
    assert (counts["rays"] > 0) == (counts["dense"] > 0) and (counts["filled"] == 0 or counts["rays"] > 0)
    assert counts["filled_pixels"] < (0.003 if name == "torus" else 0.0003) * counts["mirror_pixels"]


@pytest.mark.parametrize(("tolerance", "measured"), [(2.0, 0.077), (0.5, 0.056), (0.25, 0.027)])
def test_pixels_that_show_much_of_the_scene_are_filled_by_rays_sooner_than_cut(tolerance, measured, monkeypatch):
    # a ring before 9,000 triangles, in a picture of 64 pixels: what lies over one another in them nobody can see
    case = case_of("torus", 64)
    scene = shapes.combine(*(shapes.icosphere((x, y, 0.5), 0.5, 3)
                             for x in (-2.5, 0.0, 2.5) for y in (-2.5, -1.0, 2.5)))
    truth = trace(case.view, case.mirror, scene)
    filled = reflect(case.view, case.mirror, scene, Settings(tolerance=tolerance))
    whole = reflect(case.view, case.mirror, scene, Settings(tolerance=tolerance, hidden_faces=True))
    assert whole.counts["dense"] == 0 < filled.counts["dense"] and filled.counts["crowded"] == 0
    monkeypatch.setattr(limits, "DENSE", np.inf)
    monkeypatch.setattr(whole_room, "TOGETHER", 0.0)  # what is cut is all that the picture asks for
    exact = reflect(case.view, case.mirror, scene, Settings(tolerance=tolerance))
    assert filled.counts["candidates"] < 0.5 * exact.counts["candidates"]
    assert len(filled.triangles) < 0.75 * len(exact.triangles)
    numbers, before = (compare(case.view, case.mirror, mesh, truth).numbers for mesh in (filled, exact))
    # through the pixels' middles go the rays that a ray tracer takes
    # measured: 0.068 % uncovered both, one pixel
    assert numbers["p99"] < 1.7 * measured and numbers["uncovered"] <= before["uncovered"] < 0.14


def first_triangle(scene, origin, ray):
    """The triangle that a ray meets first, -1 for none, by solving for every triangle of the scene alone."""
    a, b, c = (scene.positions[scene.triangles[:, corner]] for corner in range(3))
    columns = np.stack((b - a, c - a, np.broadcast_to(-ray, a.shape)), axis=-1)
    regular = np.abs(np.linalg.det(columns)) > 1e-12
    u, v, s = np.linalg.solve(np.where(regular[:, None, None], columns, np.eye(3)), (origin - a)[..., None])[..., 0].T
    hit = regular & (u >= 0) & (v >= 0) & (u + v <= 1) & (s > 0)
    return int(np.argmin(np.where(hit, s, np.inf))) if hit.any() else -1


def test_a_cell_shows_the_triangle_that_its_middle_ray_meets_first():
    case = case_of("sphere_ico")
    mirror_map, tree = MirrorMap(case.view, case.mirror), SceneTree.build(case.scene)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    cameras = cameras.select(in_picture(cameras))
    middle = cameras.places[:, cameras.corners].mean(axis=2)
    place, shown = met_in_turn(SceneAndMirrors(tree, case.mirror), cameras, middle)
    assert place.tolist() == list(range(len(cameras)))
    ray = mirror_map.rays(cameras.face, mirror_map.coordinates(cameras.face, middle))
    expected = [first_triangle(tree.mesh, middle[:, number], ray[:, number]) for number in range(len(cameras))]
    assert shown.tolist() == expected
    assert (shown >= 0).sum() > 100


@pytest.mark.parametrize("gigabytes", [2.0, 0.005, 0.001])
def test_crossing_mirrors_take_bounded_time_and_show_the_scene(gigabytes):
    mirror, scene = soup(250, 3), shapes.combine(shapes.icosphere((0.0, -3.0, 1.0), 0.8, 2))
    started = time.process_time()
    mesh = reflect(VIEW, mirror, scene, Settings(depth=2, maximum_memory=gigabytes))
    assert time.process_time() - started < 10.0
    # mirrors that scatter what they show: rays tell what most parts of the second bounce see
    assert mesh.counts["crowded"] > 5000
    assert len(mesh.triangles) < 40 * mesh.counts["mirror_pixels"]
    assert mesh.missing_share < 25.0


BOWL_VIEW = View.looking_at((0.3, -2.2, 3.2), (0.0, 0.0, 0.4), (96, 72))


@pytest.mark.parametrize(("mirror", "view"), [
    (soup(250, 3), VIEW), (shapes.combine(shapes.bowl((0.0, 0.0, 1.0), 1.2, 1.9, 24, 12)), BOWL_VIEW)],
                         ids=["soup", "bowl"])
def test_what_mirrors_scatter_is_shown_by_rays_where_it_is_too_much_to_be_cut(mirror, view):
    """Of what many mirrors in mirrors show each part is a fraction of a pixel."""
    scene = shapes.combine(shapes.icosphere((0.4, -2.0, 1.6), 0.7, 2), shapes.quad((0, 0, 6), (9, 0, 0), (0, 9, 0)))
    mesh = reflect(view, mirror, scene, Settings(depth=3))
    truth = trace_bounces(view, mirror, scene, mirror, 3)
    deep = truth.seen & (truth.bounces > 1) & (truth.source >= 0) & ~truth.bent
    assert deep.sum() > 300 and mesh.counts["crowded"] > 5000
    drawn = rasterise(view, mesh.positions, mesh.triangles)
    assert (deep & (drawn.triangle < 0)).sum() < 0.01 * deep.sum()
    shown = deep & (drawn.triangle >= 0) & np.isfinite(truth.motion)
    position = drawn.interpolate(mesh.reflected_position, mesh.triangles)[shown]
    away = np.linalg.norm(position - truth.position[shown], axis=1) / truth.motion[shown]
    assert (away > 1.5).mean() < 0.03  # a square's ray speaks for a pixel


def test_what_is_made_does_not_grow_with_what_the_picture_cannot_show():
    # a mirror of a few pixels before 4,000 triangles
    mirror = TriangleMesh(0.02 * soup(200, 4).positions, soup(200, 4).triangles)
    scene = soup(4000, 5, 0.3)
    scene = TriangleMesh(scene.positions + [0.0, -2.0, 1.0], scene.triangles)
    started = time.process_time()
    mesh = reflect(VIEW, mirror, scene, Settings(depth=2))
    assert time.process_time() - started < 10.0
    assert mesh.counts["mirror_pixels"] < 100
    assert len(mesh.triangles) < 250_000


@pytest.mark.parametrize("gigabytes", [0.2, 0.05])
def test_arrays_stay_within_the_memory_that_is_allowed(gigabytes):
    mirror, scene = soup(150, 6), soup(1500, 7, 0.2)
    tracemalloc.start()
    try:
        reflect(VIEW, mirror, scene, Settings(maximum_memory=gigabytes))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    # what one share of the work takes at a time comes to what the memory holds
    assert peak < 1e9 * gigabytes + 2e8


def test_the_most_crowded_for_their_worth_are_left_out():
    count, worth = np.array([10, 10, 1, 100]), np.array([10.0, 1.0, 1.0, 1000.0])
    assert crowded(count, worth, 121).tolist() == [False] * 4
    assert crowded(count, worth, 120).tolist() == [False, True, False, False]
    assert crowded(count, worth, 100).tolist() == [True, True, True, False]
    assert crowded(count, worth, 0).tolist() == [True] * 4


def test_limits_grow_with_the_picture_and_the_memory():
    small, large = (Limits.of(Settings(), pixels, 1000) for pixels in (100, 100_000))
    assert small.candidates < large.candidates and small.rays < large.rays and small.cameras < large.cameras
    tight = Limits.of(Settings(maximum_memory=0.01), 100_000, 1000)
    assert tight.candidates < large.candidates and tight.faces < large.faces and tight.pairs < large.pairs
    free = Limits.of(Settings(maximum_memory=np.inf, maximum_faces=2**40), 100, 1000)
    # the memory itself is none of what it bounds
    assert replace(free, memory=small.memory) == small
    assert Limits.of(Settings(maximum_faces=500), 100, 1000).faces == 500


def test_what_is_held_already_leaves_less_room():
    limits = Limits.of(Settings(maximum_memory=0.3), 400_000, 200_000)
    tight = limits.beside(limits.memory // 2)
    assert tight.candidates < limits.candidates and tight.faces == limits.faces
    assert 0 < limits.beside(2**40).candidates < tight.candidates and limits.beside(0) == limits
    assert Limits.of(Settings(maximum_memory=0.3), 400_000, 1_000_000).candidates < limits.candidates


def test_what_rays_filled_is_no_more_than_the_mirror_however_much_lies_over_one_another():
    # thirty crossing mirrors, one behind another, each a crowd in all pixels
    mesh = reflect(VIEW, soup(60, 5, 2.0), shapes.combine(shapes.icosphere((0.0, -3.0, 1.0), 0.8, 2)),
                   Settings(depth=2, maximum_memory=1e-4))
    assert mesh.counts["filled"] > mesh.counts["mirror_pixels"]
    assert mesh.counts["filled_pixels"] <= 2 * mesh.counts["mirror_pixels"] and mesh.filled_share <= 100.0


def test_pixels_that_many_cells_lie_over_are_filled_once():
    # fifty upright mirrors a hair behind one another: each covers the pixels that the first one does
    mirror = shapes.combine(*(shapes.quad((0.0, 0.001 * k, 0.8), (1.5, 0.0, 0.0), (0.0, 0.0, 1.0)) for k in range(50)))
    cells = in_squares_of_a_pixel(three_ray_cameras(MirrorMap(VIEW, mirror), mirror, visible_triangles(VIEW, mirror)))
    first = cells.select(cells.face < 2)
    assert pixels_of(cells).sum() > 49.0 * pixels_of(first).sum()
    assert covered_pixels(first) == pytest.approx(pixels_of(first).sum(), rel=0.02)
    assert covered_pixels(first) <= covered_pixels(cells) <= 1.05 * covered_pixels(first)


def in_squares_of_a_pixel(cameras):
    parent, weights = in_squares(cameras, 1.0).triangles(0.0)
    return with_pieces(cameras, np.zeros(len(cameras), dtype=bool), parent, weights)


def test_a_sliver_across_a_picture_becomes_no_more_cells_than_squares_it_passes():
    # far longer than the picture, and far thinner than a pixel: what splits edges in halves would take millions
    sliver = TriangleMesh([[-4000.0, 0.0, -3000.0], [4000.0, 0.0, 3000.0], [4000.0, 0.0, 3000.01]], [[0, 1, 2]])
    cameras = cut_before_eye(three_ray_cameras(MirrorMap(VIEW, sliver), sliver, np.array([0])))
    parts = in_squares(cameras, 0.5)
    assert 100 < len(parts) <= 3 * (96 + 72 + 1)
    place = np.einsum("xkc,kc->xc", cameras.places[:, cameras.corners[parts.owner[parts.polygon]].T], parts.weights)
    pixels = VIEW.pixels(place.T)
    assert ((pixels > -1e-6) & (pixels < np.add(VIEW.resolution, 1e-6))).all()
    square = [np.floor((side.reduceat(pixels, parts.start[:-1], axis=0) - first_side(0.5)) / 0.5 + shift)
              for side, shift in ((np.minimum, 1e-5), (np.maximum, -1e-5))]
    assert (square[0] == square[1]).all()
