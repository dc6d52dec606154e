"""Arrays -> loose points in a Blender mesh, with their discs, where they came from, UVs, colours and materials."""
from __future__ import annotations

import bpy
import numpy as np

from ...core import ReflectionMesh, View
from .join_meshes import DiffuseScene
from .write_mesh import MOST_UV_MAPS, first


def point_arrays(result: ReflectionMesh, scene: DiffuseScene, triangle: np.ndarray, origin: np.ndarray,
                 view: View) -> dict:
    """Everything that `write_points` writes, in Blender's own types; parameters as for `mesh_arrays`."""
    discs = result.discs
    corner = _corner_of_vertex(scene)[discs.source_vertex]
    source, at = corner // 3, corner % 3
    rotation, scale = _placed_discs(discs.axes, view.directions(result.positions))
    return {
        "positions": (result.positions - origin).astype(np.float32),
        "attributes": (
            ("reflected_position", "FLOAT_VECTOR", "vector", result.reflected_position.astype(np.float32)),
            ("mirror_position", "FLOAT_VECTOR", "vector", result.mirror_position.astype(np.float32)),
            ("path_length", "FLOAT", "value", result.path_length.astype(np.float32)),
            ("image_parity", "INT", "value", result.image_parity.astype(np.int32)),
            ("radius", "FLOAT", "value", discs.radius.astype(np.float32)),
            ("disc_rotation", "QUATERNION", "value", rotation.astype(np.float32)),
            ("disc_scale", "FLOAT_VECTOR", "vector", scale.astype(np.float32)),
            ("source_object", "INT", "value", scene.source_object[source].astype(np.int32)),
            ("source_face", "INT", "value", scene.source_face[source].astype(np.int32)),
            ("mirror_face", "INT", "value", triangle[discs.mirror_face].astype(np.int32)),
            ("source_material", "INT", "value", scene.material[source].astype(np.int32)),
        ),
        "uv_maps": {name: values[source, at] for name, values in scene.uv_maps.items()},
        "colours": {name: (kind, values[source, at]) for name, (kind, values) in scene.colours.items()},
        "materials": scene.materials,
        "active_uv": scene.active_uv,
        "active_colour": scene.active_colour,
    }


def write_points(mesh: bpy.types.Mesh, arrays: dict) -> list:
    """Fill `mesh` anew from `point_arrays`; returns the names of its UV maps, which discs have at their corners."""
    mesh.clear_geometry()
    mesh.vertices.add(len(arrays["positions"]))
    mesh.attributes["position"].data.foreach_set("vector", arrays["positions"].reshape(-1))
    mesh.materials.clear()
    for material in arrays["materials"]:
        mesh.materials.append(material)
    taken = set()
    for name, kind, field, values in arrays["attributes"]:
        taken.add(name)
        mesh.attributes.new(name, kind, "POINT").data.foreach_set(field, values.reshape(-1))
    uv_maps = [(name, values) for name, values in first(arrays["uv_maps"], arrays["active_uv"])
               if name not in taken][:MOST_UV_MAPS]
    for name, values in uv_maps:
        taken.add(name)
        mesh.attributes.new(name, "FLOAT2", "POINT").data.foreach_set("vector", values.reshape(-1))
    for name, (kind, values) in first(arrays["colours"], arrays["active_colour"]):
        if name not in taken:
            mesh.color_attributes.new(name, kind, "POINT").data.foreach_set("color", values.reshape(-1))
    if len(mesh.color_attributes):
        mesh.color_attributes.active_color_index = mesh.color_attributes.render_color_index = 0
    mesh.update()
    return [name for name, _ in uv_maps]


def _corner_of_vertex(scene: DiffuseScene) -> np.ndarray:
    """A corner of the scene's triangles, 3 triangle + corner, for each vertex: the first one."""
    triangles = scene.mesh.triangles
    table = np.zeros(len(scene.mesh.positions), dtype=np.int64)
    # of several assignments to one vertex the last stays
    table[triangles.ravel()[::-1]] = np.arange(triangles.size)[::-1]
    return table


def _placed_discs(axes: np.ndarray, directions: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Quaternions (n, 4) that turn X and Y to the half axes (n, 2, 3) and Z to the eye, and the half axes' lengths."""
    length = np.linalg.norm(axes, axis=2)
    x, y = np.moveaxis(axes / np.maximum(length, 1e-300)[:, :, None], 1, 0)
    y = np.where((np.cross(x, y) * directions).sum(axis=1, keepdims=True) > 0.0, -y, y)
    m = np.stack((x, y, np.cross(x, y)), axis=2)
    # 4 q q' by the entries of the rotation: the row with the largest diagonal keeps its digits
    a, b, c = m[:, 0, 0], m[:, 1, 1], m[:, 2, 2]
    yz, zx, xy = m[:, 2, 1] - m[:, 1, 2], m[:, 0, 2] - m[:, 2, 0], m[:, 1, 0] - m[:, 0, 1]
    ab, bc, ca = m[:, 1, 0] + m[:, 0, 1], m[:, 2, 1] + m[:, 1, 2], m[:, 0, 2] + m[:, 2, 0]
    products = np.array([[1.0 + a + b + c, yz, zx, xy], [yz, 1.0 + a - b - c, ab, ca],
                         [zx, ab, 1.0 - a + b - c, bc], [xy, ca, bc, 1.0 - a - b + c]])
    best = np.argmax(np.einsum("iin->in", products), axis=0)
    quaternion = products[best, :, np.arange(len(best))]
    return (quaternion / np.linalg.norm(quaternion, axis=1, keepdims=True),
            np.column_stack((length, np.ones(len(length)))))
