"""Local meshes -> one mesh in world space, each triangle knowing which object and which of its triangles it is."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, TriangleMesh
from .join_layers import join_layers
from .mirror_materials import is_mirror
from .read_meshes import Placed, read_meshes


@dataclass(frozen=True)
class DiffuseScene:
    """All diffuse objects as one mesh in world space.

    Attributes
    ----------
    mesh : core.TriangleMesh
    sources : list of bpy.types.Object
    source_object : (m,) int32
        Index into `sources` of each triangle.
    source_face : (m,) int32
        The triangle within its source; those of instances are counted on.
    material : (m,) int32
        Index into `materials`.
    materials : list
        Distinct materials; None where faces have no material.
    normals : (m, 3, 3) float64
        Of the corners, not of unit length.
    sharp_face, marked_face : (m,) bool
        Of faces that are flat, and of those marked for Freestyle.
    sharp_side, marked_side : (m, 3) bool
        Sides of the triangles, from corner k to the next, that are sharp edges or creases, and those marked for
        Freestyle.
    uv_maps : dict of str to (m, 3, 2) float32
    colours : dict of str to (type, (m, 3, 4) float32)
    numbers : dict of str to (type, (m, 3, c) float32)
        Other attributes that materials ask for; type is FLOAT or FLOAT_VECTOR.
    active_uv, active_colour : str
    """

    mesh: TriangleMesh
    sources: list
    source_object: np.ndarray
    source_face: np.ndarray
    material: np.ndarray
    materials: list
    normals: np.ndarray
    sharp_face: np.ndarray
    marked_face: np.ndarray
    sharp_side: np.ndarray
    marked_side: np.ndarray
    uv_maps: dict
    colours: dict
    numbers: dict
    active_uv: str
    active_colour: str


@dataclass(frozen=True)
class MirrorSurface:
    """The reflecting triangles of one mirror: `triangle` (m,) are their indices in the object's triangulation."""

    mesh: TriangleMesh
    triangle: np.ndarray


def read_scene(depsgraph: bpy.types.Depsgraph, objects: list) -> DiffuseScene:
    """The diffuse `objects` joined in world space.

    Raises
    ------
    ReflectionError
        Where they have no faces, or a coordinate is not a finite number.
    """
    placed = read_meshes(depsgraph, objects, mirror=False)
    if not placed:
        raise ReflectionError(f"'{objects[0].name}' has no faces to reflect: choose diffuse objects with faces.")
    positions, triangles, corners, owners, faces, material, materials = _join(placed, len(objects))
    return DiffuseScene(_triangle_mesh(objects, positions, triangles), list(objects), owners, faces, material,
                        materials, _all_normals(placed), *_lines(placed), *join_layers(placed, corners))


def read_mirror(depsgraph: bpy.types.Depsgraph, obj: bpy.types.Object) -> MirrorSurface:
    """The mirror `obj` in world space with its shading normals.

    Of an object that has mirror materials and others, only the faces with a mirror material reflect.

    Raises
    ------
    ReflectionError
        Where the mirror has no faces, or a coordinate or a normal is not a finite number.
    """
    placed = read_meshes(depsgraph, [obj], mirror=True)
    if not placed:
        raise ReflectionError(f"The mirror '{obj.name}' has no faces: choose an object with faces.")
    positions, triangles, _, _, faces, material, materials = _join(placed, 1)
    normals = _all_normals(placed)
    reflects = np.array([is_mirror(entry) for entry in materials])[material]
    kept = np.flatnonzero(reflects) if reflects.any() else np.arange(len(triangles))
    return MirrorSurface(_triangle_mesh([obj], positions, triangles[kept], normals[kept]), faces[kept])


def _triangle_mesh(objects: list, positions, triangles, normals=None) -> TriangleMesh:
    try:
        return TriangleMesh(positions, triangles, normals)
    except ValueError as error:
        raise ReflectionError(f"{objects[0].name}: {error}") from error


