"""Triangles that let light through hide nothing, and what only the eye looks through hides nothing from it."""
from dataclasses import replace

import numpy as np
import pytest

from core import Opacity, PointTree, SceneTree, Settings, Standing, TriangleMesh, View, reflect
from core.cameras import visible_triangles
from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras
from core.culling import SceneAndMirrors
from core.filling import limits
from core.filling.shown_triangles import met_in_turn
from core.result import DEPTH, GAP
from tests.inputs import shapes
from tests.inputs.dense_scenes import dense
from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare, judge
from tests.oracles.truth import trace

WALL = shapes.combine(shapes.quad((0, 0, 0), (1.5, 0, 0), (0, 0, 1.2)))
BOXES = (shapes.box((-0.8, -1.5, -0.6), (0.5, 0.5, 0.8), 0.3), shapes.box((0.5, -1.2, 0.2), (0.4, 0.6, 0.4), 0.7),
         shapes.quad((0, -3, -1), (3, 0, 0), (0, 3, 0)))
VIEW = View.looking_at((0.4, -3.0, 0.3), (0, 0, 0), (128, 96), field_of_view=0.8)
SIDEWAYS = View.looking_at((0.4, -3.0, 0.3), (0, 0, 0), (128, 96), orthographic_scale=3.0)
FULL = 3.0 * (GAP + DEPTH)  # what layers slide at most before a mirror in the middle of VIEW


def with_pane(ahead: float, thick: float = 0.02, size=(1.6, 1.3), kind=Opacity.CLEAR):
    """The boxes and, behind them in the list, a pane before the wall; opacities, and the first of its triangles."""
    pane = shapes.box((0.0, -ahead - 0.5 * thick, 0.0), (2 * size[0], thick, 2 * size[1]))
    room, first = shapes.combine(*BOXES, pane), len(shapes.combine(*BOXES).triangles)
    opacity = np.full(len(room.triangles), Opacity.OPAQUE)
    opacity[first:] = kind
    return TriangleMesh(room.positions, room.triangles), opacity, first


def without(mesh, first: int):
    """Return the reflection mesh without faces of the source triangles from `first` on."""
    kept = mesh.source_face < first
    return replace(mesh, triangles=mesh.triangles[kept], source_face=mesh.source_face[kept])


def seen_without(view, mirror, scene, mesh, first, **options):
    """Errors of a reflection without some of its sources, judged by the scene without these."""
    return judge(view, mirror, TriangleMesh(scene.positions, scene.triangles[:first]), without(mesh, first), **options)


@pytest.mark.parametrize("view", [VIEW, SIDEWAYS], ids=["perspective", "orthographic"])
@pytest.mark.parametrize("ahead", [0.9, 0.45, 0.2, 0.0])
def test_a_clear_pane_before_a_mirror_hides_nothing_of_it(view, ahead):
    """Panes by shares of what layers slide; where they are opaque nothing is seen."""
    scene, opacity, first = with_pane(ahead * FULL)
    mesh = reflect(view, WALL, scene, opacity=opacity)
    numbers = seen_without(view, WALL, scene, mesh, first, single_precision=True)
    assert numbers["compared"] > 3000 and numbers["p99"] < 0.3 and numbers["uncovered"] < 0.05
    assert mesh.counts["missed"] == 0 == mesh.counts["too_close"]
    # an opaque one hides it, unless its back is the mirror itself
    opaque = without(reflect(view, WALL, scene), first)
    assert (len(opaque.triangles) < 0.1 * len(without(mesh, first).triangles)) == (ahead > 0.0)


@pytest.mark.parametrize("ahead", [0.9, 0.45, 0.2])
def test_layers_stay_behind_a_pane(ahead):
    scene, opacity, first = with_pane(ahead * FULL)
    mesh = reflect(VIEW, WALL, scene, opacity=opacity)
    assert 0.0 < -mesh.positions[:, 1].max() and -mesh.positions[:, 1].min() < ahead * FULL
    # no less than that: what is far from the mirror slides by GAP at least
    far = reflect(VIEW, WALL, TriangleMesh(scene.positions, scene.triangles[:first]))
    assert -mesh.positions[:, 1].min() >= -far.positions[:, 1].min() / 8.01


