"""Point-based rendering: images against brute force, closed forms and the true map; discs against a ray tracer."""
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.spatial import cKDTree

import core.points.patch_images
import core.reflection
import core.trees.point_tree
from core import PointTree, Settings, TriangleMesh, View, reflect
from tests.core.polygons.test_vertex_images import brute_force, floating
from tests.inputs import shapes
from tests.inputs.dense_scenes import dense as on_floors
from tests.inputs.disc_mesh import polygons_of
from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare
from tests.oracles.true_map import true_rays, view_rays
from tests.oracles.truth import trace

pytestmark = pytest.mark.slow

POINTS = Settings(method="POINTS")


@pytest.fixture
def each_for_itself(monkeypatch):
    """No vertex stands for others."""
    for room in (core.trees.point_tree, core.points.patch_images):
        monkeypatch.setattr(room, "SMALL", -1.0)


def points_of(case, **settings):
    return reflect(case.view, case.mirror, case.scene, replace(POINTS, **settings))


@pytest.mark.parametrize("kind", ["ball", "bowl", "ring"])
def test_every_image_found_by_brute_force_is_a_point_and_the_other_way(kind, each_for_itself):
    case = floating(kind)
    vertex, pixel, _, towards, parity = brute_force(case)
    mesh = points_of(case)
    drawn = case.view.pixels(mesh.positions)
    # off the silhouette, where the rays bend, and off caustics, where images meet
    sure = (towards > 0.3) & (parity != 0)
    # what brute force projects in every camera may lie behind another part of a ring: no image is wanted there
    shown = sure & ((pixel > 2.0) & (pixel < 598.0)).all(axis=1) if kind != "ring" else np.zeros_like(sure)
    assert kind == "ring" or shown.sum() > 30
    own = {v: np.flatnonzero(mesh.discs.source_vertex == v) for v in range(len(case.scene.positions))}
    for v, place, sign in zip(vertex[shown], pixel[shown], parity[shown], strict=True):
        away = np.linalg.norm(drawn[own[v]] - place, axis=1)
        assert away.min(initial=np.inf) < 0.25 and mesh.image_parity[own[v]][away.argmin()] == sign
        assert (away < 0.25).sum() == 1
    away = [np.linalg.norm(pixel[vertex == v] - place, axis=1).min(initial=np.inf)
            for v, place in zip(mesh.discs.source_vertex, drawn, strict=True)]
    # near a ring's caustics even the small cameras of brute force are some pixels off
    assert (np.array(away) < 1.0).mean() > (0.97 if kind == "ring" else 0.9999)


@pytest.mark.parametrize("kind", ["ball", "bowl", "ring", "flat"])
@pytest.mark.parametrize("orthographic", [False, True])
def test_rays_of_the_true_map_meet_the_vertices(kind, orthographic, each_for_itself):
    case = floating(kind, orthographic)
    mesh = points_of(case)
    point, place, discs = mesh.reflected_position, mesh.mirror_position, mesh.discs
    assert len(point) > 30
    assert np.array_equal(point, case.scene.positions[discs.source_vertex])
    corners = case.mirror.positions[case.mirror.triangles[discs.mirror_face]]
    assert np.abs(np.einsum("nk,nkx->nx", discs.mirror_weights, corners) - place).max() < 1e-12
    _, ray, weights, _ = true_rays(case.mirror, discs.mirror_face, *view_rays(case.view, place))
    assert np.abs(weights - discs.mirror_weights).max() < 1e-9
    assert weights.min() > -1e-8
    offset = point - place
    along = (offset * ray).sum(axis=1)
    assert along.min() > 0.0 and np.linalg.norm(offset - along[:, None] * ray, axis=1).max() < 1e-8
    assert np.allclose(mesh.path_length, along, rtol=1e-9)


@pytest.mark.parametrize("orthographic", [False, True])
def test_a_flat_mirror_shows_each_mirrored_vertex_once(orthographic, each_for_itself):
    case = SCENES["flat_ortho" if orthographic else "flat"]((400, 400))
    rng = np.random.default_rng(5)
    corners = rng.uniform((-3.0, -3.0, 0.2), (3.0, 1.0, 3.5), (900, 1, 3)) + rng.normal(scale=0.02, size=(900, 3, 3))
    case = replace(case, scene=TriangleMesh(corners.reshape(-1, 3), np.arange(2700).reshape(-1, 3)))
    normal, start = case.mirror.face_normals()[0], case.mirror.positions[0]
    image = case.scene.positions - 2.0 * ((case.scene.positions - start) @ normal)[:, None] * normal
    origins, directions = view_rays(case.view, image)
    at = origins + (((start - origins) @ normal) / (directions @ normal))[:, None] * directions - start
    right, up = case.mirror.positions[1] - start, case.mirror.positions[3] - start
    inside = [(at @ way / (way @ way) > 0.0) & (at @ way / (way @ way) < 1.0) for way in (right, up)]
    expected = np.flatnonzero(inside[0] & inside[1])
    assert 300 < len(expected) < 2600
    for placement in ("LAYERED", "SURFACE", "VIRTUAL"):
        mesh = points_of(case, placement=placement)
        order = np.argsort(mesh.discs.source_vertex)
        assert np.array_equal(mesh.discs.source_vertex[order], expected)
        away = case.view.pixels(mesh.positions) - case.view.pixels(image[mesh.discs.source_vertex])
        assert np.abs(away).max() < 1e-6
        assert (mesh.image_parity == 1).all()
    assert np.abs(mesh.positions - image[mesh.discs.source_vertex]).max() < 1e-9


