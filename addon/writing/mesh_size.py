"""How large a mesh is in a file."""
from __future__ import annotations

import bpy

from .. import compat

# bytes of one value
WIDTHS = {"FLOAT": 4, "INT": 4, "FLOAT_VECTOR": 12, "FLOAT_COLOR": 16, "BYTE_COLOR": 4, "BOOLEAN": 1, "FLOAT2": 8,
          "INT8": 1, "INT16_2D": 4, "INT32_2D": 8, "QUATERNION": 16, "FLOAT4X4": 64}


def mesh_bytes(mesh: bpy.types.Mesh) -> int:
    """Bytes of all values of a mesh's attributes, and of where its faces begin; cheap enough for every redraw."""
    attributes = sum(compat.values_stored(entry) * WIDTHS.get(entry.data_type, 0) for entry in mesh.attributes)
    return attributes + 4 * (len(mesh.polygons) + 1)
