"""Faces as their sources have them: which side is seen, whose edges their sides are, normals as mirrors show them."""
import numpy as np
import pytest

import core.whole_faces.whole as whole_room
from core import Settings, TriangleMesh, View, reflect
from tests.inputs import shapes

BOX = (1.2, -1.6, 1.0), (0.9, 0.7, 1.1), 0.6
EYE = np.array((0.3, -6.0, 1.5))
VIEW = View.looking_at(EYE, (0, 0, 1), (400, 300))
WALL = shapes.quad((0, 1, 1), (2.5, 0, 0), (0, 0, 2.5))
TURNED = np.diag((1.0, -1.0, 1.0)), np.array((0.0, 2.0, 0.0))  # what the wall y = 1 does to places: linear part, offset


def mesh_of(shape) -> TriangleMesh:
    positions, triangles, normals = shape
    return TriangleMesh(positions, triangles, None if normals is None else normals[triangles])


def towards(view: View, mesh) -> np.ndarray:
    """How much each face is turned towards the eye, in square pixels."""
    a, b, c = np.moveaxis(view.pixels(mesh.positions)[mesh.triangles], 1, 0)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


@pytest.mark.thorough
@pytest.mark.parametrize("placement", ["LAYERED", "SURFACE", "VIRTUAL"])
@pytest.mark.parametrize("inside_out", [False, True])
def test_a_wall_shows_the_sides_that_its_mirrored_eye_sees(placement, inside_out):
    positions, triangles, _ = shapes.box(*BOX)
    scene = TriangleMesh(positions, triangles[:, ::-1] if inside_out else triangles)
    mesh = reflect(VIEW, mesh_of(WALL), scene, Settings(placement=placement, hidden_faces=True))
    seen_from = TURNED[0] @ EYE + TURNED[1]
    outward = scene.face_normals()
    front = ((seen_from - scene.positions[scene.triangles[:, 0]]) * outward).sum(axis=1) > 0.0
    turned = towards(VIEW, mesh)
    assert 0 < front.sum() < 12 and set(mesh.source_face) == set(range(12))
    assert ((turned > 0.0) == front[mesh.source_face])[np.abs(turned) > 1e-6].all()


@pytest.mark.thorough
@pytest.mark.parametrize("rings", [12, 80])
def test_a_ball_shows_the_sides_that_its_rays_meet(rings, monkeypatch):
    """By cameras, and by whole faces: along the ray that leaves the round ball where each face is seen."""
    monkeypatch.setattr(whole_room, "TOGETHER", 0.0)  # what is drawn together need not lie as its source
    centre, radius = np.array((0.0, 2.0, 1.0)), 2.0
    mirror = mesh_of(shapes.uv_sphere(centre, radius, 96, 48))
    scene = mesh_of(shapes.torus(np.array((1.2, -1.6, 1.0)), 0.5, 0.2, 2 * rings, rings))
    mesh = reflect(VIEW, mirror, scene, Settings(hidden_faces=rings == 12))
    assert ("whole" in mesh.counts) == (rings == 80)
    middle = mesh.mirror_position[mesh.triangles].mean(axis=1)
    ahead = (middle - EYE) / np.linalg.norm(middle - EYE, axis=1, keepdims=True)
    along = (ahead * (centre - EYE)).sum(axis=1)
    reach = along - np.sqrt(np.maximum(along**2 - (centre - EYE) @ (centre - EYE) + radius**2, 0.0))
    normal = (EYE + reach[:, None] * ahead - centre) / radius
    leaving = ahead - 2.0 * (ahead * normal).sum(axis=1, keepdims=True) * normal
    cosine = -(leaving * scene.face_normals()[mesh.source_face]).sum(axis=1)
    turned = towards(VIEW, mesh)
    clear = (np.abs(cosine) > 0.1) & (np.abs(turned) > 1e-6)
    # what turns away is drawn where all of the geometry is asked for
    assert clear.sum() > 0.7 * len(clear) and (cosine[clear] < 0.0).any() == (rings == 12)
    assert ((turned > 0.0) == (cosine > 0.0))[clear].all()


