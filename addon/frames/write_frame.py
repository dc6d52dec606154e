"""One result at one frame as a USD file, and its light as an OpenEXR picture."""
from __future__ import annotations

import os
import zlib

import bpy
import numpy as np

from ...core import ReflectionError
from ..files import is_whole
from .frame_records import ResultRecord
from .packed_mesh import packable, packed

# of the object and its mesh in every file; players look there
NAME = "reflection"
OBJECT_PATH = f"/root/{NAME}"
MESH_PATH = f"{OBJECT_PATH}/{NAME}"
BITS = (12, 12, 8)      # of a material's number in each part of a colour: means of so small ones are exact


def material_key(name: str, library: str) -> tuple[int, ...]:
    """A number for a material in three parts, the same in whatever process and whatever else the file holds; zeros for
    none."""
    number, parts = (max(zlib.crc32(f"{library}\n{name}".encode()), 1) if name else 0), []
    for bits in BITS:
        parts.append(number & ((1 << bits) - 1))
        number >>= bits
    return tuple(parts)


def write_result(context: bpy.types.Context, result: bpy.types.Object | None, path: str, lit: bool,
                 materials: list | None = None) -> ResultRecord:
    """Write what a result shows, modifiers included, or nothing where there is none.

    Parameters
    ----------
    materials : list, optional
        What is told of its materials instead of these.

    Raises
    ------
    ReflectionError
        Where the file cannot be written whole.
    """
    mesh = bpy.data.meshes.new(NAME)
    try:
        attributes, slots, matrix = [], [], None
        if result is not None:
            depsgraph = context.evaluated_depsgraph_get()
            shown = result.evaluated_get(depsgraph)
            attributes, slots = _fill(mesh, shown.to_mesh(), result.data.materials if materials is None else materials)
            matrix = result.matrix_world
            shown.to_mesh_clear()
        _export(context, mesh, matrix, path)
    finally:
        bpy.data.meshes.remove(mesh)
    return ResultRecord(os.path.basename(path), tuple(attributes), tuple(slots), lit)


def write_image(material: bpy.types.Material, path: str) -> None:
    """The exact picture that a material of light shows.

    Raises
    ------
    ReflectionError
        Where the file cannot be written whole.
    """
    shown = next(node.image for node in material.node_tree.nodes if node.type == "TEX_IMAGE")
    pixels = np.empty(shown.size[0] * shown.size[1] * shown.channels, dtype=np.float32)
    shown.pixels.foreach_get(pixels)
    image = bpy.data.images.new(NAME, *shown.size, float_buffer=True, is_data=True)
    try:
        image.pixels.foreach_set(pixels)
        image.filepath_raw, image.file_format = path, "OPEN_EXR"
        image.save()
    except RuntimeError as error:
        raise _unwritten(path) from error
    finally:
        bpy.data.images.remove(image)
    if not is_whole(path):
        raise _unwritten(path)


def _fill(mesh: bpy.types.Mesh, shown: bpy.types.Mesh, slots) -> tuple[list, list]:
    """Positions, faces and packed colours of an evaluated mesh; returns its attributes and materials."""
    positions = np.empty(3 * len(shown.vertices), dtype=np.float32)
    corners = np.empty(len(shown.loops), dtype=np.int32)
    starts, index = (np.empty(len(shown.polygons), dtype=np.int32) for _ in range(2))
    shown.vertices.foreach_get("co", positions)
    shown.loops.foreach_get("vertex_index", corners)
    shown.polygons.foreach_get("loop_start", starts)
    shown.polygons.foreach_get("material_index", index)
    mesh.vertices.add(len(shown.vertices))
    mesh.vertices.foreach_set("co", positions)
    mesh.loops.add(len(corners))
    mesh.polygons.add(len(starts))
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.foreach_set("loop_start", starts)
    materials = [(slot.name, slot.library.filepath if slot.library else "") if slot else ("", "") for slot in slots]
    keys = np.array([material_key(*entry) for entry in materials] or [(0,) * len(BITS)])
    attributes = packable(shown)
    for name, (domain, values) in packed(shown, attributes, keys[np.minimum(index, len(keys) - 1)]).items():
        mesh.attributes.new(name, "FLOAT_COLOR", domain).data.foreach_set("color", values.ravel())
    mesh.update()
    return attributes, list(dict.fromkeys(materials))


def writes_usd() -> bool:
    """Whether this Blender was built with USD; those of Linux distributions may not be."""
    return bool(bpy.app.build_options.usd)


def _export(context: bpy.types.Context, mesh: bpy.types.Mesh, matrix, path: str) -> None:
    """Write a mesh alone, from a scene of its own, whose objects have the names that players look for."""
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
    if not is_whole(path):
        raise _unwritten(path)


def _unwritten(path: str) -> ReflectionError:
    return ReflectionError(f"'{os.path.basename(path)}' cannot be written whole, as on a full disk: make room, or "
                           "choose another folder; the frames before it are kept.")
