"""Compute the memory that a result takes. Its file grows by about as much."""
from __future__ import annotations

import bpy

from ... import compat

# bytes of one value of an attribute, by its type
BYTES = {"FLOAT": 4, "INT": 4, "INT8": 1, "BOOLEAN": 1, "FLOAT2": 8, "FLOAT_VECTOR": 12, "FLOAT_COLOR": 16,
         "BYTE_COLOR": 4, "QUATERNION": 16, "INT32_2D": 8, "INT16_2D": 4}


def mesh_bytes(mesh: bpy.types.Mesh) -> int:
    """Return the uncompressed size in bytes of a mesh's attributes, including its geometry."""
    starts = 4 * (len(mesh.polygons) + 1)
    return starts + sum(BYTES.get(entry.data_type, 0) * compat.values_stored(entry) for entry in mesh.attributes)


def size_text(size: int) -> str:
    """Format a size in bytes for reading, e.g. "12 MB"."""
    power = sum(size >= 1000 ** step for step in (1, 2, 3))
    value = size / 1000 ** power
    return f"{value:.{1 if power and value < 10 else 0}f} {('bytes', 'KB', 'MB', 'GB')[power]}"
