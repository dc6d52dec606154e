"""What results ask of the parts of their sources: how finely each is seen, and from which sides mirrors see it."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import View, breathe
from ...core.geometry import doubled_areas
from ..reading import DiffuseScene, corner_vertices, mirrors_of, moves, numbers, vectors
from .seen_sources import triangle_of, weights_of

TURNED = 0.17      # sine of the angle by which a mirror may still be turned, or moved, before it shows other sides
LEAST_AREA = 1e-3  # of a pixel: smaller faces tell nothing of how fine what they show is


def asked_densities(results: list, view: View, scene: DiffuseScene, parts: list, divisions: dict) -> dict:
    """By source, in how many pixels per unit of length results show each of its parts (p,), or what lies beside it, at
    the most: 0 for what is not seen. `parts` are the triangles of each source in the scene's."""
    faces = [_faces(result, view, scene) for result in results]
    triangle, weights, density = (np.concatenate(part) for part in zip(*faces, strict=True))
    owner, own = scene.source_object[triangle], np.empty(len(scene.source_object), dtype=np.int64)
    for part in parts:
        own[part] = np.arange(len(part))
    breathe()
    return {number: division.greatest(own[triangle[owner == number]], weights[owner == number],
                                      density[owner == number]) for number, division in divisions.items()}


def pixels_shown(results: list, view: View) -> float:
    """In how many pixels results are seen, those before others among them."""
    seen = 0.0
    for result in results:
        spots = view.pixels(vectors(result.data, "mirror_position"))[corner_vertices(result.data)]
        seen += 0.5 * float(np.abs(doubled_areas(spots)).sum())
    return seen


def sides_before_mirrors(results: list, scene: DiffuseScene) -> np.ndarray:
    """Whether mirrors may show the front, and the back, of triangles, (2, m) bool, from wherever they are looked at:
    they do not see what looks away from all of them."""
    mirrors = [mirror for result in results for mirror in mirrors_of(result)]
    if any(mirror.type != "MESH" or moves(mirror) for mirror in mirrors) or any(map(_shows_mirrors, results)):
        return np.ones((2, len(scene.mesh.triangles)), dtype=bool)
    corners = scene.mesh.positions[scene.mesh.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    seen = np.zeros((2, len(corners)), dtype=bool)
    for mirror in mirrors:
        box = np.column_stack((np.array(mirror.bound_box, dtype=np.float64), np.ones(8)))
        for place in (box @ np.array(mirror.matrix_world, dtype=np.float64).T)[:, :3]:
            way = place - corners[:, 0]
            height, room = np.einsum("ni,ni->n", way, normal), TURNED * np.linalg.norm(way, axis=1)
            seen |= np.stack((height > -room, height < room))
    return seen


def _shows_mirrors(result: bpy.types.Object) -> bool:
    return bool((numbers(result.data, "bounces") > 1).any())


def _faces(result: bpy.types.Object, view: View, scene: DiffuseScene) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Triangle of the scene, weights (n, 3, 3) of its corners and pixels per unit of length, along the side of which
    that is most, of each face of a result; of what is seen in a mirror in a mirror the last is not known, and infinite.
    """
    mesh = result.data
    corners, triangle = corner_vertices(mesh), triangle_of(result, scene)
    shown, spots = vectors(mesh, "reflected_position")[corners], view.pixels(vectors(mesh, "mirror_position"))[corners]
    (along, up), (right, high) = ((at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]) for at in (shown, spots))
    one, both, other = (np.einsum("ni,ni->n", *pair) for pair in ((along, along), (along, up), (up, up)))
    breathe()
    wide, slant, tall = (np.einsum("ni,ni->n", *pair) for pair in ((right, right), (right, high), (high, high)))
    turned = np.abs(right[:, 0] * high[:, 1] - right[:, 1] * high[:, 0])
    # the greater singular value of the map from the face's plane to the picture
    with np.errstate(divide="ignore", invalid="ignore"):
        room = one * other - both * both
        half = 0.5 * (other * wide - 2.0 * both * slant + one * tall) / room
        density = np.sqrt(half + np.sqrt(np.maximum(half * half - turned * turned / room, 0.0)))
    density = np.where(numbers(mesh, "bounces") == 1, np.nan_to_num(density, nan=0.0), np.inf)
    told = 0.5 * turned > LEAST_AREA
    breathe()
    weights = weights_of(scene.mesh.positions[scene.mesh.triangles[triangle]], shown)
    return triangle[told], weights[told], density[told]
