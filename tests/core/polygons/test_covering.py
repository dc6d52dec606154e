"""What mirrors are said to hide from whole cameras is hidden, by tracing rays of the cameras one by one."""
from dataclasses import replace

import numpy as np
import pytest

from core import SceneTree, TriangleMesh, View
from core.cameras.camera_splitting import split_cameras
from core.cameras.mirror_map import MirrorMap
from core.cameras.three_ray_cameras import three_ray_cameras, visible_triangles
from core.culling.scene_and_mirrors import SceneAndMirrors
from core.geometry.canonical_order import ordered
from core.geometry.scene_frames import SceneFrames
from core.polygons.covering import Overlaps
from tests.inputs import shapes
from tests.oracles.ray_hits import first_hits, plane_hits

VIEW = View.looking_at((0.5, -6.0, 2.2), (0.0, 0.0, 1.0), (128, 96), field_of_view=0.5)
ROOM = shapes.combine(shapes.box((0.0, 4.0, 2.0), (6.0, 1.0, 4.0)), shapes.box((0.0, -8.0, 2.0), (9.0, 1.0, 4.0)),
                      shapes.quad((0.0, 0.0, -0.5), (9.0, 0.0, 0.0), (0.0, 9.0, 0.0)))
MIRRORS = {
    "balls": shapes.combine(shapes.icosphere((0.0, 0.0, 1.0), 0.8, 2), shapes.icosphere((0.5, -1.5, 1.0), 0.3, 2)),
    "a ring": shapes.combine(shapes.torus((0.0, 0.0, 1.2), 1.0, 0.4, 24, 12)),
    "a bowl": shapes.combine(shapes.bowl((0.0, 0.0, 1.2), 1.2, 1.0, 32, 12)),
    "boxes through boxes": shapes.combine(shapes.box((0, 0, 1), (1, 1, 1), 0.5),
                                          shapes.box((0.9, -1.2, 1.2), (0.7, 0.9, 0.6), 0.1)),
}
STEPS = 7
GRID = np.array([(i, j, STEPS - i - j) for i in range(STEPS + 1) for j in range(STEPS + 1 - i)]) / STEPS
GRID = 0.98 * GRID + 0.02 / 3.0  # rays on the borders are the neighbours' too
PAIRS = 600
ENOUGH = 1500  # cameras, so that some are smaller than the mirrors' triangles


def overlaps_of(mirror: TriangleMesh) -> Overlaps:
    """All pairs of the mirror's cameras and what they may meet, but of each camera's own neighbours."""
    mirror = ordered(mirror, shading=True)[0]
    cameras = three_ray_cameras(MirrorMap(VIEW, mirror), mirror, visible_triangles(VIEW, mirror))
    while len(cameras) < ENOUGH:
        cameras, *_ = split_cameras(cameras, np.ones((len(cameras), 3), dtype=bool))
    met = SceneAndMirrors(SceneTree.build(ROOM), mirror)
    frames = SceneFrames.of(met, np.arange(len(met.triangles)))
    camera, column = (side.ravel() for side in np.indices((len(cameras), len(met.triangles))))
    beside = met.diffuse <= column
    apart = np.ones(len(column), dtype=bool)
    own, other = mirror.triangles[cameras.face[camera[beside]]], mirror.triangles[column[beside] - met.diffuse]
    apart[beside] = ~(own[:, :, None] == other[:, None]).any(axis=(1, 2))
    return Overlaps.of(cameras, frames, (camera[apart], column[apart]), met)


@pytest.mark.thorough
@pytest.mark.parametrize("name", MIRRORS)
def test_what_is_dropped_lies_behind_a_mirror(name):
    overlaps = overlaps_of(MIRRORS[name])
    candidates, mirror = overlaps.candidates, overlaps.mirror
    count = len(candidates.frames.triangle)
    kept = overlaps.in_sight(last=False)
    dropped = ~np.isin(candidates.camera * count + candidates.column, kept.camera * count + kept.column)
    assert dropped.any()
    pairs = np.random.default_rng(3).permutation(np.flatnonzero(dropped & ~mirror))[:PAIRS]
    cameras, frames = candidates.cameras, candidates.frames
    corners, face = cameras.corners[candidates.camera[pairs]], cameras.face[candidates.camera[pairs]]
    origins, rays = (np.einsum("xnk,wk->nwx", values[:, corners], GRID).reshape(-1, 3)
                     for values in (cameras.origins, cameras.rays))
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    triangles = frames.vertices.T
    distance, weights = plane_hits(TriangleMesh(frames.positions, triangles),
                                   np.repeat(candidates.column[pairs], len(GRID)), origins, rays)
    hit = (distance > 0.0) & (weights > 0.0).all(axis=1)
    own = ordered(MIRRORS[name], shading=True)[0]
    _, nearest = first_hits(own, origins, rays, leaving=np.repeat(face, len(GRID)))
    assert (nearest[hit] < distance[hit]).all()
    assert hit.sum() > 100


@pytest.mark.thorough
def test_mirrors_that_hide_nothing_are_dropped_where_light_ends():
    overlaps = overlaps_of(MIRRORS["a ring"])
    last, going_on = overlaps.in_sight(last=True), overlaps.in_sight(last=False)
    assert len(last) < len(going_on)
    diffuse = [part.column < overlaps.candidates.column[overlaps.mirror].min() for part in (last, going_on)]
    assert diffuse[0].sum() == diffuse[1].sum()
    assert set(last.camera[~diffuse[0]]) <= set(last.camera[diffuse[0]])


def test_a_mirror_that_may_end_in_a_camera_covers_nothing():
    overlaps = overlaps_of(MIRRORS["a ring"])
    open_ = replace(overlaps, ends=overlaps.mirror, candidates=replace(
        overlaps.candidates, sides=np.minimum(overlaps.candidates.sides, 0.0)))
    assert len(open_.in_sight(last=False)) == len(overlaps.candidates)
