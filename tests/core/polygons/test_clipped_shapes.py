"""What general three-ray cameras see of triangles, against rays through them and against the count of S. Vallance's
thesis (Flinders 2005): a triangle gives 1 to 4 shapes of 2 to 9 corners."""
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
import pytest

from core import TriangleMesh, project
from core.cameras.three_ray_cameras import Cameras
from core.culling.candidates import Candidates, overlapping
from core.geometry.scene_frames import SceneFrames
from core.polygons.clipping import Polygons, clip
from core.polygons.convex_polygons import Line
from tests.inputs.random_cameras import random_cameras

pytestmark = pytest.mark.slow

COUNT = 200
PARTS = 48  # along each side of a camera
SAMPLES = 128
SPREADS = (0.1, 0.2, 0.4)
SMALL = 1e-3  # of a camera: smaller shapes are not counted, since straight pieces may cut them off


def grid(side):
    """Weights (n, 3) of the corners of `side` x `side` triangles that tile one, and the triangles (m, 3)."""
    i, j = (index.ravel() for index in np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij"))
    number = np.full((side + 2, side + 2), -1)
    kept = i + j <= side
    i, j = i[kept], j[kept]
    number[i, j] = np.arange(len(i))
    up = np.stack((number[i, j], number[i + 1, j], number[i, j + 1]), axis=1)[i + j < side]
    inner = i + j < side - 1
    down = np.stack((number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]), axis=1)[inner]
    return np.stack((side - i - j, i, j), axis=1) / side, np.concatenate((up, down))


@dataclass(frozen=True)
class Case:
    """Cameras, a triangle before each, and the triangle as clipped by each camera's parts."""

    cameras: Cameras
    frames: SceneFrames
    vertices: np.ndarray
    candidates: Candidates
    polygons: Polygons
    whole: np.ndarray  # of the parts: the camera
    corners: np.ndarray  # (k, 3) weights of the polygons' corners in their whole cameras
    crossed: np.ndarray  # of the cameras: whether the triangle reaches through them, a fourth kind of border


@cache
def clipped(spread):
    """Cameras whose rays gather within about `spread` of a focus, and triangles near the focus."""
    rng = np.random.default_rng(round(100 * spread))
    cameras = random_cameras(rng, COUNT, size=0.5)
    axis = rng.normal(size=(3, COUNT))
    middle = cameras.places[:, cameras.corners].mean(axis=2) + axis / np.linalg.norm(axis, axis=0)
    focus = np.repeat(middle, 3, axis=1) + rng.normal(scale=spread, size=(3, 3 * COUNT))
    cameras = replace(cameras, rays=focus - cameras.places)
    vertices = middle.T[:, None] + rng.normal(size=(COUNT, 3, 3)) * rng.uniform(0.1, 0.5, (COUNT, 1, 1))
    mesh = TriangleMesh(vertices.reshape(-1, 3), np.arange(3 * COUNT).reshape(-1, 3))
    frames = SceneFrames.of(mesh, np.arange(COUNT))
    weights, parts = grid(PARTS)
    places, rays = (np.einsum("wk,xnk->xnw", weights, given[:, cameras.corners]).reshape(3, -1)
                    for given in (cameras.places, cameras.rays))
    whole = np.repeat(np.arange(COUNT), len(parts))
    small = Cameras((np.arange(COUNT)[:, None, None] * len(weights) + parts).reshape(-1, 3), whole, places, rays,
                    places, cameras.mirror_map)
    candidates = overlapping(small, frames, np.arange(len(small)), whole)
    polygons = clip(candidates)
    part = candidates.camera[polygons.pair] % len(parts)
    corner_part = np.repeat(part, np.diff(polygons.start))
    corners = np.einsum("kp,pkw->pw", polygons.weights, weights[parts[corner_part]])
    crossed = np.zeros(COUNT, dtype=bool)
    touching = np.repeat(polygons.pair, np.diff(polygons.start))[polygons.after == Line.CONTACT]
    crossed[whole[candidates.camera[touching]]] = True
    return Case(cameras, frames, vertices, candidates, polygons, whole, corners, crossed)


def areas(case):
    """Areas of the polygons in parts of their whole cameras."""
    u, v, start = case.corners[:, 1], case.corners[:, 2], case.polygons.start
    after = np.arange(1, len(u) + 1)
    after[start[1:] - 1] = start[:-1]
    return np.add.reduceat(u * v[after] - v * u[after], start[:-1])


def sees(case, camera, weights):
    """Whether the rays of cameras (n,) at weights (n, 3) meet their triangles, by 3 x 3 systems."""
    place, ray = (np.einsum("nk,xnk->nx", weights, given[:, case.cameras.corners[camera]])
                  for given in (case.cameras.places, case.cameras.rays))
    a, b, c = (case.vertices[camera, k] for k in range(3))
    u, v, s = np.linalg.solve(np.stack((b - a, c - a, -ray), axis=2), (place - a)[..., None])[..., 0].T
    return (s > 0.0) & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0)