def test_what_stands_in_a_pane_or_touches_it_is_still_before_the_mirror():
    """A pane that touches the mirror keeps layers within itself: its back is the mirror, its front is before them."""
    scene, opacity, _ = with_pane(0.0, thick=0.6 * FULL)
    mesh = reflect(VIEW, WALL, scene, opacity=opacity)
    assert len(mesh.triangles) and -mesh.positions[:, 1].min() < 0.6 * FULL


def test_opaque_scenes_are_what_they_were():
    case = dense("sphere", (96, 96), 0.24)
    before = reflect(case.view, case.mirror, case.scene)
    now = reflect(case.view, case.mirror, case.scene, opacity=np.full(len(case.scene.triangles), Opacity.OPAQUE))
    for name in ("positions", "triangles", "source_face", "path_length"):
        assert np.array_equal(getattr(before, name), getattr(now, name))


def test_a_wall_that_the_eye_looks_through_hides_nothing_from_it_and_is_shown():
    scene, opacity, first = with_pane(0.4 * FULL, kind=Opacity.UNSEEN)
    mesh = reflect(VIEW, WALL, scene, opacity=opacity)
    numbers = judge(VIEW, WALL, scene, mesh)
    assert (mesh.source_face >= first).any() and numbers["mirror_pixels"] == 0
    # nothing has to stay behind what nobody sees
    assert np.isclose(-mesh.positions[:, 1].min(), FULL, rtol=0.3)


def dense_scene(kind):
    """A mirror ball before a dense wall, and a dense ball behind that; opacities, and the wall's first triangle."""
    case = dense("sphere", (256, 256), 0.24)

    def upright(u, v):
        return np.stack((u, np.full_like(u, -4.0), v), axis=1), np.tile((0.0, 1.0, 0.0), (len(u), 1))
    wall = shapes.sheet(upright, 80, 80, (-1.5, 1.5), (0.0, 2.6))
    scene = shapes.combine(shapes.icosphere((0.0, -5.0, 1.3), 0.8, 5), wall)
    first = len(scene.triangles) - len(wall[1])
    opacity = np.full(len(scene.triangles), Opacity.OPAQUE)
    opacity[first:] = kind
    return case, TriangleMesh(scene.positions, scene.triangles), opacity, first


def test_behind_a_clear_wall_all_is_kept_and_nothing_else():
    """Faces that nearer ones hide are kept behind clear ones alone: of the ball its front, not its back."""
    case, scene, opacity, first = dense_scene(Opacity.CLEAR)
    mesh = reflect(case.view, case.mirror, scene, opacity=opacity)
    every = reflect(case.view, case.mirror, scene, Settings(hidden_faces=True))
    alone = reflect(case.view, case.mirror, TriangleMesh(scene.positions, scene.triangles[:first]))
    assert mesh.counts["whole"] > 1000
    ball, whole, plain = ((one.source_face < first).sum() for one in (mesh, every, alone))
    assert plain <= 1.1 * ball and ball < 1.1 * plain and plain < 0.6 * whole
    numbers = seen_without(case.view, case.mirror, scene, mesh, first, single_precision=True)
    assert numbers["compared"] > 200 and numbers["uncovered"] < 0.03 and numbers["p99"] < 0.35
    truth = trace(case.view, case.mirror, scene)
    assert compare(case.view, case.mirror, mesh, truth).numbers["uncovered"] < 0.03


def test_both_sides_of_thin_glass_are_kept():
    """A lens thinner than a pixel, whose vertices would be drawn together if it were opaque: each side bends light."""
    case = dense("sphere", (128, 128), 0.24)
    positions, triangles, _ = shapes.icosphere((0.0, 0.0, 0.0), 0.8, 5)
    lens = TriangleMesh(positions * (1.0, 0.002, 1.0) + (0.0, -4.0, 1.3), triangles)
    sides = [np.sign(lens.face_normals()[:, 1]) == sign for sign in (-1.0, 1.0)]
    shown = [[np.isin(np.flatnonzero(side), mesh.source_face).sum() for side in sides] for mesh in (
        reflect(case.view, case.mirror, lens, opacity=np.full(len(triangles), Opacity.CLEAR)),
        reflect(case.view, case.mirror, lens, Settings(hidden_faces=True)))]
    assert min(shown[1]) > 5000 and min(shown[0]) > 0.95 * min(shown[1])


