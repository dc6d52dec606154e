"""Read the UV maps, the colours and other attributes that materials use, as arrays at face corners."""
from __future__ import annotations

from typing import NamedTuple

import bpy
import numpy as np

from ..materials import asked_attributes

# attributes with a meaning for Blender, and a fixed type
BLENDERS_OWN = {"position", "material_index", "sharp_face", "sharp_edge", "custom_normal", "freestyle_edge",
                "freestyle_face", "crease_edge", "crease_vert", "bevel_weight_edge", "bevel_weight_vert"}
# name of the value property, number of components and dtype, by attribute type
FIELDS = {"FLOAT": ("value", 1, np.float32), "INT": ("value", 1, np.int32), "INT8": ("value", 1, np.int8),
          "BOOLEAN": ("value", 1, bool), "FLOAT2": ("vector", 2, np.float32), "FLOAT_VECTOR": ("vector", 3, np.float32),
          "FLOAT_COLOR": ("color", 4, np.float32), "BYTE_COLOR": ("color", 4, np.float32)}
DOMAINS = {"POINT", "CORNER", "FACE"}  # engines do not show edge attributes
# types to store: engines interpolate integers and booleans as floats
CARRIED = {"INT": "FLOAT", "INT8": "FLOAT", "BOOLEAN": "FLOAT"}


class Layers(NamedTuple):
    """Values on face corners, by name.

    Attributes
    ----------
    uv_maps : dict of str to (corners, 2) float32
    colours : dict of str to (type, (corners, 4) float32)
        In linear colour; type is FLOAT_COLOR or BYTE_COLOR.
    numbers : dict of str to (type, (corners, c) float32)
        Other attributes; type is FLOAT or FLOAT_VECTOR.
    active_uv, active_colour : str
        What a material without a name of its own shows; empty where there is none.
    """

    uv_maps: dict
    colours: dict
    numbers: dict
    active_uv: str
    active_colour: str


NO_LAYERS = Layers({}, {}, {}, "", "")


def read_layers(mesh: bpy.types.Mesh, materials: tuple) -> Layers:
    """Return all UV maps and colours of a mesh, and the other attributes that `materials` read."""
    vertex = np.empty(len(mesh.loops), dtype=np.int32)
    mesh.attributes[".corner_vert"].data.foreach_get("value", vertex)
    uv_maps = {layer.name: _of_corners(mesh.attributes[layer.name], mesh, vertex) for layer in mesh.uv_layers}
    colours = {attribute.name: (attribute.data_type, _of_corners(attribute, mesh, vertex))
               for attribute in mesh.color_attributes if attribute.domain in {"POINT", "CORNER"}}
    layers = Layers(uv_maps, colours, {}, *_active_names(mesh))
    for name in sorted(asked_attributes(materials) - BLENDERS_OWN - uv_maps.keys() - colours.keys()):
        attribute = mesh.attributes.get(name)
        if attribute is None or attribute.data_type not in FIELDS or attribute.domain not in DOMAINS:
            continue
        kind = CARRIED.get(attribute.data_type, attribute.data_type)
        values = _of_corners(attribute, mesh, vertex)
        if kind == "FLOAT2":
            uv_maps[name] = values
        else:
            (colours if "COLOR" in kind else layers.numbers)[name] = (kind, values)
    return layers


def _of_corners(attribute: bpy.types.Attribute, mesh: bpy.types.Mesh, vertex: np.ndarray) -> np.ndarray:
    """Return the values (corners, c) float32 of an attribute of any domain. Values that are not finite become zero,
    since they would spoil interpolated values.
    """
    name, width, kind = FIELDS[attribute.data_type]
    values = np.empty((len(attribute.data), width), dtype=kind)
    attribute.data.foreach_get(name, values.reshape(-1))
    values = values.astype(np.float32, copy=False)
    values[~np.isfinite(values)] = 0.0
    if attribute.domain == "POINT":
        return values[vertex]
    if attribute.domain == "FACE":
        sides = np.empty(len(mesh.polygons), dtype=np.int32)
        mesh.polygons.foreach_get("loop_total", sides)
        return np.repeat(values, sides, axis=0)
    return values


def _active_names(mesh: bpy.types.Mesh) -> tuple[str, str]:
    uv = next((layer.name for layer in mesh.uv_layers if layer.active_render), "")
    index = mesh.color_attributes.render_color_index
    return uv, mesh.color_attributes[index].name if 0 <= index < len(mesh.color_attributes) else ""
