"""Read evaluated Blender meshes as arrays in object space, with their placements."""
from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial

import bpy
import numpy as np

from ....core import ReflectionError
from ..materials import asked_attributes
from .creases import Creases
from .hidden_instances import is_rendered
from .instance_answers import InstanceAnswers
from .read_layers import NO_LAYERS, read_layers
from .shading_normals import bent_faces, corner_normals, with_bent_faces
from .source_lines import SourceLines

FARTHEST = 1e17  # scene units; the squares of somewhat larger coordinates overflow single precision


@dataclass(frozen=True)
class LocalMesh:
    """A triangulated mesh in its object's space.

    Attributes
    ----------
    positions : (n, 3) float32
    triangles : (m, 3) int32
        Vertices of Blender's own triangulation (`Mesh.loop_triangles`).
    corners : (m, 3) int32
        Face corners of the triangles.
    corner_count : int
    material_index : (m,) int32
    materials : tuple
        The object's materials by index; None where a slot is empty.
    normals : (m, 3, 3) float32
        Shading normals of the corners: smooth, flat or custom, as Cycles shades.
    lines : SourceLines or None
        None of a mirror.
    uv_maps : dict of str to (corners, 2) float32
    colours, numbers : dict of str to (type, (corners, c) float32)
    active_uv, active_colour : str
        As `read_layers` gives them; empty of a mirror.
    texture_space : (2, 3) float32
        Middle and half size of the box in which Generated coordinates are counted.
    """

    positions: np.ndarray
    triangles: np.ndarray
    corners: np.ndarray
    corner_count: int
    material_index: np.ndarray
    materials: tuple
    normals: np.ndarray
    lines: SourceLines | None
    uv_maps: dict
    colours: dict
    numbers: dict
    active_uv: str
    active_colour: str
    texture_space: np.ndarray


@dataclass(frozen=True)
class Placed:
    """A mesh and its k placements.

    Attributes
    ----------
    mesh : LocalMesh
    owners : (k,) int
        Index of the participant of each placement.
    matrices : (k, 4, 4) float64
        Transforms to world space.
    instances : (k,) bool
        True for instances, False for the participant's own mesh.
    told : (k, 6) float64
        Values of Object Info: random number from 0 to 1, object index and RGBA colour.
    answers : tuple of dict
        Result of `InstanceAnswers` for each placement, if it was requested.
    """

    mesh: LocalMesh
    owners: np.ndarray
    matrices: np.ndarray
    instances: np.ndarray
    told: np.ndarray
    answers: tuple[dict, ...] = ()

    @cached_property
    def turned_over(self) -> np.ndarray:
        """True (k,) for placements that mirror the mesh."""
        return np.linalg.det(self.matrices[:, :3, :3]) < 0.0

    @cached_property
    def cofactors(self) -> np.ndarray:
        """Matrices (k, 3, 3) that transform normals to world space, also where a scale is zero."""
        linear = self.matrices[:, :3, :3]
        across = np.stack([np.cross(linear[:, (i + 1) % 3], linear[:, (i + 2) % 3]) for i in range(3)], axis=1)
        return across * np.where(self.turned_over, -1.0, 1.0)[:, None, None]

    @cached_property
    def creases(self) -> Creases:
        """The creases of the mesh in its placements; not for mirrors."""
        assert self.mesh.lines is not None
        return self.mesh.lines.creases(self.cofactors)


def drawn_meshes(depsgraph: bpy.types.Depsgraph) -> Iterator[bpy.types.DepsgraphObjectInstance]:
    """Yield every instance that is drawn as a mesh. Curves, text and metaballs appear twice: as themselves, and as
    instances of the generated meshes, which are what engines draw.
    """
    return (instance for instance in depsgraph.object_instances
            if instance.object.type == "MESH" and instance.show_self)


def read_meshes(depsgraph: bpy.types.Depsgraph, objects: list, mirror: bool, known: Callable | None = None,
                unmirrored: bool = False, answered: bool = False) -> list[Placed]:
    """Read each distinct mesh of `objects`, with modifiers applied, and all placements of the mesh and its instances.

    Parameters
    ----------
    objects : list of bpy.types.Object
        Instances belong to their instancer.
    mirror : bool
        Read only the shape. Normals must be finite.
    known : callable or None
        Cache of meshes. It is called with the name of a mesh, the `session_uid` of all data that it depends on, and a
        function that reads it.
    unmirrored : bool
        Include instances that are hidden from glossy rays. Mirrors always include them.
    answered : bool
        Evaluate the attributes that materials read at each placement, see `InstanceAnswers`.

    Raises
    ------
    ReflectionError
        If a coordinate, a normal or a transform is not a finite number, or is too large for Blender.
    """
    owner_of = {obj: index for index, obj in enumerate(objects)}
    meshes, owners, matrices, instances, told, replies = {}, {}, {}, {}, {}, {}
    asked: dict[tuple, frozenset] = {}
    given: dict = {}
    answer = InstanceAnswers(depsgraph.scene.frame_current_final) if answered else None
    for instance in drawn_meshes(depsgraph):
        evaluated = instance.object
        original = evaluated.original
        owner = owner_of.get(instance.parent.original if instance.is_instance else original)
        if owner is None:
            continue
        if instance.is_instance and not (is_rendered(instance, given) and takes_part(original)
                                         and (mirror or unmirrored or original.visible_glossy)):
            continue
        materials = tuple(slot.material.original if slot.material else None for slot in evaluated.material_slots)
        key = (evaluated.data.as_pointer(), materials)
        if key not in meshes:
            read = partial(_read, evaluated, materials, mirror)
            meshes[key] = read() if known is None else known(*_name(instance, materials, mirror, asked), read)
            owners[key], matrices[key], instances[key], told[key], replies[key] = [], [], [], [], []
        owners[key].append(owner)
        instances[key].append(instance.is_instance)
        told[key].append((instance.random_id % 2**32 / (2**32 - 1), evaluated.pass_index, *evaluated.color))
        matrices[key].append(np.array(instance.matrix_world, dtype=np.float64))
        if answer is not None:
            replies[key].append(answer.of(instance, materials))
    placed = []
    for key, mesh in meshes.items():
        if mesh is None:
            continue
        matrix = np.stack(matrices[key])
        _check(mesh, matrix, objects[owners[key][0]].name)
        placed.append(Placed(mesh, np.array(owners[key]), matrix, np.array(instances[key]), np.array(told[key]),
                             tuple(replies[key])))
    return placed