def test_rays_show_what_they_meet_behind_clear_triangles(monkeypatch):
    """Check that rays, which sample areas too dense for cutting, pass through clear triangles."""
    monkeypatch.setattr(limits, "DENSE", 1e-3)
    case, scene, opacity, first = dense_scene(Opacity.CLEAR)
    mesh = reflect(case.view, case.mirror, scene, Settings(tolerance=1.0), opacity=opacity)
    assert mesh.counts["dense"] > 0 and mesh.counts["rays"] > 1000
    numbers = seen_without(case.view, case.mirror, scene, mesh, first)
    assert numbers["compared"] > 200 and numbers["uncovered"] < 0.1


def test_rays_meet_clear_triangles_in_turn_until_an_opaque_one():
    """Told by solving for every triangle alone."""
    scene, opacity, first = with_pane(0.4)
    tree = SceneTree.build(scene)
    mirror_map = MirrorMap(VIEW, WALL)
    cameras = three_ray_cameras(mirror_map, WALL, visible_triangles(VIEW, WALL))
    rng = np.random.default_rng(5)
    chosen = rng.integers(0, len(cameras), 200)
    cameras = cameras.select(chosen)
    places = np.einsum("nk,xnk->xn", rng.dirichlet((1, 1, 1), 200), cameras.places[:, cameras.corners])
    met = SceneAndMirrors(tree, WALL).with_opacity(opacity)
    place, triangle = met_in_turn(met, cameras, places)
    ways = mirror_map.rays(cameras.face, mirror_map.coordinates(cameras.face, places))
    mesh, clear = tree.mesh, opacity[tree.given.triangle] == Opacity.CLEAR
    a, b, c = (mesh.positions[mesh.triangles[:, corner]] for corner in range(3))
    for number, (origin, way) in enumerate(zip(places.T, ways.T)):
        system = np.stack((b - a, c - a, np.broadcast_to(-way, a.shape)), axis=-1)
        regular = np.abs(np.linalg.det(system)) > 1e-12
        u, v, s = np.linalg.solve(np.where(regular[:, None, None], system, np.eye(3)),
                                  (origin - a)[..., None])[..., 0].T
        hit = np.flatnonzero(regular & (u >= 0) & (v >= 0) & (u + v <= 1) & (s > 1e-9))
        expected = hit[np.argsort(s[hit])].tolist()
        ends = [index for index, one in enumerate(expected) if not clear[one]]
        expected = expected[:ends[0] + 1] if ends else expected
        assert triangle[place == number].tolist() == (expected or [-1])
    assert clear[triangle[triangle >= 0]].sum() > 200


def clear_things(rng, case):
    """Panes close before triangles of a mirror, balls and boxes round it."""
    mirror = case.mirror
    corners, size = mirror.positions[mirror.triangles], np.ptp(mirror.positions, axis=0).max()
    number = rng.integers(len(corners))
    place, normal = corners[number].mean(axis=0), mirror.face_normals()[number]
    way = case.view.eye - place
    up = np.cross(normal, rng.normal(size=3))
    up *= rng.uniform(0.05, 0.6) * size / np.linalg.norm(up)
    ahead = np.sign(normal @ way) * rng.uniform(0.05, 1.2) * (GAP + DEPTH) * np.linalg.norm(way)
    spots = corners.mean(axis=(0, 1)) + size * rng.normal(size=(2, 3))
    return (shapes.quad(place + ahead * normal, np.cross(normal, up), up),
            shapes.icosphere(spots[0], size * rng.uniform(0.05, 0.4), 4),
            shapes.box(spots[1], size * rng.uniform(0.05, 1.0, 3), rng.uniform(0.0, 3.0)))


@pytest.mark.thorough
@pytest.mark.parametrize("name", ["sphere", "flat", "bowl", "water", "torus", "cylinder", "sphere_ortho"])
def test_behind_clear_things_mirrors_show_what_they_show_without(name):
    """Judged by rays in the scene without them, before and after a dense ball is added."""
    rng = np.random.default_rng(len(name))
    case = SCENES[name]((96, 96))
    spot = case.mirror.positions.mean(axis=0) + 1.2 * rng.normal(size=3)
    for more in ((), (shapes.icosphere(spot, 0.3, 5),)):
        opaque = [(case.scene.positions, case.scene.triangles, None), *more]
        base, scene = (shapes.combine(*parts) for parts in (opaque, opaque + list(clear_things(rng, case))))
        base, scene = (TriangleMesh(mesh.positions, mesh.triangles) for mesh in (base, scene))
        first = len(base.triangles)
        opacity = np.where(np.arange(len(scene.triangles)) < first, Opacity.OPAQUE, Opacity.CLEAR)
        truth = trace(case.view, case.mirror, base)
        plain = judge(case.view, case.mirror, base, reflect(case.view, case.mirror, base), truth)
        mesh = without(reflect(case.view, case.mirror, scene, opacity=opacity), first)
        seen = judge(case.view, case.mirror, base, mesh, truth)
        # without clear things some of the mirrors are made by rays
        assert seen["uncovered"] < plain["uncovered"] + 0.08 and seen["p99"] < max(1.2 * plain["p99"], 0.3)