@pytest.mark.parametrize("kind", ["ball", "ring", "water"])
def test_images_on_shared_corners_and_edges_are_found_once(kind, each_for_itself):
    """Diffuse vertices on the rays that leave the mirror right at its vertices and at the middles of its edges."""
    mirror = {"ball": shapes.icosphere((0.0, 0.0, 0.0), 1.0, 3), "ring": shapes.torus((0, 0, 0), 1.0, 0.35, 48, 24),
              "water": shapes.water(4.0, 0.03, 2.0, 24)}[kind]
    mirror = shapes.combine(mirror)
    view = View.looking_at((0.7, -5.0, 4.5), (0.0, 0.0, 0.0), (600, 600))
    face = np.repeat(np.arange(len(mirror.triangles)), 6)
    shares = np.array([[1, 0, 0], [0, 1, 0], [0, 0, 1], [0.5, 0.5, 0], [0, 0.5, 0.5], [0.5, 0, 0.5]])
    place = np.einsum("sk,nkx->nsx", shares, mirror.positions[mirror.triangles]).reshape(-1, 3)
    facing = -(mirror.face_normals()[face] * view_rays(view, place)[1]).sum(axis=1)
    _, once = np.unique(np.round(place, 9), axis=0, return_index=True)
    # on the border of water rounding decides; what lies outside the picture is not looked for
    inside = (np.abs(place[once]) < 1.999).all(axis=1) & (np.abs(view.pixels(place[once]) - 300.0) < 299.0).all(axis=1)
    once = once[(facing[once] > 0.5) & inside][:400]
    _, ray, *_ = true_rays(mirror, face[once], *view_rays(view, place[once]))
    # farther from a ring lie its caustics, where images come in pairs or not at all
    point = place[once] + (0.1 if kind == "ring" else 0.4) * ray
    corners = np.concatenate([point, point + (0.01, 0.0, 0.0), point + (0.0, 0.01, 0.01)])
    scene = TriangleMesh(corners, np.arange(len(corners)).reshape(3, -1).T)
    mesh = reflect(view, mirror, scene, POINTS)
    pixel, drawn = view.pixels(place[once]), view.pixels(mesh.positions)
    for index in range(len(once)):
        away = np.linalg.norm(drawn[mesh.discs.source_vertex == index] - pixel[index], axis=1)
        assert (away < 1e-5).sum() == 1


def dense(name, subdivisions, pixels=400):
    case = SCENES[name]((pixels, pixels))
    balls = {"sphere": (((-2.0, -1.5, 1.0), 0.9, 0), ((1.9, -1.9, 0.8), 0.8, -1)),
             "bowl": (((-0.9, 2.6, 4.2), 0.6, 0), ((0.5, -0.5, 0.7), 0.3, -1)),
             "flat": (((-1.0, -1.5, 1.0), 0.9, 0), ((0.5, -0.2, 1.2), 0.6, -1))}[name]
    return replace(case, scene=shapes.combine(*(shapes.icosphere(middle, radius, subdivisions + less)
                                                for middle, radius, less in balls)))


@cache
def dense_points(name, subdivisions=6):
    case = dense(name, subdivisions)
    return case, points_of(case), trace(case.view, case.mirror, case.scene)


@pytest.mark.parametrize("name", ["sphere", "bowl", "flat"])
def test_discs_cover_what_a_ray_tracer_sees(name):
    case, mesh, truth = dense_points(name, 7 if name == "bowl" else 6)
    judged = compare(case.view, case.mirror, polygons_of(mesh), truth)
    numbers, seen = judged.numbers, ((truth.source_triangle >= 0) & ~truth.sees_itself).sum()
    share = judged.mirror_pixels / seen  # of all the mirror to what shows a ball
    assert seen > 3000
    assert numbers["hole"] * share < 0.2
    assert numbers["wrong_layer"] * share < 1.5  # here also: displaced by more than two pixels
    assert numbers["median"] < 0.7 and numbers["p99"] < 1.7


def test_discs_of_points_that_are_pixels_apart_just_overlap():
    case, mesh, truth = dense_points("flat", 5)
    seen = (truth.source_triangle >= 0).sum()
    holes = []
    for share in (1.0, 0.75):
        discs = replace(mesh.discs, axes=share * mesh.discs.axes)
        judged = compare(case.view, case.mirror, polygons_of(replace(mesh, discs=discs)), truth)
        holes.append(judged.numbers["hole"] * judged.mirror_pixels / seen)
    assert holes[0] < 0.05 and holes[1] > 1.0


