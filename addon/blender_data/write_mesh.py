"""Arrays -> Blender mesh: triangles, the attributes that say where they came from, UV maps, colours and materials."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import ReflectionMesh
from .join_meshes import DiffuseScene

# a Blender mesh holds no more
MOST_UV_MAPS = 8


def mesh_arrays(result: ReflectionMesh, scene: DiffuseScene, triangle: np.ndarray, origin: np.ndarray) -> dict:
    """Everything that `write_mesh` writes, in Blender's own types, so that writing cannot fail half way.

    Parameters
    ----------
    result : ReflectionMesh
    scene : DiffuseScene
        What was reflected.
    triangle : (t,) int
        Index, in the mirror object, of each triangle of the mirror that `result` speaks of.
    origin : (3,) float64
        World position of the object's origin. Positions are kept relative to it: float32 is precise only near it.
    """
    source, mirror_face = result.source_face, result.mirror_face
    spans = mirror_face < 0
    weights = result.source_weights.astype(np.float32)
    return {
        "positions": (result.positions - origin).astype(np.float32),
        "triangles": result.triangles.astype(np.int32),
        "material_index": scene.material[source].astype(np.int32),
        "uv_maps": {name: _at_corners(weights, values, source) for name, values in scene.uv_maps.items()},
        "colours": {name: (kind, _at_corners(weights, values, source))
                    for name, (kind, values) in scene.colours.items()},
        "attributes": (
            ("reflected_position", "FLOAT_VECTOR", "POINT", "vector", result.reflected_position.astype(np.float32)),
            ("mirror_position", "FLOAT_VECTOR", "POINT", "vector", result.mirror_position.astype(np.float32)),
            ("path_length", "FLOAT", "POINT", "value", result.path_length.astype(np.float32)),
            ("image_parity", "INT", "POINT", "value", result.image_parity.astype(np.int32)),
            ("source_object", "INT", "FACE", "value", scene.source_object[source].astype(np.int32)),
            ("source_face", "INT", "FACE", "value", scene.source_face[source].astype(np.int32)),
            ("bounces", "INT", "FACE", "value", result.bounces.astype(np.int32)),
            ("mirror_face", "INT", "FACE", "value",
             np.where(spans, -1, triangle[np.where(spans, 0, mirror_face)]).astype(np.int32)),
        ),
        "materials": scene.materials,
        "active_uv": scene.active_uv,
        "active_colour": scene.active_colour,
    }


def _at_corners(weights: np.ndarray, values: np.ndarray, source: np.ndarray) -> np.ndarray:
    """Values (m, 3, c) at the corners of the result's faces, interpolated in their source triangles."""
    return np.matmul(weights, values[source])


def write_mesh(mesh: bpy.types.Mesh, arrays: dict) -> None:
    """Fill `mesh` anew from `mesh_arrays`; whatever geometry and materials it had are replaced."""
    mesh.clear_geometry()
    triangles = arrays["triangles"]
    mesh.vertices.add(len(arrays["positions"]))
    mesh.loops.add(triangles.size)
    mesh.polygons.add(len(triangles))
    mesh.attributes["position"].data.foreach_set("vector", arrays["positions"].reshape(-1))
    mesh.attributes[".corner_vert"].data.foreach_set("value", triangles.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
    _write_materials(mesh, arrays)
    _write_layers(mesh, arrays)
    for name, kind, domain, field, values in arrays["attributes"]:
        attribute = mesh.attributes.new(name, kind, domain)
        attribute.data.foreach_set(field, values.reshape(-1))
    mesh.update(calc_edges=True)


def _write_materials(mesh: bpy.types.Mesh, arrays: dict) -> None:
    mesh.materials.clear()
    for material in arrays["materials"]:
        mesh.materials.append(material)
    attribute = mesh.attributes.new("material_index", "INT", "FACE")
    attribute.data.foreach_set("value", arrays["material_index"])


def _write_layers(mesh: bpy.types.Mesh, arrays: dict) -> None:
    """UV maps and colour attributes, the active ones first: they must not fall to Blender's limit of UV maps."""
    taken = {name for name, *_ in arrays["attributes"]}
    for name, values in first(arrays["uv_maps"], arrays["active_uv"])[:MOST_UV_MAPS]:
        if name not in taken:
            taken.add(name)
            layer = mesh.uv_layers.new(name=name, do_init=False)
            layer.uv.foreach_set("vector", values.reshape(-1))
    for name, (kind, values) in first(arrays["colours"], arrays["active_colour"]):
        if name not in taken:
            attribute = mesh.color_attributes.new(name, kind, "CORNER")
            attribute.data.foreach_set("color", values.reshape(-1))
    if len(mesh.uv_layers):
        mesh.uv_layers[0].active = mesh.uv_layers[0].active_render = True
    if len(mesh.color_attributes):
        mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0


def first(entries: dict, name: str) -> list:
    """The entries as pairs, the one of that name first."""
    return sorted(entries.items(), key=lambda entry: entry[0] != name)
