"""Mesh attributes packed into colours. Only colours come back exactly from sequences in every Blender version. Other
attributes do not, and names with spaces in no version.

Each attribute has its own colours, one for three numbers. Their names depend on the attribute's name only, so that
frames with different attributes can form a sequence.
"""
from __future__ import annotations

import zlib

import bpy
import numpy as np

# number of components and name of the value property, by attribute type
WIDTHS = {"FLOAT": (1, "value"), "INT": (1, "value"), "BOOLEAN": (1, "value"), "INT8": (1, "value"),
          "FLOAT2": (2, "vector"), "FLOAT_VECTOR": (3, "vector"), "FLOAT_COLOR": (4, "color"),
          "BYTE_COLOR": (4, "color")}
READ_AS = {"INT": np.int32, "INT8": np.int8, "BOOLEAN": np.bool_}
# attributes of the mesh itself
LEFT_OUT = {"position", "material_index"}
MATERIAL = "corner_material"


def packable(mesh: bpy.types.Mesh) -> list[tuple[str, str, str]]:
    """Return the attributes (name, kind, domain) of a mesh that are packed."""
    return [(entry.name, entry.data_type, entry.domain) for entry in mesh.attributes
            if entry.data_type in WIDTHS and entry.domain in {"POINT", "EDGE", "FACE", "CORNER"}
            and not entry.name.startswith(".") and entry.name not in LEFT_OUT]


def colour_names(name: str, kind: str, domain: str) -> list[str]:
    """Return the names of the colours that hold an attribute. Attributes of faces and edges are stored at corners."""
    place = "point" if domain == "POINT" else "corner"
    key = zlib.crc32(f"{domain} {kind} {name}".encode())
    return [f"{place}_{key:08x}_{number}" for number in range((WIDTHS[kind][0] + 2) // 3)]


def packed(mesh: bpy.types.Mesh, attributes: list, material: np.ndarray) -> dict[str, tuple[str, np.ndarray]]:
    """Return the colours of a mesh as (domain, values (n, 4) float32), by name.

    Parameters
    ----------
    material : (faces, 3) int
        A number for the material of each face, in parts.
    """
    sizes = np.empty(len(mesh.polygons), dtype=np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    made = {MATERIAL: ("CORNER", _colour(np.repeat(material, sizes, axis=0)))}
    for name, kind, domain in attributes:
        values = _values(mesh.attributes[name], kind)
        if domain == "FACE":
            values = np.repeat(values, sizes, axis=0)
        elif domain == "EDGE":
            # value of the edge from each corner to the next one
            edges = np.empty(len(mesh.loops), dtype=np.int32)
            mesh.loops.foreach_get("edge_index", edges)
            values = values[edges]
        for number, colour in enumerate(colour_names(name, kind, domain)):
            made[colour] = ("POINT" if domain == "POINT" else "CORNER", _colour(values[:, 3 * number:3 * number + 3]))
    return made


def _colour(values: np.ndarray) -> np.ndarray:
    colour = np.zeros((len(values), 4), dtype=np.float32)
    colour[:, :values.shape[1]] = values
    colour[:, 3] = 1.0
    return colour


def _values(attribute: bpy.types.Attribute, kind: str) -> np.ndarray:
    width, field = WIDTHS[kind]
    values = np.empty(len(attribute.data) * width, dtype=READ_AS.get(kind, np.float32))
    attribute.data.foreach_get(field, values)
    return values.reshape(-1, width)