@pytest.mark.parametrize("placement", ["LAYERED", "VIRTUAL"])
def test_discs_look_like_ellipses_of_at_least_half_a_pixel(placement):
    case = dense("bowl", 5)
    mesh = points_of(case, placement=placement)
    first, second = np.moveaxis(mesh.discs.axes, 1, 0)
    assert np.abs((first * second).sum(axis=1)).max() < 1e-9
    middle = case.view.pixels(mesh.positions)
    angle = np.linspace(0.0, np.pi, 24, endpoint=False)
    rim = (mesh.positions + np.cos(a) * first + np.sin(a) * second for a in angle)
    size = np.array([np.linalg.norm(case.view.pixels(place) - middle, axis=1) for place in rim])
    assert size.min() > 0.7 and size.max() < 16.5
    pixel = case.view.depths(mesh.positions) * 2.0 / 400 / case.view.projection[0, 0]
    assert np.allclose(size.max(axis=0), mesh.discs.radius / pixel, rtol=0.05)


def test_nodes_smaller_than_a_pixel_stand_for_their_vertices(monkeypatch):
    case = dense("sphere", 7, 200)
    truth = trace(case.view, case.mirror, case.scene)
    mesh = points_of(case)
    for room in (core.trees.point_tree, core.points.patch_images):
        monkeypatch.setattr(room, "SMALL", -1.0)
    every = points_of(case)
    assert every.counts["stood_for"] == 0 and mesh.counts["stood_for"] > 0.4 * len(case.scene.positions)
    assert len(mesh.positions) < 0.6 * len(every.positions)
    # every image that is left out lies within its stand-in's disc
    drawn, wanted = case.view.pixels(mesh.positions), case.view.pixels(every.positions)
    away, nearest = cKDTree(drawn).query(wanted, k=1)
    assert away.max() < 1.0
    judged = compare(case.view, case.mirror, polygons_of(mesh), truth).numbers
    assert judged["hole"] < 0.01 and judged["p99"] < 1.5


def test_a_scan_without_faces_gives_the_same_images():
    case, mesh, truth = dense_points("sphere", 6)
    scan = TriangleMesh(case.scene.positions, np.zeros((0, 3), dtype=np.int64))
    bare = reflect(case.view, case.mirror, PointTree.build(scan), POINTS)
    assert bare.counts["stood_for"] == mesh.counts["stood_for"]
    assert np.array_equal(np.sort(bare.discs.source_vertex), np.sort(mesh.discs.source_vertex))
    seen = (truth.source_triangle >= 0).sum()
    judged = compare(case.view, case.mirror, polygons_of(bare), truth)
    assert judged.numbers["hole"] * judged.mirror_pixels / seen < 0.5


@pytest.mark.parametrize("name", ["sphere", "sphere_ortho", "sphere_far", "cylinder", "torus", "flat"])
def test_a_patch_shows_what_its_cameras_show(name, each_for_itself, monkeypatch):
    case = on_floors(name, (400, 400), 0.2)
    mesh = points_of(case)
    monkeypatch.setattr(core.reflection, "speck", lambda view, sphere: True)  # no patch, cameras alone
    every = points_of(case)
    assert len(every.positions) > 3000
    spots = [np.column_stack((1e4 * found.discs.source_vertex, case.view.pixels(found.mirror_position)))
             for found in (mesh, every)]
    away, index = cKDTree(spots[0]).query(spots[1])
    # nothing is lost, but for what lies within rounding of an open mirror's rim
    lost = away > 1e-3
    assert lost.sum() <= 2 and (every.discs.mirror_weights[lost].min(axis=1) < 1e-3).all()
    index, every_index = index[~lost], np.flatnonzero(~lost)
    assert np.abs(mesh.positions[index] - every.positions[every_index]).max() < 1e-7
    assert np.abs(mesh.discs.radius[index] / every.discs.radius[every_index] - 1.0).max() < 1e-6
    assert (mesh.image_parity[index] == every.image_parity[every_index]).all()
    # on the edge between two faces an image is on either
    other = mesh.discs.mirror_face[index] != every.discs.mirror_face[every_index]
    assert (every.discs.mirror_weights[every_index[other]].min(axis=1) < 1e-6).all()
    # cameras at the silhouette, whose rays the horizon bends, miss a few images that the true map has
    gained = cKDTree(spots[1]).query(spots[0])[0] > 1e-3
    assert gained.sum() < 1e-3 * len(away)
    _, ray, _, _ = true_rays(case.mirror, mesh.discs.mirror_face, *view_rays(case.view, mesh.mirror_position))
    offset = mesh.reflected_position - mesh.mirror_position
    along = (offset * ray).sum(axis=1, keepdims=True)
    assert np.linalg.norm(offset - along * ray, axis=1).max() < 1e-7


def test_a_vertex_on_a_patch_costs_little_more_than_one_projection():
    case = dense("sphere", 6)
    counts = points_of(case).counts
    assert counts["images"] > 10_000 and counts["projections"] < 1.3 * len(case.scene.positions)


def test_points_too_far_apart_are_counted():
    case = SCENES["sphere"]((200, 200))
    mesh = points_of(case)
    assert 0 < mesh.counts["coarse"] < len(mesh.positions)
    assert len(mesh.triangles) == 0 and len(mesh.mirror_face) == 0
