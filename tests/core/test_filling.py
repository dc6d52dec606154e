"""Cameras filled by one ray each: the ray's first triangle, found by trying all, and no other."""
import numpy as np

from core import SceneTree
from core.camera_splitting import in_picture
from core.cameras import three_ray_cameras, visible_triangles
from core.candidates import overlapping
from core.clipping import clip
from core.cones import Cones
from core.filling import fill
from core.mirror_map import MirrorMap
from core.scene_frames import SceneFrames
from tests.core.true_map import case_of


def rooms():
    case = case_of("sphere_ico")
    mirror_map = MirrorMap(case.view, case.mirror)
    cameras = three_ray_cameras(mirror_map, case.mirror, visible_triangles(case.view, case.mirror))
    cameras = cameras.select(in_picture(case.view, cameras))
    tree = SceneTree.build(case.scene)
    camera, triangle, _ = tree.trace(Cones.around(cameras))
    met, column = np.unique(triangle, return_inverse=True)
    frames = SceneFrames.of(tree.mesh, met)
    candidates = overlapping(cameras, frames, camera, column)
    return tree.mesh, mirror_map, cameras, frames, candidates, clip(candidates)


def first_triangle(scene, origin, ray):
    """The triangle that a ray meets first, -1 for none, by solving for every triangle of the scene alone."""
    a, b, c = (scene.positions[scene.triangles[:, corner]] for corner in range(3))
    columns = np.stack((b - a, c - a, np.broadcast_to(-ray, a.shape)), axis=-1)
    regular = np.abs(np.linalg.det(columns)) > 1e-12
    u, v, s = np.linalg.solve(np.where(regular[:, None, None], columns, np.eye(3)), (origin - a)[..., None])[..., 0].T
    hit = regular & (u >= 0) & (v >= 0) & (u + v <= 1) & (s > 0)
    return int(np.argmin(np.where(hit, s, np.inf))) if hit.any() else -1


def test_an_open_camera_shows_the_triangle_that_its_middle_ray_meets_first():
    scene, mirror_map, cameras, frames, candidates, polygons = rooms()
    rng = np.random.default_rng(127)
    open_ = rng.random(len(cameras)) < 0.5
    filled, rays = fill(mirror_map, cameras, frames, candidates, polygons, open_)
    assert rays > 100
    camera = candidates.camera[filled.pair]
    triangle = frames.triangle[candidates.column[filled.pair]]
    middle = cameras.places[:, cameras.corners].mean(axis=2)
    ray = mirror_map.rays(cameras.face, mirror_map.coordinates(cameras.face, middle))
    seen = 0
    for number in np.flatnonzero(open_):
        shown = triangle[camera == number].tolist()
        expected = first_triangle(scene, middle[:, number], ray[:, number])
        assert shown == ([] if expected < 0 else [expected])
        seen += expected >= 0
    assert seen > 100
    # The filled ones are whole cameras; all others keep the polygons they had.
    size = np.diff(filled.start)
    whole = np.flatnonzero(open_[camera])
    assert (size[whole] == 3).all()
    np.testing.assert_array_equal(filled.weights[:, filled.start[whole[0]]:filled.start[whole[0]] + 3], np.eye(3))
    kept = ~open_[candidates.camera[polygons.pair]]
    np.testing.assert_array_equal(filled.pair[:kept.sum()], polygons.pair[kept])
    np.testing.assert_array_equal(filled.weights[:, :filled.start[kept.sum()]],
                                  polygons.weights[:, np.repeat(kept, np.diff(polygons.start))])


def test_nothing_open_changes_nothing():
    _, mirror_map, cameras, frames, candidates, polygons = rooms()
    same, rays = fill(mirror_map, cameras, frames, candidates, polygons, np.zeros(len(cameras), dtype=bool))
    assert same is polygons
    assert rays == 0
