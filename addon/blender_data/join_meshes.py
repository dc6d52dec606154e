"""Local meshes -> one mesh in world space, each triangle knowing which object and which of its triangles it is."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core import ReflectionError, TriangleMesh
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
    placed = read_meshes(depsgraph, objects, normals=False)
    if not placed:
        raise ReflectionError(f"'{objects[0].name}' has no faces to reflect: choose diffuse objects with faces.")
    positions, triangles, corners, owners, faces, material, materials = _join(placed, len(objects))
    active_uv = next((item.mesh.active_uv for item in placed if item.mesh.active_uv), "")
    active_colour = next((item.mesh.active_colour for item in placed if item.mesh.active_colour), "")
    uv_maps = {name: _uv_map(placed, corners, name, name == active_uv) for name in _names(placed, "uv_maps")}
    colours = {name: _colour(placed, corners, name, name == active_colour) for name in _names(placed, "colours")}
    numbers = {name: _numbers(placed, corners, name) for name in _names(placed, "numbers")}
    return DiffuseScene(_triangle_mesh(objects, positions, triangles), list(objects), owners, faces, material,
                        materials, uv_maps, colours, numbers, active_uv, active_colour)


def read_normals(depsgraph: bpy.types.Depsgraph, objects: list) -> np.ndarray:
    """Shading normals (m, 3, 3) of the corners of all triangles that `read_scene` reads of `objects`."""
    return _joined_normals(read_meshes(depsgraph, objects, normals=True))


def read_mirror(depsgraph: bpy.types.Depsgraph, obj: bpy.types.Object) -> MirrorSurface:
    """The mirror `obj` in world space with its shading normals.

    Of an object that has mirror materials and others, only the faces with a mirror material reflect.

    Raises
    ------
    ReflectionError
        Where the mirror has no faces, or a coordinate or a normal is not a finite number.
    """
    placed = read_meshes(depsgraph, [obj], normals=True)
    if not placed:
        raise ReflectionError(f"The mirror '{obj.name}' has no faces: choose an object with faces.")
    positions, triangles, _, _, faces, material, materials = _join(placed, 1)
    normals = _joined_normals(placed)
    reflects = np.array([is_mirror(entry) for entry in materials])[material]
    kept = np.flatnonzero(reflects) if reflects.any() else np.arange(len(triangles))
    return MirrorSurface(_triangle_mesh([obj], positions, triangles[kept], normals[kept]), faces[kept])


def _joined_normals(placed: list[Placed]) -> np.ndarray:
    return np.concatenate([_world_normals(item).reshape(-1, 3, 3) for item in placed])


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


def _corner_order(matrices: np.ndarray) -> np.ndarray:
    """Order (k, 3) of a triangle's corners: a transform that turns space inside out turns its faces over."""
    turned = np.linalg.det(matrices[:, :3, :3]) < 0.0
    return np.where(turned[:, None], (0, 2, 1), (0, 1, 2))


def _repeated(indices: np.ndarray, order: np.ndarray, stride: int, start: int) -> np.ndarray:
    """Indices (m, 3) for each of k places, as (k m, 3), counted on by `stride` from place to place."""
    shift = start + stride * np.arange(len(order), dtype=np.int64)
    return (np.moveaxis(indices[:, order], 1, 0) + shift[:, None, None]).reshape(-1, 3)


def _world_normals(item: Placed) -> np.ndarray:
    """Corner normals (k, m, 3, 3) in world space, through the cofactors, which exist for a scale of zero too."""
    linear = item.matrices[:, :3, :3]
    cofactors = np.stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)], axis=1)
    cofactors *= np.where(np.linalg.det(linear) < 0.0, -1.0, 1.0)[:, None, None]
    normals = np.einsum("kij,mcj->kmci", cofactors, item.mesh.normals.astype(np.float64))
    return np.take_along_axis(normals, _corner_order(item.matrices)[:, None, :, None], axis=2)


def _names(placed: list[Placed], kind: str) -> list:
    return list(dict.fromkeys(name for item in placed for name in getattr(item.mesh, kind)))


def _uv_map(placed: list[Placed], corners: np.ndarray, name: str, active: bool) -> np.ndarray:
    """Values (m, 3, 2); a mesh without the active map shows its own active one, one without any other map zeros."""
    parts = []
    for item in placed:
        mesh = item.mesh
        values = mesh.uv_maps.get(name, mesh.uv_maps.get(mesh.active_uv) if active else None)
        values = np.zeros((mesh.corner_count, 2), np.float32) if values is None else values
        parts.append(np.tile(values, (len(item.owners), 1)))
    return np.concatenate(parts)[corners]


def _colour(placed: list[Placed], corners: np.ndarray, name: str, active: bool) -> tuple:
    """Type and values (m, 3, 4), as `_uv_map`; where meshes differ in type the colours are kept as floats."""
    parts, types = [], set()
    for item in placed:
        mesh = item.mesh
        entry = mesh.colours.get(name, mesh.colours.get(mesh.active_colour) if active else None)
        if entry is None:
            entry = (None, np.zeros((mesh.corner_count, 4), np.float32))
        types.add(entry[0])
        parts.append(np.tile(entry[1], (len(item.owners), 1)))
    kind = "BYTE_COLOR" if types <= {"BYTE_COLOR", None} else "FLOAT_COLOR"
    return kind, np.concatenate(parts)[corners]


def _numbers(placed: list[Placed], corners: np.ndarray, name: str) -> tuple:
    """Type and values (m, 3, c), zeros where a mesh has none, as engines have it; where meshes differ in type as
    vectors, of which a single number is each component."""
    entries = [item.mesh.numbers.get(name) for item in placed]
    kind = "FLOAT" if all(entry is None or entry[0] == "FLOAT" for entry in entries) else "FLOAT_VECTOR"
    width = 1 if kind == "FLOAT" else 3
    parts = [np.zeros((item.mesh.corner_count, width), np.float32) if entry is None
             else np.broadcast_to(entry[1], (item.mesh.corner_count, width)) for item, entry in zip(placed, entries)]
    return kind, np.concatenate([np.tile(part, (len(item.owners), 1)) for item, part in zip(placed, parts)])[corners]