@pytest.mark.parametrize("spread", SPREADS)
def test_clipped_parts_of_a_camera_cover_what_its_rays_see(spread):
    case = clipped(spread)
    weights, cells = grid(SAMPLES)
    middles = weights[cells].mean(axis=1)
    seen = np.stack([sees(case, np.full(len(middles), camera), middles) for camera in range(COUNT)])
    camera = case.whole[case.candidates.camera[case.polygons.pair]]
    area = np.bincount(camera, weights=areas(case), minlength=COUNT)
    assert (seen.any(axis=1) & ~seen.all(axis=1)).sum() > 0.4 * COUNT
    np.testing.assert_allclose(area, seen.mean(axis=1), rtol=0, atol=0.004)
    # membership: middles of the polygons are seen, unless they lie at a rim
    size = np.diff(case.polygons.start)
    middle = np.add.reduceat(case.corners, case.polygons.start[:-1], axis=0) / size[:, None]
    whole = areas(case) > 0.5 / PARTS**2
    assert sees(case, camera[whole], middle[whole]).mean() > 0.999


def shapes_of(case):
    """The shape of each polygon: polygons are of one shape where they share the edge of a part."""
    corners = np.arange(len(case.corners))
    after = corners + 1
    after[case.polygons.start[1:] - 1] = case.polygons.start[:-1]
    polygon = np.repeat(np.arange(len(case.polygons.pair)), np.diff(case.polygons.start))
    long = np.abs(case.corners - case.corners[after]).max(axis=1) > 1e-9
    edge = np.flatnonzero((case.polygons.after < Line.SCENE_EDGE) & long)
    middle = 0.5 * (case.corners[edge] + case.corners[after[edge]])
    camera = case.whole[case.candidates.camera[case.polygons.pair]][polygon[edge]]
    key = np.concatenate((camera[:, None], np.rint(middle * 1e7).astype(np.int64)), axis=1)
    _, group = np.unique(key, axis=0, return_inverse=True)
    shape = np.arange(len(case.polygons.pair))
    while True:
        least = np.full(group.max() + 1, len(shape))
        np.minimum.at(least, group.ravel(), shape[polygon[edge]])
        smaller = shape.copy()
        np.minimum.at(smaller, polygon[edge], least[group.ravel()])
        if (smaller == shape).all():
            return shape
        shape = smaller


def exact_corners(case):
    """The corners of the three kinds, each alone: the cubic's images of vertices, the quadratic's crossings of scene
    edges with the camera's edges, and the camera's corners that see the triangle. Camera and weights (n, 3)."""
    rows = np.repeat(np.arange(COUNT), 3)
    places, rays = (np.moveaxis(given[:, case.cameras.corners[rows]], 0, 2)
                    for given in (case.cameras.places, case.cameras.rays))
    images = project(places, rays, case.vertices.reshape(-1, 3))
    camera, weights = [rows[images.pair]], [images.weights]
    seen = sees(case, rows, np.tile(np.eye(3), (COUNT, 1)))
    camera.append(rows[seen])
    weights.append(np.tile(np.eye(3), (COUNT, 1))[seen])
    for one, other in ((0, 1), (1, 2), (2, 0)):
        for p, q in ((0, 1), (1, 2), (2, 0)):
            value = []
            for t in (0.0, 0.5, 1.0):
                way = np.zeros((COUNT, 3))
                way[:, one], way[:, other] = 1.0 - t, t
                place, ray = (np.einsum("nk,xnk->nx", way, given[:, case.cameras.corners])
                              for given in (case.cameras.places, case.cameras.rays))
                # the ray and the edge's line lie in one plane
                edge = np.cross(case.vertices[:, q] - case.vertices[:, p], ray)
                value.append(((case.vertices[:, p] - place) * edge).sum(axis=1))
            for camera_, (low, half, high) in enumerate(zip(*value)):
                for t in np.roots((2.0 * (low + high - 2.0 * half), 4.0 * half - 3.0 * low - high, low)):
                    if abs(t.imag) > 0.0 or not 0.0 <= t.real <= 1.0:
                        continue
                    way = np.zeros(3)
                    way[one], way[other] = 1.0 - t.real, t.real
                    place, ray = (given[:, case.cameras.corners[camera_]] @ way
                                  for given in (case.cameras.places, case.cameras.rays))
                    start, end = case.vertices[camera_, p], case.vertices[camera_, q]
                    (s, r), *_ = np.linalg.lstsq(np.stack((ray, start - end), axis=1), start - place, rcond=None)
                    if s > 0.0 and 0.0 <= r <= 1.0:
                        camera.append([camera_])
                        weights.append(way[None])
    return np.concatenate(camera), np.concatenate(weights)


@pytest.mark.parametrize("spread", SPREADS)
def test_a_triangle_gives_one_to_four_shapes_of_two_to_nine_corners(spread):
    case = clipped(spread)
    shape, camera = shapes_of(case), case.whole[case.candidates.camera[case.polygons.pair]]
    area = np.bincount(shape, weights=areas(case), minlength=len(shape))
    shapes, large = (np.bincount(camera[np.flatnonzero(area > least)], minlength=COUNT) for least in (0.0, SMALL))
    assert large.max() <= 4
    asked = (large > 0) & ~case.crossed
    assert asked.sum() > 60 and (large[asked] > 1).sum() > 3
    corners = np.bincount(exact_corners(case)[0], minlength=COUNT)
    # a shape whose neck is thinner than any part can tell counts as two, once in hundreds
    assert (corners[asked] >= 2 * large[asked]).mean() > 0.98
    assert (corners[asked] <= 9 * shapes[asked]).all()
    assert len(np.unique(corners[asked & (shapes == 1)])) >= 4