def two_walls() -> tuple:
    """A box in a corner of two walls at right angles, which turn what both show half round; the mirrors, the scene."""
    first = mesh_of(shapes.quad((0, 1, 1), (2.0, 0, 0), (0, 0, 2.5)))
    second = mesh_of(shapes.quad((2, -1, 1), (0, 2.0, 0), (0, 0, 2.5)))
    return first, TriangleMesh.joined([first, second]), mesh_of(shapes.box((0.9, -0.9, 1.0), (0.7, 0.5, 0.8), 0.4))


def test_two_bounces_show_the_sides_that_an_eye_mirrored_twice_sees():
    view = View.looking_at((-2.0, -6.0, 1.5), (1.2, 0, 1), (400, 300))
    first, mirrors, scene = two_walls()
    mesh = reflect(view, first, scene, Settings(depth=2, hidden_faces=True), mirrors)
    turned, outward = towards(view, mesh), scene.face_normals()
    for bounces, mirrored in ((1, (1, -1, 1)), (2, (-1, -1, 1))):
        eye = view.eye * mirrored + np.array((0, 2, 0) if bounces == 1 else (4, 2, 0))
        front = ((eye - scene.positions[scene.triangles[:, 0]]) * outward).sum(axis=1) > 0.0
        own = (mesh.bounces == bounces) & (np.abs(turned) > 1e-6)
        assert own.sum() > 12
        assert ((turned > 0.0) == front[mesh.source_face])[own].all()
        # and their normals are those of the box, mirrored as often
        normals = mesh.image_normals(scene.corner_normals)[own]
        assert np.abs(normals - (outward * mirrored)[mesh.source_face[own]][:, None]).max() < 1e-9


@pytest.mark.parametrize("mirror", ["wall", "ball"])
def test_sides_lie_on_the_edges_that_they_are_told_to(mirror):
    scene = mesh_of(shapes.box(*BOX))
    surface = mesh_of(WALL if mirror == "wall" else shapes.uv_sphere(np.array((0.0, 2.0, 1.0)), 2.0, 48, 24))
    mesh = reflect(VIEW, surface, scene)
    ends = np.stack((mesh.triangles, np.roll(mesh.triangles, -1, axis=1)), axis=2)
    corners = scene.positions[scene.triangles[mesh.source_face]]
    distance = np.stack([off_segments(mesh.reflected_position[ends], corners[:, None, None, side],
                                      corners[:, None, None, side - 2]).max(axis=2) for side in range(3)], axis=2)
    on = distance < 1e-9
    assert (mesh.source_sides == np.where(on.any(axis=2), on.argmax(axis=2), -1)).all()
    assert (mesh.source_sides < 0).sum() > 20 and set(np.unique(mesh.source_sides)) == {-1, 0, 1, 2}


def off_segments(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """How far points lie from segments, in scene units."""
    along = end - start
    share = np.clip(((points - start) * along).sum(axis=-1) / (along * along).sum(axis=-1), 0.0, 1.0)
    return np.linalg.norm(points - start - share[..., None] * along, axis=-1)


def test_normals_are_mirrored_by_a_wall_also_where_it_is_touched():
    positions, triangles, normals = shapes.uv_sphere(np.array((1.0, 0.0, 1.0)), 0.8, 32, 16)
    box = mesh_of(shapes.box((-1.0, 0.5, 1.0), (1.0, 1.0, 1.0)))  # to y = 1, where the wall is
    scene = TriangleMesh.joined([TriangleMesh(positions, triangles, normals[triangles]), box])
    mesh = reflect(VIEW, mesh_of(WALL), scene, Settings(hidden_faces=True))
    weighted = np.einsum("fkj,fjx->fkx", mesh.source_weights, scene.corner_normals[mesh.source_face])
    expected = weighted / np.linalg.norm(weighted, axis=2, keepdims=True) * (1.0, -1.0, 1.0)
    assert mesh.path_length.min() < 1e-9
    assert np.abs(mesh.image_normals(scene.corner_normals) - expected).max() < 1e-9


def test_points_have_no_normals():
    mesh = reflect(VIEW, mesh_of(WALL), mesh_of(shapes.box(*BOX)), Settings(method="POINTS"))
    assert mesh.image_normals(np.ones((12, 3, 3))).shape == (0, 3, 3)
