"""Turn faces that the user joined to a result (Object > Join) into an object again, so that they are not overwritten.
"""
from __future__ import annotations

import bpy
import bmesh
import numpy as np

from ..faults import AllOrNothing, remove_new
from .arrays import OF_METHOD
from .beside import link_beside
from .nodes import disc_nodes


def set_free(context: bpy.types.Context, result: bpy.types.Object, whole: AllOrNothing) -> bpy.types.Object | None:
    """Make a separate object of the parts that were joined to a result, at the same place. Return None if there are
    none.

    Blender appends joined parts after the result's own faces, without shared vertices. Changes of the user in Edit Mode
    stay with them. The result itself is not changed.
    """
    own = _own_vertices(result) if result.type == "MESH" else 0
    if not own:
        return None
    mesh = result.data.copy()
    whole.undo(remove_new, mesh)
    mesh.name = name = f"{result.name} Joined"
    _without(mesh, own)
    _keep_used_materials(mesh, [slot.material for slot in result.material_slots])
    # by name, one after another: removing an attribute moves the others
    for attribute in OF_METHOD.intersection(mesh.attributes.keys()):
        mesh.attributes.remove(mesh.attributes[attribute])
    obj = bpy.data.objects.new(name, mesh)
    whole.undo(remove_new, obj)
    link_beside(context.scene, obj, result)
    obj.matrix_world = result.matrix_world
    return obj


def told_of(result: bpy.types.Object, freed: bpy.types.Object | None) -> list[str]:
    """Return a sentence on the object that `set_free` has made, if any."""
    return [] if freed is None else [
        f"What was joined to '{result.name}' is an object of its own again: '{freed.name}'."]


def _own_vertices(result: bpy.types.Object) -> int:
    """Return the number of vertices of the result's own, which come first. Return 0 if all vertices are its own, or if
    other faces or edges use some of them.
    """
    record, mesh = result.reflection_mesh, result.data
    if record.points:
        # a result without its disc nodes was converted to another mesh (Object > Convert)
        joined = len(mesh.vertices) > record.points and disc_nodes(result) is not None
        return record.points if joined else 0
    if not 0 < record.faces <= len(mesh.polygons):
        return 0
    corners = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    more_faces = record.faces < len(mesh.polygons)
    first = mesh.polygons[record.faces].loop_start if more_faces else len(corners)
    # a result has no vertex that none of its faces has: wire and loose points behind them were joined, too
    own = int(corners[:first].max()) + 1
    ends = np.empty(2 * len(mesh.edges), dtype=np.int32)
    mesh.edges.foreach_get("vertices", ends)
    is_own = ends.reshape(-1, 2) < own
    apart = bool((corners[first:] >= own).all() and (is_own[:, 0] == is_own[:, 1]).all())
    return own if apart and own < len(mesh.vertices) else 0


def _keep_used_materials(mesh: bpy.types.Mesh, shown: list) -> None:
    """Reduce the materials of a mesh to those of `shown` that its faces use."""
    used = np.zeros(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("material_index", used)
    numbers, places = np.unique(used.clip(0, max(len(shown) - 1, 0)), return_inverse=True)
    mesh.materials.clear()
    for number in numbers if shown else ():
        mesh.materials.append(shown[number])
    mesh.polygons.foreach_set("material_index", places.reshape(-1).astype(np.int32))


def _without(mesh: bpy.types.Mesh, vertices: int) -> None:
    """Delete the first `vertices` vertices of a mesh, and all edges and faces that use them."""
    edited = bmesh.new()
    try:
        edited.from_mesh(mesh)
        edited.verts.ensure_lookup_table()
        bmesh.ops.delete(edited, geom=edited.verts[:vertices], context="VERTS")
        edited.to_mesh(mesh)
    finally:
        edited.free()
