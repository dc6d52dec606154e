"""Closed bodies: which they are, and that nothing which can be seen of them is left out."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, reflect
from core.geometry import ordered
from core.trees import Cones, Fronts
from core.trees.closed_bodies import ClosedBodies
from tests.inputs import shapes
from tests.inputs.dense_scenes import dense
from tests.inputs.scenes import SCENES
from tests.oracles.judge import compare
from tests.oracles.truth import trace

BALL, BOX = shapes.icosphere((0.0, 0.0, 0.0), 1.0, 2), shapes.box((4.0, 0.0, 0.0), (1.0, 2.0, 0.5), 0.3)


def turned(mesh: TriangleMesh) -> TriangleMesh:
    return TriangleMesh(mesh.positions, mesh.triangles[:, ::-1])


def tube(section, count=80) -> TriangleMesh:
    """A closed curve in the plane of radius and height, turned round the axis."""
    turn = np.arange(count) * 2.0 * np.pi / count
    radius, height = (part[:, None] for part in section(turn))
    points = np.stack((radius * np.cos(turn), radius * np.sin(turn), height + 0.0 * turn), axis=-1).reshape(-1, 3)
    i, j = (index.ravel() for index in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    a, b, c, d = (((i + x) % count) * count + (j + y) % count for x, y in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return TriangleMesh(points, np.concatenate((np.stack((a, c, b), axis=1), np.stack((a, d, c), axis=1))))


RING = tube(lambda t: (3.0 + np.cos(t), np.sin(t)))
EIGHT = tube(lambda t: (3.0 + np.sin(t), np.sin(2.0 * t)))


def outward(mesh: TriangleMesh) -> np.ndarray:
    """In the order of the mesh that was given."""
    own, order = ordered(mesh, shading=False)
    found = np.full(len(mesh.triangles), np.nan)
    found[order.triangle] = ClosedBodies.of(own).outward
    return found


@pytest.mark.parametrize("mesh", [shapes.combine(BALL), shapes.combine(BOX), RING, shapes.combine(BALL, BOX)])
def test_the_outside_of_a_closed_body_is_told_and_a_room_has_none(mesh):
    inside_out = np.linalg.det(mesh.positions[mesh.triangles]).sum() < 0.0
    mesh, room = (turned(mesh), mesh) if inside_out else (mesh, turned(mesh))
    assert (outward(mesh) == 1.0).all() and not outward(room).any()


def test_a_body_with_a_hole_or_with_a_part_turned_over_has_no_outside():
    ball = shapes.combine(BALL)
    holed = TriangleMesh(ball.positions, ball.triangles[1:])
    mixed = TriangleMesh(ball.positions, np.concatenate((ball.triangles[:7, ::-1], ball.triangles[7:])))
    assert not outward(holed).any() and not outward(mixed).any()
    both = outward(TriangleMesh.joined([holed, shapes.combine(BOX)]))
    assert not both[:len(holed.triangles)].any() and (both[len(holed.triangles):] == 1.0).all()


def test_what_overlaps_itself_the_wrong_way_has_no_outside():
    assert not outward(EIGHT).any()
    # two bodies that overlap have one
    pair = shapes.combine(BALL, shapes.icosphere((0.9, 0.2, 0.1), 1.0, 2))
    assert (outward(pair) == outward(pair)[0]).all() and outward(pair)[0]


def test_faces_with_corners_of_their_own_bound_a_body_as_well():
    ball = shapes.combine(BALL)
    soup = TriangleMesh(ball.positions[ball.triangles].reshape(-1, 3), np.arange(ball.triangles.size).reshape(-1, 3))
    assert (outward(soup) == outward(ball)).all()


@pytest.mark.thorough
@pytest.mark.parametrize(("eye", "outside"), [((0.0, 0.0, 0.0), True), ((3.0, 0.0, 0.1), False),
                                              ((2.7, 2.7, 0.9), True), ((0.0, -9.0, 1.0), True)])
def test_only_what_is_looked_at_from_outside_turns_away(eye, outside):
    own, _ = ordered(RING, shading=False)
    view = View.looking_at(eye, (0.2, 0.1, -5.0), (64, 64))
    assert bool(ClosedBodies.of(own).outward_from(view).all()) == outside
    assert bool(ClosedBodies.of(own).outward_from(view).any()) == outside


@pytest.mark.parametrize(("eye", "near", "outside"), [(-2.5, 0.1, True), (-2.5, 2.5, False), (-2.5, 9.0, True),
                                                      (-0.2, 0.1, False), (-0.2, 9.0, False)])
@pytest.mark.parametrize("orthographic", [False, True])
def test_a_view_looks_from_where_it_cuts_off_no_more(eye, near, outside, orthographic):
    """Before a room it looks into that where the wall between is nearer than its near clipping plane; in it, also where
    all of it is nearer than that: its mirrors are met from the eye on. An orthographic view has no eye."""
    outside |= orthographic and near == 9.0
    own, _ = ordered(shapes.combine(BALL), shading=False)
    view = View.looking_at((0.0, eye, 0.0), (0.0, 0.0, 0.0), (64, 48), field_of_view=0.1,
                           orthographic_scale=0.2 * orthographic)
    lens, far = view.projection.copy(), 100.0
    # as OpenGL defines it
    lens[2, 2:] = ((-2.0 / (far - near), -(far + near) / (far - near)) if orthographic
                   else (-(far + near) / (far - near), -2.0 * far * near / (far - near)))
    view = View(view.camera_to_world, lens, view.resolution)
    assert bool(ClosedBodies.of(own).outward_from(view).all()) == outside
    assert bool(ClosedBodies.of(own).outward_from(view).any()) == outside


def test_a_cone_loses_no_triangle_that_some_place_in_it_sees_from_the_front():
    rng = np.random.default_rng(7)
    mesh, _ = ordered(RING, shading=False)
    fronts = Fronts.of(mesh, ClosedBodies.of(mesh).outward)
    places = rng.normal(scale=4.0, size=(3, 300, 1)) + rng.normal(scale=rng.uniform(0.01, 1.0, (300, 1)),
                                                                 size=(3, 300, 3))
    cones = Cones.round(places, rng.normal(size=(3, 300, 3)))
    cone, triangle = (index.ravel() for index in np.meshgrid(np.arange(300), rng.choice(len(mesh.triangles), 400),
                                                             indexing="ij"))
    weights = rng.dirichlet(np.ones(3), len(cone)).T
    origin = (places[:, cone] * weights.T[None]).sum(axis=2)
    normal = mesh.face_normals()[triangle].T
    height = (normal * (origin - mesh.positions[mesh.triangles[triangle, 0]].T)).sum(axis=0)
    shown = fronts.may_show(cones, cone, triangle)
    assert shown[height > 0.0].all() and 0.3 < shown.mean() < 0.8


@pytest.mark.slow
@pytest.mark.parametrize("name", ["sphere", "torus", "bowl", "dense sphere", "dense cylinder"])
def test_hardly_a_face_turns_away_and_none_is_missed(name):
    case = dense(name.split()[1], (256, 256), 0.24) if name.startswith("dense") else SCENES[name]((256, 256))
    mesh = reflect(case.view, case.mirror, case.scene)
    every = reflect(case.view, case.mirror, case.scene, Settings(hidden_faces=True))
    truth = trace(case.view, case.mirror, case.scene)
    numbers, all_of_it = (compare(case.view, case.mirror, one, truth).numbers for one in (mesh, every))
    assert numbers["uncovered"] < all_of_it["uncovered"] + 0.02 and numbers["p99"] < 0.35
    assert len(mesh.triangles) < 0.9 * len(every.triangles)

    def away(one):
        closed = outward(case.scene)[one.source_face]
        corners = case.scene.positions[case.scene.triangles[one.source_face]]
        normal = closed[:, None] * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        height = np.einsum("fkx,fx->fk", one.mirror_position[one.triangles] - corners[:, :1], normal)
        size = np.ptp(corners, axis=1).max(axis=1)
        return (height < -0.05 * size[:, None] * np.linalg.norm(normal, axis=1)[:, None]).all(axis=1).mean()

    # of cameras that a plane goes through some places lie on either side of it
    assert away(mesh) < 0.06 and away(mesh) < 0.25 * away(every)
