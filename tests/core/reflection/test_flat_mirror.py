"""A flat mirror against the closed form: every point is seen where its mirrored twin is."""
import numpy as np
import pytest

from core import PLACEMENTS, Settings, TriangleMesh, View, reflect
from tests.inputs import shapes
from tests.inputs.scenes import Scene
from tests.oracles.true_map import case_of, mesh_of, view_rays


def tilted(orthographic, seed, offset=0.0, scale=1.0):
    """A large quad in a random plane, the eye and 40 random triangles before it, all of them in the picture."""
    rng = np.random.default_rng(seed)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes[2] = np.cross(axes[0], axes[1])
    mirror = shapes.combine(shapes.quad((0.0, 0.0, 0.0), 9.0 * axes[0], 9.0 * axes[1]))
    middles = rng.uniform((-2.0, -2.0, 1.0), (2.0, 2.0, 4.0), (40, 1, 3))
    corners = (middles + rng.normal(scale=0.3, size=(40, 3, 3))).reshape(-1, 3) @ axes
    scene = TriangleMesh(corners, np.arange(120).reshape(-1, 3))
    view = View.looking_at(np.array([1.0, -2.0, 9.0]) @ axes, (0.0, 0.0, 0.0), (400, 300), field_of_view=1.2,
                           orthographic_scale=14.0 if orthographic else 0.0)
    return Scene("tilted", view, mirror, scene).moved("tilted", np.full(3, offset), scale)


CASES = {
    "flat": lambda: case_of("flat"),
    "flat_ortho": lambda: case_of("flat_ortho"),
    "tilted": lambda: tilted(False, 1),
    "tilted_ortho": lambda: tilted(True, 2),
    "tilted_far": lambda: tilted(False, 3, 1e4),
    "tilted_small": lambda: tilted(True, 4, 0.0, 1e-3),
}


def mirrored(case, points):
    """Points beyond the plane of the mirror's first triangle, and the length that rounding is judged by."""
    normal, middle = case.mirror.face_normals()[0], case.mirror.positions[case.mirror.triangles[0, 0]]
    twin = points - 2.0 * ((points - middle) @ normal)[:, None] * normal
    return twin, max(np.abs(case.scene.positions).max(), np.abs(case.mirror.positions).max())


@pytest.mark.thorough
@pytest.mark.parametrize("placement", PLACEMENTS)
@pytest.mark.parametrize("name", CASES)
def test_every_vertex_is_drawn_where_the_mirrored_point_is_seen(name, placement):
    case = CASES[name]()
    mesh = reflect(case.view, case.mirror, case.scene, Settings(placement=placement))
    assert len(mesh.positions) >= 100
    twin, size = mirrored(case, mesh.reflected_position)
    rounding = 1e-12 * size / np.ptp(case.scene.positions, axis=0).min() * max(case.view.resolution) * 10.0
    np.testing.assert_allclose(case.view.pixels(mesh.positions), case.view.pixels(twin), rtol=0, atol=rounding)
    if placement == "VIRTUAL":
        np.testing.assert_allclose(mesh.positions, twin, rtol=0, atol=3e-12 * size)
    if placement == "SURFACE":
        np.testing.assert_array_equal(mesh.positions, mesh.mirror_position)


@pytest.mark.parametrize("name", CASES)
def test_the_path_from_the_mirror_leads_to_the_reflected_point(name):
    case = CASES[name]()
    mesh = reflect(case.view, case.mirror, case.scene)
    twin, size = mirrored(case, mesh.reflected_position)
    _, direction = view_rays(case.view, mesh.mirror_position)
    normal = case.mirror.face_normals()[0]
    turned = direction - 2.0 * (direction @ normal)[:, None] * normal
    np.testing.assert_allclose(mesh.mirror_position + mesh.path_length[:, None] * turned, mesh.reflected_position,
                               rtol=0, atol=1e-12 * size)
    on_mirror = (mesh.mirror_position - case.mirror.positions[case.mirror.triangles[0, 0]]) @ normal
    assert np.abs(on_mirror).max() < 1e-12 * size
    np.testing.assert_allclose(np.linalg.norm(twin - mesh.mirror_position, axis=1), mesh.path_length, rtol=0,
                               atol=1e-12 * size)
    assert (mesh.image_parity == 1).all()


@pytest.mark.parametrize("name", ["tilted", "tilted_ortho", "tilted_far", "tilted_small"])
def test_every_point_whose_twin_is_behind_the_mirror_is_there(name):
    case = CASES[name]()
    mesh = reflect(case.view, case.mirror, case.scene)
    gap = np.linalg.norm(mesh.reflected_position[:, None] - case.scene.positions, axis=2).min(axis=0)
    assert gap.max() < 1e-12 * np.abs(case.scene.positions).max()
    np.testing.assert_array_equal(np.unique(mesh.source_face), np.arange(len(case.scene.triangles)))
    # Each triangle is whole: the areas of its parts, in its own weights, add up to one.
    u, v = mesh.source_weights[:, 1] - mesh.source_weights[:, 0], mesh.source_weights[:, 2] - mesh.source_weights[:, 0]
    parts = np.abs(u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    whole = np.bincount(mesh.source_face, weights=parts)
    np.testing.assert_allclose(whole, 1.0, rtol=0, atol=1e-12 * (1e4 if name == "tilted_far" else 1.0))


def test_orthographic_and_virtual_flat_images_need_no_refinement():
    # Interpolation across a face is exact in both, so that no edge is split, and nothing is left to estimate.
    for name, settings in (("flat_ortho", {}), ("flat", {"placement": "VIRTUAL"})):
        mesh = mesh_of(name, **settings)
        assert mesh.estimated_error < 1e-9
        assert mesh.counts["limited"] == 0
        assert len(mesh.triangles) == mesh_of(name, tolerance=1e-3, **settings).counts["faces"]


@pytest.mark.parametrize("turned", [False, True])
def test_what_lies_behind_the_mirror_is_not_reflected(turned):
    case = tilted(False, 5)
    normal = case.mirror.face_normals()[0]
    # Half the triangles go behind, some through the plane: only what lies before it is left.
    shift = np.repeat(np.linspace(-6.0, 0.0, 40), 3)[:, None] * normal * np.sign(case.view.eye @ normal)
    scene = TriangleMesh(case.scene.positions + shift, case.scene.triangles)
    mirror = TriangleMesh(case.mirror.positions, case.mirror.triangles[:, ::-1]) if turned else case.mirror
    mesh = reflect(case.view, mirror, scene)
    height = mesh.reflected_position @ normal * np.sign(case.view.eye @ normal)
    assert height.min() > -1e-12
    assert (height < 1e-9).sum() >= 2
    before = (scene.positions @ normal * np.sign(case.view.eye @ normal) > 0.0).reshape(-1, 3)
    assert 5 < before.any(axis=1).sum() < 40
    np.testing.assert_array_equal(np.unique(mesh.source_face), np.flatnonzero(before.any(axis=1)))
