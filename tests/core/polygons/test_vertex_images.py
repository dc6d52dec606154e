"""The images that the method keeps against every diffuse vertex projected in every camera."""
import numpy as np
import pytest

from core import Settings, TriangleMesh, View, project, reflect
from core.cameras.camera_splitting import in_picture
from core.cameras.mirror_map import MirrorMap
from core.cameras.mirror_refinement import refine_mirror
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from tests.inputs import shapes
from tests.inputs.scenes import Scene
from tests.oracles.true_map import size_of

pytestmark = pytest.mark.slow


def floating(kind, orthographic=False):
    """Small triangles all round a mirror, none of which hides another in it."""
    rng = np.random.default_rng(109)
    mirrors = {"ball": shapes.icosphere((0.0, 0.0, 0.0), 1.0, 3),
               "bowl": shapes.bowl((0.0, 0.0, 0.0), 3.0, 0.6, 32, 12),
               "flat": shapes.quad((0.0, 0.0, -3.0), (1.5, 0.2, 0.3), (-0.2, 1.5, 0.2)),
               "ring": shapes.torus((0.0, 0.0, 0.0), 1.0, 0.35, 48, 24)}
    directions = rng.normal(size=(70, 1, 3))
    directions /= np.linalg.norm(directions, axis=2, keepdims=True)
    if kind in ("bowl", "flat"):
        middles = rng.uniform((-1.0, -1.0, -1.5), (1.0, 1.0, 2.0), (70, 3))[:, None]
    else:
        middles = directions * rng.uniform(2.0, 5.0, (70, 1, 1))
    corners = (middles + rng.normal(scale=0.08, size=(70, 3, 3))).reshape(-1, 3)
    view = View.looking_at((0.7, -5.0, 4.5), (0.0, 0.0, -1.5 if kind in ("bowl", "flat") else 0.0), (600, 600),
                           field_of_view=0.7, orthographic_scale=3.5 if orthographic else 0.0)
    return Scene(kind, view, shapes.combine(mirrors[kind]), TriangleMesh(corners, np.arange(210).reshape(-1, 3)))


def brute_force(case):
    """Images of all vertices in all cameras that the picture shows: vertex, pixel, and the weights in the camera."""
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    cameras = cameras.select(in_picture(cameras))
    # Cameras this small interpolate what a Newton step makes of larger ones.
    cameras, _ = refine_mirror(cameras, 0.06, 8.0, 20_000)
    camera, vertex = (index.ravel() for index in
                      np.meshgrid(np.arange(len(cameras)), np.arange(len(case.scene.positions)), indexing="ij"))
    corners = cameras.corners[camera]
    found = project(cameras.places.T[corners], cameras.rays.T[corners], case.scene.positions[vertex])
    camera, vertex = camera[found.pair], vertex[found.pair]
    places = np.einsum("nk,nkx->nx", found.weights, cameras.places.T[cameras.corners[camera]])
    towards = -(case.mirror.face_normals()[cameras.face[camera]] * case.view.directions(places)).sum(axis=1)
    towards /= np.linalg.norm(case.view.directions(places), axis=1)
    return vertex, case.view.pixels(places), found.distance, np.abs(towards), found.parity


@pytest.mark.parametrize("orthographic", [False, True])
@pytest.mark.parametrize("kind", ["ball", "flat", "bowl"])
def test_every_image_found_by_brute_force_is_a_vertex_of_the_mesh_and_the_other_way(kind, orthographic):
    case = floating(kind, orthographic)
    vertex, pixel, _, towards, parity = brute_force(case)
    mesh = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.1))
    width, height = case.view.resolution
    gap = np.linalg.norm(mesh.reflected_position[:, None] - case.scene.positions, axis=2)
    near, own = gap.argmin(axis=1), gap.min(axis=1) < 1e-9 * size_of(case)
    drawn = case.view.pixels(mesh.positions)
    # Inside the picture, off the silhouette, where all depends on rounding, and off caustics, where images meet.
    inside = ((pixel > 2.0) & (pixel < np.array([width, height]) - 2.0)).all(axis=1) & (towards > 0.3) & (parity != 0)
    found = [np.linalg.norm(drawn[own & (near == v)] - p, axis=1).min(initial=np.inf)
             for v, p in zip(vertex[inside], pixel[inside])]
    assert inside.sum() > 30
    assert (np.array(found) < 0.25).mean() > 0.99
    # Of the mesh's own vertices, each is an image that brute force found.
    there = np.array([np.linalg.norm(pixel[vertex == v] - p, axis=1).min(initial=np.inf)
                      for v, p in zip(near[own], drawn[own])])
    assert (there < 0.25).mean() > 0.95


def test_a_ring_shows_some_points_more_than_once():
    case = floating("ring")
    mesh = reflect(case.view, case.mirror, case.scene, Settings(tolerance=0.1))
    drawn, several = case.view.pixels(mesh.positions), 0
    for point in case.scene.positions:
        images = drawn[np.linalg.norm(mesh.reflected_position - point, axis=1) < 1e-9]
        several += len(images) > 1 and np.ptp(images, axis=0).max() > 20.0
    assert several > 5
