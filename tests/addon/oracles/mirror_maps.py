"""Maps written for mirrors, read back as arrays."""
from __future__ import annotations

import struct
import zlib

import bpy
import numpy as np

UV_MAP, SEEN = "Mirror UV", "mirror_seen"


def write(**options) -> bpy.types.Object:
    """Write the maps and return the last object that carries one."""
    assert bpy.ops.reflection_mesh.mirror_uvs("EXEC_DEFAULT", **options) == {"FINISHED"}
    return [obj for obj in bpy.context.selected_objects if obj.type == "MESH" and UV_MAP in obj.data.uv_layers][-1]


def uv_of(obj: bpy.types.Object, name: str = UV_MAP) -> np.ndarray:
    """(loops, 2)."""
    values = np.empty((len(obj.data.loops), 2), dtype=np.float32)
    obj.data.uv_layers[name].uv.foreach_get("vector", values.reshape(-1))
    return values.astype(np.float64)


def seen_of(obj: bpy.types.Object) -> np.ndarray:
    values = np.empty(len(obj.data.polygons), dtype=bool)
    obj.data.attributes[SEEN].data.foreach_get("value", values)
    return values


def corner_places(obj: bpy.types.Object) -> np.ndarray:
    """World positions (loops, 3)."""
    vertex = np.empty(len(obj.data.loops), dtype=np.int32)
    obj.data.loops.foreach_get("vertex_index", vertex)
    places = np.empty((len(obj.data.vertices), 3), dtype=np.float32)
    obj.data.vertices.foreach_get("co", places.reshape(-1))
    matrix = np.array(obj.matrix_world)
    return places[vertex] @ matrix[:3, :3].T + matrix[:3, 3]


def doubled(corners: np.ndarray) -> np.ndarray:
    """Twice the areas (n,) of triangles (n, 3, 2)."""
    u, v = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    return u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]


def decoded(data: bytes) -> tuple[np.ndarray, tuple]:
    """Pixels (h, w, 3) and pHYs of a PNG of 8-bit colour without filters."""
    chunks, at = {}, 8
    while at < len(data):
        size, = struct.unpack(">I", data[at:at + 4])
        chunks[data[at + 4:at + 8]] = data[at + 8:at + 8 + size]
        at += 12 + size
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    rows = np.frombuffer(zlib.decompress(chunks[b"IDAT"]), np.uint8).reshape(height, -1)
    return rows[:, 1:].reshape(height, width, 3), struct.unpack(">IIB", chunks[b"pHYs"])
