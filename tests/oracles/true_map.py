"""What the tests of the method share: meshes made once a run, and the true map at the corners of their faces."""
from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from scipy.spatial import cKDTree

from core import ReflectionMesh, Settings, reflect
from tests.inputs.scenes import SCENES, Scene
from tests.oracles.truth import Truth, reflected_rays, trace

PIXELS = 256
SIDES = 8  # parts of a side between the places that tell where a triangle of the mirror lies


@cache
def case_of(name: str, pixels: int = PIXELS) -> Scene:
    return SCENES[name]((pixels, pixels))


@cache
def truth_of(name: str, pixels: int = PIXELS) -> Truth:
    case = case_of(name, pixels)
    return trace(case.view, case.mirror, case.scene)


@cache
def mesh_of(name: str, pixels: int = PIXELS, **settings) -> ReflectionMesh:
    case = case_of(name, pixels)
    return reflect(case.view, case.mirror, case.scene, Settings(**settings))


def size_of(case: Scene) -> float:
    """The longest side of the box round the mirror, in scene units."""
    return float(np.ptp(case.mirror.positions[case.mirror.triangles.ravel()], axis=0).max())


def view_rays(view, places):
    """Origins and unit directions of the eye's rays through `places` (n, 3)."""
    if view.orthographic:
        directions = np.broadcast_to(view.forward, places.shape)
        return places - directions, directions
    directions = places - view.eye
    return np.broadcast_to(view.eye, places.shape), directions / np.linalg.norm(directions, axis=1, keepdims=True)


def true_rays(mirror, face, origins, directions):
    """`truth.reflected_rays`, but for rays that would enter the flat triangle: there, as in Cycles, the normal is
    turned towards the flat one until the ray rises by 0.01, or by 0.9 of what the view ray falls by: by bisection;
    and whether the normal was turned."""
    place, ray, weights = reflected_rays(mirror, face, origins, directions)
    flat = mirror.face_normals()[face]
    side = np.where((flat * directions).sum(axis=1) > 0.0, -1.0, 1.0)[:, None]
    flat = side * flat
    least = np.minimum(-0.9 * (flat * directions).sum(axis=1), 0.01)
    bent = np.flatnonzero((ray * flat).sum(axis=1) < least)
    flat, least, direction = flat[bent], least[bent], directions[bent]
    normal = side[bent] * np.einsum("nk,nkx->nx", weights[bent], mirror.corner_normals[face[bent]])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    low, high = np.zeros(len(bent)), np.ones(len(bent))
    for _ in range(60):
        share = 0.5 * (low + high)
        turned = normal + share[:, None] * (flat - normal)
        turned /= np.linalg.norm(turned, axis=1, keepdims=True)
        leaving = direction - 2.0 * (direction * turned).sum(axis=1, keepdims=True) * turned
        clears = (leaving * flat).sum(axis=1) > least
        low, high = np.where(clears, low, share), np.where(clears, share, high)
    ray[bent] = leaving
    return place, ray, weights, np.isin(np.arange(len(face)), bent)


def picture_areas(view, mesh: ReflectionMesh) -> np.ndarray:
    """Signed areas (m,) of the faces in the picture, in square pixels, positive counter-clockwise."""
    a, b, c = np.moveaxis(view.pixels(mesh.positions)[mesh.triangles], 1, 0)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


@dataclass(frozen=True)
class Corners:
    """Corners (m, 3) of a mesh's faces against the true map of the mirror's triangle that the face names.

    Attributes
    ----------
    miss : (m, 3) float64
        Distance of the reflected position from the ray that leaves the mirror where the corner is seen, over the size
        of the mirror.
    displacement : (m, 3) float64
        The same over the motion of the ray's point for one pixel, as the judge counts it.
    along : (m, 3) float64
        Distance along the ray, over the size of the mirror.
    weights : (m, 3, 3) float64
        Barycentric coordinates on the mirror's triangle.
    off_mirror : (m, 3) float64
        Distance of the mirror position from the mirror's triangle along the view ray, over the size of the mirror.
    magnified : (m, 3) float64
        Area of a pixel's ray bundle at the reflected point over its area on the mirror, negative where turned over.
    bent : (m, 3) bool
        The ray would have entered the mirror and was turned, as `true_rays` tells.
    """

    miss: np.ndarray
    displacement: np.ndarray
    along: np.ndarray
    weights: np.ndarray
    off_mirror: np.ndarray
    magnified: np.ndarray
    bent: np.ndarray