def _check(mesh: LocalMesh, matrix: np.ndarray, name: str) -> None:
    """Raise `ReflectionError` if the transforms `matrix` (k, 4, 4) of a mesh are not finite, or place it too far away.
    """
    if not np.isfinite(matrix).all():
        raise ReflectionError(f"'{name}' has a transform that is not a finite number: "
                              "clear its location, rotation and scale.")
    reach = np.abs(mesh.positions).max(axis=0, initial=0.0).astype(np.float64)
    if (np.abs(matrix[:, :3, :3]) @ reach + np.abs(matrix[:, :3, 3])).max() > FARTHEST:
        raise ReflectionError(f"'{name}' reaches further than 1e17 units from the origin, "
                              "where Blender's numbers end: make it smaller or move it nearer.")


def _name(instance: bpy.types.DepsgraphObjectInstance, materials: tuple, mirror: bool,
          asked: dict[tuple, frozenset]) -> tuple[tuple, frozenset]:
    """Return a cache key of the mesh of an instance, and the `session_uid` of all data that it depends on. The key is
    valid while the depsgraph reports no change of these. `asked` caches the attributes that each tuple of materials
    reads.
    """
    evaluated = instance.object
    original = evaluated.original
    owners = [original, instance.parent.original] if instance.is_instance else [original]
    uids = [item.session_uid for owner in owners for item in (owner, owner.data) if item is not None]
    if materials not in asked:
        asked[materials] = frozenset(asked_attributes(materials or tuple(evaluated.data.materials)))
    shown = tuple(0 if material is None else material.session_uid for material in materials)
    mesh = evaluated.data
    return (mirror, mesh.as_pointer(), len(mesh.vertices), len(mesh.loops), len(mesh.polygons), *uids, shown,
            asked[materials]), frozenset(uids)


def takes_part(obj: bpy.types.Object) -> bool:
    """Return True for an object that may be read as an instance, by its role."""
    return obj.reflection_mesh.role not in {"IGNORE", "REFLECTION", "CAUSTICS"}


def _read(obj: bpy.types.Object, materials: tuple, mirror: bool) -> LocalMesh | None:
    """Read the mesh of an evaluated object; return None if it has no faces."""
    mesh = obj.to_mesh()
    if mesh is None:
        return None
    if not len(mesh.polygons):
        obj.to_mesh_clear()
        return None
    positions = _values(mesh.attributes["position"].data, "vector", (len(mesh.vertices), 3), np.float32)
    if not np.isfinite(positions).all():
        obj.to_mesh_clear()
        raise ReflectionError(f"'{obj.name}' has a vertex whose coordinates are not finite numbers: remove or repair "
                              "it.")
    corners, face = _triangulation(mesh)
    corner_vertex = _values(mesh.attributes[".corner_vert"].data, "value", len(mesh.loops), np.int32)
    materials = materials or tuple(mesh.materials)
    normals = corner_normals(mesh)
    if mirror and not np.isfinite(normals).all():
        obj.to_mesh_clear()
        raise ReflectionError(f"'{obj.name}' has a normal that is not a finite number: recalculate its normals.")
    normals[~np.isfinite(normals)] = 0.0
    triangles = corner_vertex[corners]
    normals = with_bent_faces(normals[corners], positions[triangles], bent_faces(mesh)[face])
    local = LocalMesh(
        positions, triangles, corners, len(mesh.loops), _face_materials(mesh)[face], materials,
        normals, None if mirror else SourceLines.of(mesh, corners, face),
        *(NO_LAYERS if mirror else read_layers(mesh, materials)),
        np.array((mesh.texspace_location, mesh.texspace_size), dtype=np.float32))
    obj.to_mesh_clear()
    return local


def _values(data, name: str, shape, dtype) -> np.ndarray:
    """Return all values of one property of a collection. The array has the exact type and length, so that Blender
    copies one block.
    """
    array = np.empty(shape, dtype=dtype)
    data.foreach_get(name, array.reshape(-1))
    return array


def _triangulation(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Return the face corners (m, 3) and the polygon (m,) of each triangle."""
    if len(mesh.loops) == 3 * len(mesh.polygons):
        # triangles already: their corners lie in order
        face = np.arange(len(mesh.polygons), dtype=np.int32)
        return np.arange(len(mesh.loops), dtype=np.int32).reshape(-1, 3), face
    mesh.calc_loop_triangles()
    count = len(mesh.loop_triangles)
    return (_values(mesh.loop_triangles, "loops", (count, 3), np.int32),
            _values(mesh.loop_triangle_polygons, "value", count, np.int32))


def _face_materials(mesh: bpy.types.Mesh) -> np.ndarray:
    attribute = mesh.attributes.get("material_index")
    if attribute is None or attribute.data_type != "INT" or attribute.domain != "FACE":
        return np.zeros(len(mesh.polygons), dtype=np.int32)
    return _values(attribute.data, "value", len(mesh.polygons), np.int32)
