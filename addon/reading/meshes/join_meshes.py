"""Join local meshes into one mesh in world space, with the source object and source triangle of each triangle."""
from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ....core import ReflectionError, TriangleMesh, breathe
from ..materials import which_reflect
from ..metaballs import basis_of, is_part
from ..nothing_seen import NothingSeen
from .join_layers import join_layers
from .placed_values import PlacedValues, generated_places, lines_of, normals_of, own_normals, own_places
from .read_meshes import Placed, read_meshes
from .shading_normals import told_apart


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
    normals : PlacedValues of (m, 3, 3) float64
        Of the corners, not of unit length; as all that follow worked out where they are asked for.
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
    generated, own_places, own_normals : PlacedValues of (m, 3, 3) float32
        The corners in Generated and in Object coordinates, and the normals there in the latter.
    """

    mesh: TriangleMesh
    sources: list
    source_object: np.ndarray
    source_face: np.ndarray
    material: np.ndarray
    materials: list
    normals: PlacedValues
    sharp_face: PlacedValues
    marked_face: PlacedValues
    sharp_side: PlacedValues
    marked_side: PlacedValues
    uv_maps: dict
    colours: dict
    numbers: dict
    active_uv: str
    active_colour: str
    generated: PlacedValues
    own_places: PlacedValues
    own_normals: PlacedValues


@dataclass(frozen=True)
class MirrorSurface:
    """The reflecting triangles of one mirror: `triangle` (m,) are their indices in the object's triangulation,
    `material` (m,) those of their materials in `materials`."""

    mesh: TriangleMesh
    triangle: np.ndarray
    material: np.ndarray
    materials: list


def read_scene(depsgraph: bpy.types.Depsgraph, objects: list, unmirrored: bool = False) -> DiffuseScene:
    """Read the diffuse `objects` and join them in world space. Include instances that are hidden from glossy rays (and
    so from mirrors) only if `unmirrored` is set.

    Raises
    ------
    NothingSeen
        If the objects have no faces.
    ReflectionError
        If a coordinate is not a finite number.
    """
    return join_scene(read_meshes(depsgraph, objects, mirror=False, unmirrored=unmirrored), objects)


def join_scene(placed: list[Placed], objects: list) -> DiffuseScene:
    """Join meshes that have been read into the result of `read_scene`."""
    if not placed:
        raise NothingSeen(f"'{objects[0].name}' has no faces to reflect: choose objects with faces.")
    positions, triangles, owners, faces, material, materials = _join(placed, len(objects))
    return DiffuseScene(_triangle_mesh(objects, positions, triangles), list(objects), owners, faces, material,
                        materials, normals_of(placed), *lines_of(placed), *join_layers(placed),
                        generated_places(placed), own_places(placed), own_normals(placed))


def read_mirror(depsgraph: bpy.types.Depsgraph, obj: bpy.types.Object) -> MirrorSurface:
    """Read the mirror `obj` in world space with its shading normals.

    Of an object that has mirror materials and others, only the faces with a mirror material reflect.

    Raises
    ------
    ReflectionError
        Where the mirror has no faces, `NothingSeen`, or a coordinate or a normal is not a finite number.
    """
    return join_mirror(read_meshes(depsgraph, [obj], mirror=True), [obj])


def read_mirrors(depsgraph: bpy.types.Depsgraph, mirrors: list) -> tuple[dict[bpy.types.Object, MirrorSurface], list]:
    """Read several mirrors. Return the surfaces by object, and a message for each mirror without faces.

    Raises
    ------
    ReflectionError
        If no mirror has faces (`NothingSeen`), or if one cannot be read.
    """
    surfaces, faceless = {}, []
    for obj in mirrors:
        try:
            surfaces[obj] = read_mirror(depsgraph, obj)
        except NothingSeen as error:
            faceless.append(error)
    if not surfaces:
        raise faceless[0]
    return surfaces, list(map(str, faceless))


def join_mirror(placed: list[Placed], parts: list) -> MirrorSurface:
    """Join meshes that have been read into the surface of one mirror.

    Parameters
    ----------
    placed : list of Placed
        The meshes. The owner of each is an index into `parts`.
    parts : list of bpy.types.Object
        The objects of the mirror.

    Raises
    ------
    ReflectionError
        See `read_mirror`.
    """
    if not placed:
        obj = parts[0]
        if is_part(obj):
            raise ReflectionError(f"The mirror '{obj.name}' is a part of the metaball '{basis_of(obj).name}': choose "
                                  "that instead.")
        raise NothingSeen(f"The mirror '{obj.name}' has no faces: choose an object with faces.")
    positions, triangles, owners, _, material, materials = _join(placed, len(parts))
    reflects = np.zeros(len(triangles), dtype=bool)
    for number in range(len(parts)):
        own = owners == number
        on_faces = np.unique(material[own])
        reflecting = on_faces[which_reflect([materials[index] for index in on_faces])]
        reflects |= own & np.isin(material, reflecting)
    kept = np.flatnonzero(reflects)
    material = material[kept]
    normals = told_apart(normals_of(placed)[kept], material)
    return MirrorSurface(_triangle_mesh(parts, positions, triangles[kept], normals), kept.astype(np.int32), material,
                         materials)


def _triangle_mesh(objects: list, positions, triangles, normals=None) -> TriangleMesh:
    try:
        return TriangleMesh(positions, triangles, normals)
    except ValueError as error:
        raise ReflectionError(f"{objects[0].name}: {error}") from error


def _join(placed: list[Placed], count: int) -> tuple:
    """Join all placements of some meshes into one mesh.

    Parameters
    ----------
    placed : list of Placed
    count : int
        Number of objects; the owners of the placements are indices below it.

    Returns
    -------
    positions : (n, 3) float64
        In world space.
    triangles : (m, 3) int64
    owners : (m,) int32
        Index of the object of each triangle.
    faces : (m,) int32
        Index of each triangle within its object; those of its further placements are counted on.
    material : (m,) int32
        Index into `materials` of each triangle.
    materials : list of bpy.types.Material or None
        Distinct materials; None for faces without one.
    """
    positions, triangles, owners, faces, material = [], [], [], [], []
    materials, index_of = [], {}
    counted = np.zeros(count, dtype=np.int64)
    vertex_start = 0
    for item in placed:
        breathe()
        mesh, places = item.mesh, len(item.owners)
        world = np.matmul(mesh.positions.astype(np.float64), item.matrices[:, :3, :3].swapaxes(1, 2))
        world += item.matrices[:, None, :3, 3]
        positions.append(world.reshape(-1, 3))
        breathe()
        vertices, count = len(mesh.positions), len(mesh.triangles)
        turned = np.where(item.turned_over[:, None], (0, 2, 1), (0, 1, 2))
        triangles.append(_repeated(mesh.triangles, turned, vertices, vertex_start))
        vertex_start += places * vertices
        breathe()
        owners.append(np.repeat(item.owners.astype(np.int32), count))
        faces.append((_counted_on(item.owners, counted, count)[:, None] + np.arange(count, dtype=np.int32)).ravel())
        slots = mesh.materials or (None,)
        for entry in slots:
            if entry not in index_of:
                index_of[entry] = len(materials)
                materials.append(entry)
        table = np.array([index_of[entry] for entry in slots], dtype=np.int32)
        material.append(np.tile(table[np.clip(mesh.material_index, 0, len(slots) - 1)], places))
    return (*map(_in_one, (positions, triangles, owners, faces, material)), materials)


def _in_one(parts: list) -> np.ndarray:
    breathe()
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _counted_on(owners: np.ndarray, counted: np.ndarray, count: int) -> np.ndarray:
    """Return for each placement, with owners (k,), the number of triangles of the same owner before it. Each placement
    has `count` triangles. Add them to `counted`, the number per owner, in place.
    """
    order = np.argsort(owners, kind="stable")
    before = np.empty(len(owners), dtype=np.int64)
    before[order] = np.arange(len(owners)) - np.searchsorted(owners[order], owners[order])
    starts = counted[owners] + count * before
    counted += count * np.bincount(owners, minlength=len(counted))
    return starts.astype(np.int32)


def _repeated(indices: np.ndarray, order: np.ndarray, stride: int, start: int) -> np.ndarray:
    """Repeat the triangles `indices` (m, 3) for k placements, as (k m, 3). Each placement adds `stride` to the vertex
    indices. `order` (k, 3) is the order of corners, reversed for placements that mirror the mesh.
    """
    shift = start + stride * np.arange(len(order), dtype=np.int64)
    if (order == order[0]).all():
        return (indices[:, order[0]].astype(np.int64) + shift[:, None, None]).reshape(-1, 3)
    return (np.moveaxis(indices[:, order], 1, 0) + shift[:, None, None]).reshape(-1, 3)