def test_clear_parts_of_a_body_show_its_inner_side():
    """A closed box with one clear side: through that its back is seen from within, which is left out of opaque ones."""
    box = shapes.combine(shapes.box((0.0, -9.5, 0.0), (1.0, 1.0, 1.0)))
    front = np.isclose(box.positions[box.triangles][:, :, 1], -9.0).all(axis=1)
    opacity = np.where(front, Opacity.CLEAR, Opacity.OPAQUE)
    box = TriangleMesh(box.positions, box.triangles)
    away = np.isclose(box.positions[box.triangles][:, :, 1], -10.0).all(axis=1)
    kinds = (np.full(len(front), Opacity.OPAQUE), opacity, np.where(front, Opacity.UNSEEN, Opacity.OPAQUE))
    shown = [np.isin(np.flatnonzero(away), reflect(VIEW, WALL, box, opacity=kind).source_face).any() for kind in kinds]
    assert shown == [False, True, True]


def test_trees_and_what_stands_take_opacities_too():
    scene, opacity, first = with_pane(0.4 * FULL)
    tree = SceneTree.build(scene)
    meshes = [reflect(VIEW, WALL, given, opacity=opacity) for given in (scene, tree, Standing.of(tree, WALL))]
    assert all(np.array_equal(mesh.positions, meshes[0].positions) for mesh in meshes)
    assert not len(reflect(VIEW, WALL, tree).triangles)
    points = reflect(VIEW, WALL, PointTree.build(scene), Settings(method="POINTS"), opacity=opacity)
    assert -points.positions[:, 1].min() < 0.4 * FULL


@pytest.mark.parametrize(("ahead", "kind", "left"), [
    (0.2, Opacity.OPEN, 0), (0.1, Opacity.OPEN, 12), (0.1, Opacity.CLEAR, 0), (0.1, Opacity.UNSEEN, 0)])
def test_a_film_too_close_to_keep_layers_behind_it_is_not_covered(ahead, kind, left):
    """But hides what lies behind it, and is counted; nobody misses clear glass."""
    film = shapes.quad((0.0, -ahead * FULL, 0.0), (0.5, 0.0, 0.0), (0.0, 0.0, 0.4))
    scene = shapes.combine(*BOXES, film)
    first = len(scene.triangles) - 2
    opacity = np.where(np.arange(len(scene.triangles)) < first, Opacity.OPAQUE, kind)
    mesh = reflect(VIEW, WALL, TriangleMesh(scene.positions, scene.triangles), opacity=opacity)
    assert (mesh.counts["too_close"] > 0) == (left > 0)
    middles = mesh.mirror_position[mesh.triangles].mean(axis=1)
    within = (np.abs(middles[:, 0]) < 0.4) & (np.abs(middles[:, 2]) < 0.3) & (mesh.source_face < first)
    assert within.any() == (left == 0)


def test_far_from_the_origin_panes_are_clear_too():
    scene, opacity, first = with_pane(0.4 * FULL)
    far = np.array([4096.0, 0.0, 0.0])
    view = replace(VIEW, camera_to_world=VIEW.camera_to_world + np.pad(far[:, None], ((0, 1), (3, 0))))
    near = reflect(VIEW, WALL, scene, opacity=opacity)
    moved = reflect(view, TriangleMesh(WALL.positions + far, WALL.triangles),
                    TriangleMesh(scene.positions + far, scene.triangles), opacity=opacity)
    assert len(moved.triangles) == pytest.approx(len(near.triangles), rel=0.05) and len(near.triangles) > 100


@pytest.mark.parametrize("wrong", [[2], np.full((12, 2), 2), "clear", np.full(12, 4), np.full(12, -1),
                                   np.full(12, 0.5)], ids=repr)
def test_a_wrong_opacity_is_named(wrong):
    with pytest.raises(ValueError, match="The opacity must be"):
        reflect(VIEW, WALL, TriangleMesh(BOXES[0][0], BOXES[0][1]), opacity=wrong)
