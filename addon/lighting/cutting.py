"""What cuts through mirrors: frames, floors that they stand in, and whatever else a part of them is sunk in."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils.bvhtree import BVHTree

from ...core import TriangleMesh, breathe
from ..reading import drawn_meshes, read_mirror


def cut_through(depsgraph: bpy.types.Depsgraph, mirrors: set, objects: list) -> list:
    """Return those of `objects` that cross a mirror's triangles, or whose instances do."""
    surfaces, asked, found = [read_mirror(depsgraph, mirror).mesh for mirror in mirrors], set(objects), {}
    for instance in drawn_meshes(depsgraph):
        evaluated = instance.object
        owner = instance.parent.original if instance.is_instance else evaluated.original
        if owner not in asked or owner in found:
            continue
        breathe()
        matrix = np.array(instance.matrix_world, dtype=np.float64)
        box = _placed(np.array(evaluated.bound_box, dtype=np.float64), matrix)
        near = [surface for surface in surfaces if not _apart(surface.positions, box)]
        if near and any(_cross(surface, _triangles(evaluated, matrix)) for surface in near):
            found[owner] = True
    return list(found)


def _placed(places: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    return places @ matrix[:3, :3].T + matrix[:3, 3]


def _apart(one: np.ndarray, other: np.ndarray) -> bool:
    """Whether the boxes around places (n, 3) do not meet."""
    return not (len(one) and len(other)) or bool(
        (one.max(axis=0) < other.min(axis=0)).any() or (other.max(axis=0) < one.min(axis=0)).any())


def _triangles(evaluated: bpy.types.Object, matrix: np.ndarray) -> np.ndarray:
    """The triangles (m, 3, 3) of an object, in world space."""
    mesh = evaluated.to_mesh()
    try:
        places = np.empty(3 * len(mesh.vertices), dtype=np.float32)
        mesh.vertices.foreach_get("co", places)
        mesh.calc_loop_triangles()
        corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
        mesh.loop_triangles.foreach_get("vertices", corners)
        return _placed(places.reshape(-1, 3).astype(np.float64), matrix)[corners.reshape(-1, 3)]
    finally:
        evaluated.to_mesh_clear()


def _cross(surface: TriangleMesh, triangles: np.ndarray) -> bool:
    """Whether any of triangles (m, 3, 3) crosses one of a surface."""
    surfaces = surface.positions[surface.triangles]
    # trees are made of lists, and where something is cut is mostly a small part of it
    for _ in range(2):
        surfaces, triangles = _near(surfaces, triangles), _near(triangles, surfaces)
    breathe()
    if not (len(surfaces) and len(triangles)):
        return False
    trees = [BVHTree.FromPolygons(some.reshape(-1, 3).tolist(), np.arange(3 * len(some)).reshape(-1, 3).tolist(),
                                  all_triangles=True) for some in (surfaces, triangles)]
    return bool(trees[0].overlap(trees[1]))


def _near(some: np.ndarray, others: np.ndarray) -> np.ndarray:
    """Those of some triangles that come into the box around others."""
    if not (len(some) and len(others)):
        return some[:0]
    low, high = others.min(axis=(0, 1)), others.max(axis=(0, 1))
    return some[((some.max(axis=1) >= low) & (some.min(axis=1) <= high)).all(axis=1)]
