"""Find emissive materials whose colour depends only on UV maps and attributes, which a reflection's mesh also has."""
from __future__ import annotations

from collections.abc import Iterator

import bpy

from .material_nodes import all_nodes, feeding
from .mirror_materials import emits
from .shader_graph import surface_shader

BY_VALUES = {"BLACKBODY", "BRIGHTCONTRAST", "CLAMP", "COMBINE_COLOR", "COMBRGB", "COMBXYZ", "CURVE_FLOAT",
             "CURVE_RGB", "CURVE_VEC", "FRAME", "GAMMA", "GROUP", "GROUP_INPUT", "GROUP_OUTPUT", "HUE_SAT", "INVERT",
             "MAPPING", "MAP_RANGE", "MATH", "MIX", "MIX_RGB", "REROUTE", "RGB", "RGBTOBW", "SEPARATE_COLOR", "SEPRGB",
             "SEPXYZ", "VALTORGB", "VALUE", "VECTOR_ROTATE", "VECT_MATH", "VERTEX_COLOR", "WAVELENGTH"}
"""Nodes that tell a colour by what is plugged in, and by colours of the mesh."""
BY_VECTOR = {"TEX_BRICK", "TEX_CHECKER", "TEX_GABOR", "TEX_GRADIENT", "TEX_MAGIC", "TEX_NOISE", "TEX_VORONOI",
             "TEX_WAVE"}
"""Textures that lie by the object itself where nothing is plugged in."""
EVERYWHERE = {"GEOMETRY", "VIEW_LAYER"}


def emits_alike(material: bpy.types.Material | None) -> bool:
    """Return True for an emissive material whose colour depends only on UV maps and attributes of the mesh. A
    reflection carries these. It does not carry anything that depends on the object, the ray or the side of the face.
    """
    return emits(material) and all(map(_is_carried, _behind(surface_shader(material.node_tree))))


def _is_carried(node: bpy.types.Node) -> bool:
    if node.type == "TEX_IMAGE":
        return node.projection == "FLAT"
    if node.type in BY_VECTOR:
        return node.inputs["Vector"].is_linked
    if node.type == "TEX_COORD":
        return not node.from_instancer and all(one.name == "UV" for one in node.outputs if one.is_linked)
    if node.type == "UVMAP":
        return not node.from_instancer
    return node.type in BY_VALUES or node.type == "ATTRIBUTE" and node.attribute_type in EVERYWHERE


def _behind(node: bpy.types.Node) -> Iterator[bpy.types.Node]:
    """Yield the nodes that feed a node, including those inside groups."""
    for source in feeding(node):
        yield source
        yield from all_nodes(source.node_tree) if source.type == "GROUP" else ()