def _join(placed: list[Placed], count: int) -> tuple:
    """World positions, triangles, corners (indices into the joined corners), owner, triangle in its owner, material."""
    positions, triangles, corners, owners, faces, material = [], [], [], [], [], []
    materials, index_of = [], {}
    counted = np.zeros(count, dtype=np.int64)
    vertex_start = corner_start = 0
    for item in placed:
        mesh, places = item.mesh, len(item.owners)
        world = np.einsum("kij,nj->kni", item.matrices[:, :3, :3], mesh.positions.astype(np.float64))
        positions.append((world + item.matrices[:, None, :3, 3]).reshape(-1, 3))
        order = _corner_order(item.matrices)
        vertices, edges = len(mesh.positions), mesh.corner_count
        triangles.append(_repeated(mesh.triangles, order, vertices, vertex_start))
        corners.append(_repeated(mesh.corners, order, edges, corner_start))
        vertex_start, corner_start = vertex_start + places * vertices, corner_start + places * edges
        owners.append(np.repeat(item.owners, len(mesh.triangles)))
        starts = np.empty(places, dtype=np.int64)
        for place, owner in enumerate(item.owners):
            starts[place] = counted[owner]
            counted[owner] += len(mesh.triangles)
        faces.append((starts[:, None] + np.arange(len(mesh.triangles))).ravel())
        slots = mesh.materials or (None,)
        for entry in slots:
            if entry not in index_of:
                index_of[entry] = len(materials)
                materials.append(entry)
        table = np.array([index_of[entry] for entry in slots])
        material.append(np.tile(table[np.clip(mesh.material_index, 0, len(slots) - 1)], places))
    return (np.concatenate(positions), np.concatenate(triangles), np.concatenate(corners),
            np.concatenate(owners).astype(np.int32), np.concatenate(faces).astype(np.int32),
            np.concatenate(material).astype(np.int32), materials)


def _turned_over(matrices: np.ndarray) -> np.ndarray:
    """Which transforms (k,) turn space inside out."""
    return np.linalg.det(matrices[:, :3, :3]) < 0.0


def _corner_order(matrices: np.ndarray) -> np.ndarray:
    """Order (k, 3) of a triangle's corners: a transform that turns space inside out turns its faces over."""
    return np.where(_turned_over(matrices)[:, None], (0, 2, 1), (0, 1, 2))


def _repeated(indices: np.ndarray, order: np.ndarray, stride: int, start: int) -> np.ndarray:
    """Indices (m, 3) for each of k places, as (k m, 3), counted on by `stride` from place to place."""
    shift = start + stride * np.arange(len(order), dtype=np.int64)
    return (np.moveaxis(indices[:, order], 1, 0) + shift[:, None, None]).reshape(-1, 3)


def _cofactors(matrices: np.ndarray) -> np.ndarray:
    """What takes normals to world space, (k, 3, 3): also where a scale is zero."""
    linear = matrices[:, :3, :3]
    cofactors = np.stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)], axis=1)
    return cofactors * np.where(_turned_over(matrices), -1.0, 1.0)[:, None, None]


def _all_normals(placed: list[Placed]) -> np.ndarray:
    """Corner normals (m, 3, 3) in world space."""
    parts = []
    for item in placed:
        local = item.mesh.normals.reshape(-1, 3).astype(np.float64)
        normals = np.matmul(local, _cofactors(item.matrices).swapaxes(1, 2)).reshape(-1, *item.mesh.normals.shape)
        over = _turned_over(item.matrices)
        normals[over] = normals[over][:, :, [0, 2, 1]]
        parts.append(normals.reshape(-1, 3, 3))
    return np.concatenate(parts)


def _lines(placed: list[Placed]) -> tuple[np.ndarray, ...]:
    """Faces that are sharp (m,), those that are marked, sides that are sharp (m, 3), those that are marked."""
    parts = []
    for item in placed:
        lines, places = item.mesh.lines, len(item.owners)
        sides = lines.lines(_cofactors(item.matrices))
        over = _turned_over(item.matrices)
        for flags in sides:
            # side k leads to the next corner: of a triangle turned over, from the last corner to the one before
            flags[over] = flags[over][:, :, ::-1]
        parts.append([*(np.tile(flags[lines.face], places) for flags in (lines.sharp_faces, lines.marked_faces)),
                      *(flags.reshape(-1, 3) for flags in sides)])
    return tuple(map(np.concatenate, zip(*parts)))