def faces_at_corners(case: Scene, mesh: ReflectionMesh) -> np.ndarray:
    """The mirror's triangle (3 m,) at each corner of the faces: the one that the face names, or, where it spans
    several, the one that the corner lies on, of the nearest few the one that its place is least far from."""
    face, place = np.repeat(mesh.mirror_face, 3), mesh.mirror_position[mesh.triangles.ravel()]
    open_ = np.flatnonzero(face < 0)
    if not len(open_):
        return face
    corners = case.mirror.positions[case.mirror.triangles]
    # long triangles are near all over, not only round their middles
    weights = np.array([(i, j, SIDES - i - j) for i in range(SIDES + 1) for j in range(SIDES + 1 - i)]) / SIDES
    _, near = cKDTree(np.einsum("kc,mcx->mkx", weights, corners).reshape(-1, 3)).query(place[open_], k=24)
    near //= len(weights)
    a, u, v = corners[near, 0], corners[near, 1] - corners[near, 0], corners[near, 2] - corners[near, 0]
    normal, away = np.cross(u, v), place[open_][:, None] - a
    square = np.maximum((normal * normal).sum(axis=2), 1e-300)
    b, c = ((np.cross(*sides) * normal).sum(axis=2) / square for sides in ((away, v), (u, away)))
    height = np.abs((away * normal).sum(axis=2)) / np.sqrt(square)
    beside = np.maximum(-np.minimum(np.minimum(b, c), 1.0 - b - c), 0.0) * np.sqrt(np.sqrt(square))
    face[open_] = np.take_along_axis(near, (height + beside).argmin(axis=1)[:, None], axis=1)[:, 0]
    return face


def corners_on_true_map(case: Scene, mesh: ReflectionMesh) -> Corners:
    face, vertex, size = faces_at_corners(case, mesh), mesh.triangles.ravel(), size_of(case)
    place, point = mesh.mirror_position[vertex], mesh.reflected_position[vertex]
    found, ray, weights, bent = true_rays(case.mirror, face, *view_rays(case.view, place))
    along = ((point - place) * ray).sum(axis=1)
    miss = _across(point - place, ray)
    motion, pixel, starts = [], case.view.pixels(place), []
    for step in ((0.02, 0.0), (0.0, 0.02)):
        (q, ray_q, *_), (p, ray_p, *_) = (true_rays(case.mirror, face, *case.view.rays(pixel + side * np.array(step)))
                                          for side in (-1.0, 1.0))
        starts.append(25.0 * _across(q - p, ray))
        motion.append(25.0 * _across(q - p + along[:, None] * (ray_q - ray_p), ray))
    magnified = [(np.cross(*moves) * ray).sum(axis=1) for moves in (motion, starts)]
    miss, motion = np.linalg.norm(miss, axis=1), np.linalg.norm(motion, axis=2).max(axis=0)
    shape = (-1, 3)
    return Corners((miss / size).reshape(shape), (miss / motion).reshape(shape),
                   (along / size).reshape(shape), weights.reshape(-1, 3, 3),
                   (np.linalg.norm(found - place, axis=1) / size).reshape(shape),
                   (magnified[0] / magnified[1]).reshape(shape), bent.reshape(shape))


@cache
def corners_of(name: str) -> Corners:
    return corners_on_true_map(case_of(name), mesh_of(name))


def _across(vectors, ray):
    return vectors - (vectors * ray).sum(axis=1, keepdims=True) * ray
