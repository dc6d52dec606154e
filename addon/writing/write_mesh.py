"""Arrays -> Blender mesh: faces or loose points, attributes, UV maps, colours and materials."""
from __future__ import annotations

import bpy
import numpy as np

from .. import compat
from .arrays import Edges, Lines, MeshArrays

# property that holds the values of an attribute, by its type; "value" for all others
FIELDS = {"FLOAT_VECTOR": "vector", "FLOAT2": "vector", "FLOAT_COLOR": "color", "BYTE_COLOR": "color"}


def write_mesh(mesh: bpy.types.Mesh, arrays: MeshArrays) -> None:
    """Fill `mesh` anew. Its geometry and materials are replaced."""
    mesh.clear_geometry()
    mesh.vertices.add(len(arrays.positions))
    mesh.attributes["position"].data.foreach_set("vector", arrays.positions.reshape(-1))
    if len(arrays.triangles):
        _write_faces(mesh, arrays.triangles, arrays.edges or Edges.of(arrays.triangles))
    mesh.materials.clear()
    for material in arrays.materials:
        mesh.materials.append(material)
    for attribute in arrays.attributes:
        written = mesh.attributes.new(attribute.name, attribute.kind, attribute.domain)
        written.data.foreach_set(FIELDS.get(attribute.kind, "value"), attribute.values.reshape(-1))
    if len(mesh.uv_layers):
        mesh.uv_layers[0].active = mesh.uv_layers[0].active_render = True
    if len(mesh.color_attributes):
        mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0
    if arrays.lines is not None:
        _write_lines(mesh, arrays.lines)
    mesh.update()


def _write_faces(mesh: bpy.types.Mesh, triangles: np.ndarray, edges: Edges) -> None:
    mesh.edges.add(len(edges.ends))
    mesh.loops.add(triangles.size)
    mesh.polygons.add(len(triangles))
    # by these names whole arrays are copied: the elements' own properties take a hundred times as long
    for name, values in ((".edge_verts", edges.ends), (".corner_vert", triangles), (".corner_edge", edges.of_side)):
        mesh.attributes[name].data.foreach_set("value", values.reshape(-1))
    mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))


def _write_lines(mesh: bpy.types.Mesh, lines: Lines) -> None:
    if lines.sharp_edges.any():
        sharp = mesh.attributes.get("sharp_edge") or mesh.attributes.new("sharp_edge", "BOOLEAN", "EDGE")
        sharp.data.foreach_set("value", lines.sharp_edges)
    if lines.marked_edges.any():
        compat.mark_for_freestyle(mesh, "EDGE", lines.marked_edges)
    if lines.marked_faces.any():
        compat.mark_for_freestyle(mesh, "FACE", lines.marked_faces)
