"""Mirrors that bound one convex body are not asked whether they show themselves; all others are."""
import numpy as np
import pytest

from core import SceneTree, TriangleMesh, View
from core.cameras import MirrorMap, three_ray_cameras, visible_triangles
from core.culling import SceneAndMirrors
from core.geometry import ordered
from core.trees import Bound
from tests.inputs import shapes

SCENE = shapes.combine(shapes.box((0.0, -3.0, 0.0), (1.0, 1.0, 1.0)))
BALL = shapes.icosphere((0.0, 0.0, 0.0), 1.0, 3)


def star(turns, corners):
    """A prism over a polygon that winds about its middle so many times, with fans as caps; flat."""
    angle = 2.0 * np.pi * turns * np.arange(corners) / corners
    ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    low, high = (np.column_stack((ring, np.full(corners, height))) for height in (-0.5, 0.5))
    k, after = np.arange(corners), (np.arange(corners) + 1) % corners
    middle = 2 * corners
    sides = [np.stack(part, axis=1) for part in ((k, after, after + corners), (k, after + corners, k + corners),
                                                 (after, k, np.full(corners, middle)),
                                                 (k + corners, after + corners, np.full(corners, middle + 1)))]
    return np.concatenate((low, high, [[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]])), np.concatenate(sides), None


def single(surface):
    """As Blender holds it."""
    positions, triangles, normals = surface
    return positions.astype(np.float32).astype(np.float64), triangles, normals


def turned(surface):
    positions, triangles, normals = surface
    return positions, triangles[:, ::-1], normals


MIRRORS = {
    "ball": (BALL, True), "ball in single precision": (single(shapes.uv_sphere((7.0, 3.0, 1.0), 1.0, 24, 16)), True),
    "ball inside out": (turned(BALL), True), "box": (shapes.box((0.0, 0.0, 0.0), (1.0, 2.0, 1.0)), True),
    "prism": (star(1, 7), True), "star that winds twice": (star(2, 7), False), "cylinder without caps":
    (shapes.cylinder((0.0, 0.0, 0.0), 1.0, 1.0, 24), False), "ring": (shapes.torus((0, 0, 0), 1.0, 0.3, 24, 12), False),
    "water": (shapes.water(4.0, 0.1, 2.0, 12), False),
}


def met_and_cameras(mirror, eye=(0.3, -9.0, 2.0)):
    view = View.looking_at(eye, (0.0, 0.0, 0.0), (64, 64))
    mirror, _ = ordered(mirror, shading=True)
    met = SceneAndMirrors(SceneTree.build(SCENE), mirror)
    return met, three_ray_cameras(MirrorMap(view, mirror), mirror, visible_triangles(view, mirror))


def everything(cameras):
    return Bound(10**7, np.ones(len(cameras)))


@pytest.mark.parametrize("name", MIRRORS)
def test_convex_bodies_are_told(name):
    surface, convex = MIRRORS[name]
    met, cameras = met_and_cameras(shapes.combine(surface))
    assert (met.mirrors_in(cameras, everything(cameras)).visited == 0) == convex


def test_two_balls_show_each_other():
    met, cameras = met_and_cameras(shapes.combine(BALL, shapes.icosphere((3.0, 0.0, 0.0), 1.0, 3)))
    found = met.mirrors_in(cameras, everything(cameras))
    assert found.visited and len(found.cone) and len(found.triangle)


def test_a_convex_body_shows_itself_from_inside():
    mirror = shapes.combine(shapes.icosphere((0.0, 0.0, 0.0), 20.0, 2))
    met, cameras = met_and_cameras(mirror)
    assert len(np.unique(met.mirrors_in(cameras, everything(cameras)).cone)) == len(cameras)


@pytest.mark.parametrize("name", [name for name, (_, convex) in MIRRORS.items() if convex])
def test_nothing_rises_above_what_is_told_convex(name):
    met, _ = met_and_cameras(shapes.combine(MIRRORS[name][0]))
    mesh = TriangleMesh(met.mirrors.positions, met.mirrors.triangles)
    corners = mesh.positions[mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    side = np.sign((normal * (corners[:, 0] - corners.mean(axis=(0, 1)))).sum(axis=1))
    height = np.einsum("mnx,mx->mn", mesh.positions[None] - corners[:, :1], normal * side[:, None])
    assert height.max() < 1e-5 * met.size
