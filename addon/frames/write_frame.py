"""One result at one frame as a USD file, and its light as an OpenEXR picture."""
from __future__ import annotations

import os
import zlib
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np

from ...core import ReflectionError
from ..faults import Steps, still_there
from ..files import is_whole
from .frame_records import ResultRecord
from .packed_mesh import packable, packed

# name of the object and its mesh in every file, where players look for them
NAME = "reflection"
OBJECT_PATH = f"/root/{NAME}"
MESH_PATH = f"{OBJECT_PATH}/{NAME}"
BITS = (12, 12, 8)      # bits of a material's number in each part of a colour; means of such small numbers are exact


def material_key(name: str, library: str) -> tuple[int, ...]:
    """Return a number for a material in three parts, which is the same in every process and file; zeros for no
    material.
    """
    number, parts = (max(zlib.crc32(f"{library}\n{name}".encode()), 1) if name else 0), []
    for bits in BITS:
        parts.append(number & ((1 << bits) - 1))
        number >>= bits
    return tuple(parts)


def write_result(context: bpy.types.Context, result: bpy.types.Object | None, path: str, lit: bool,
                 materials: list | None = None) -> Steps[ResultRecord]:
    """Write a result with its modifiers, or an empty one if it is None, with a step before each part.

    Parameters
    ----------
    materials : list, optional
        Materials to record instead of those of the result.

    Raises
    ------
    ReflectionError
        If the file cannot be written completely.
    """
    shows, matrix = None, None
    if result is not None:
        shown = result.evaluated_get(context.evaluated_depsgraph_get())
        shows = _read(shown.to_mesh(), result.data.materials if materials is None else materials)
        shown.to_mesh_clear()
        matrix = result.matrix_world.copy()
        yield 0.3, ""
    mesh = bpy.data.meshes.new(NAME)
    try:
        if shows is not None:
            _fill(mesh, shows)
            yield 0.6, ""
        _export(context, mesh, matrix, path)
    finally:
        # between two steps others may have removed it
        bpy.data.batch_remove(still_there([mesh]))
    yield 0.9, ""
    if not is_whole(path):
        raise _unwritten(path)
    attributes, slots = (shows.attributes, shows.materials) if shows else ((), ())
    return ResultRecord(os.path.basename(path), attributes, slots, lit)


def write_image(material: bpy.types.Material, path: str) -> None:
    """Write the image that a material of light shows, without loss.

    Raises
    ------
    ReflectionError
        If the file cannot be written completely.
    """
    shown = next(node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    try:
        Path(path).write_bytes(shown.packed_file.data)
    except OSError as error:
        raise _unwritten(path) from error
    if not is_whole(path):
        raise _unwritten(path)


@dataclass(frozen=True)
class _Shown:
    """A mesh as in files: positions (3 n,), corners (m,), first corners of faces (k,), colours as from `packed`, the
    packed attributes, and its materials (name, library).
    """

    positions: np.ndarray
    corners: np.ndarray
    starts: np.ndarray
    colours: dict
    attributes: tuple
    materials: tuple


def _read(shown: bpy.types.Mesh, slots) -> _Shown:
    """Read an evaluated mesh with the material slots `slots`."""
    positions = np.empty(3 * len(shown.vertices), dtype=np.float32)
    corners = np.empty(len(shown.loops), dtype=np.int32)
    starts, index = (np.empty(len(shown.polygons), dtype=np.int32) for _ in range(2))
    shown.vertices.foreach_get("co", positions)
    shown.loops.foreach_get("vertex_index", corners)
    shown.polygons.foreach_get("loop_start", starts)
    shown.polygons.foreach_get("material_index", index)
    materials = [(slot.name, slot.library.filepath if slot.library else "") if slot else ("", "") for slot in slots]
    keys = np.array([material_key(*entry) for entry in materials] or [(0,) * len(BITS)])
    attributes = packable(shown)
    colours = packed(shown, attributes, keys[np.minimum(index, len(keys) - 1)])
    return _Shown(positions, corners, starts, colours, tuple(attributes), tuple(dict.fromkeys(materials)))


def _fill(mesh: bpy.types.Mesh, shown: _Shown) -> None:
    """Write positions, faces and packed colours."""
    mesh.vertices.add(len(shown.positions) // 3)
    mesh.vertices.foreach_set("co", shown.positions)
    mesh.loops.add(len(shown.corners))
    mesh.polygons.add(len(shown.starts))
    mesh.loops.foreach_set("vertex_index", shown.corners)
    mesh.polygons.foreach_set("loop_start", shown.starts)
    for name, (domain, values) in shown.colours.items():
        mesh.attributes.new(name, "FLOAT_COLOR", domain).data.foreach_set("color", values.ravel())
    mesh.update()


def writes_usd() -> bool:
    """Return True if this Blender was built with USD. Builds of Linux distributions may lack it."""
    return bool(bpy.app.build_options.usd)


def _export(context: bpy.types.Context, mesh: bpy.types.Mesh, matrix, path: str) -> None:
    """Export a mesh from a scene of its own, under the names that players look for."""
    scene = bpy.data.scenes.new("Reflection Frame")
    obj = bpy.data.objects.new(NAME, mesh)
    try:
        for item in (obj, mesh):
            if item.name != NAME:
                raise ReflectionError(f"Something of this file is called '{NAME}', as what is baked must be: rename "
                                      "that object or mesh.")
        scene.collection.objects.link(obj)
        if matrix is not None:
            obj.matrix_world = matrix
        with context.temp_override(scene=scene, view_layer=scene.view_layers[0]):
            bpy.ops.wm.usd_export(filepath=path, export_materials=False, export_uvmaps=False, export_normals=False,
                                  root_prim_path="/root")
    except RuntimeError as error:
        raise _unwritten(path) from error
    finally:
        bpy.data.objects.remove(obj)
        bpy.data.scenes.remove(scene)


def _unwritten(path: str) -> ReflectionError:
    return ReflectionError(f"'{os.path.basename(path)}' cannot be written whole, as on a full disk: make room, or "
                           "choose another folder; the frames before it are kept.")
