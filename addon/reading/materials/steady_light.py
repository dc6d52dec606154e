"""Estimate the change of viewing direction up to which a material looks the same."""
from __future__ import annotations

import math

import bpy

from ... import compat
from .material_nodes import all_nodes
from .opaque_materials import fog_of, is_opaque
from .shader_graph import surface_shaders

MATTE = {"BSDF_DIFFUSE", "EMISSION"}
BY_VIEW = {"CAMERA", "FRESNEL", "LAYER_WEIGHT", "LIGHT_PATH"}
SOCKETS_BY_VIEW = {"TEX_COORD": {"Camera", "Window", "Reflection"}, "NEW_GEOMETRY": {"Incoming"}}
ABSENT = ("Metallic", "Coat Weight", "Sheen Weight", "Thin Film Thickness")
SHARE = 0.4     # of the width of a highlight, in radians, by which it may lie elsewhere


def steady_angle(material: bpy.types.Material | None) -> float:
    """Return the angle in radians by which a material may be seen from elsewhere without a change that counts: 0 for
    what mirrors, is transparent, or has nodes that know the view."""
    if material is None or not compat.uses_nodes(material):
        return math.pi
    if not is_opaque(material) or fog_of(material) is not None or any(map(_knows_view, all_nodes(material.node_tree))):
        return 0.0
    return min(map(_steady_angle, surface_shaders(material.node_tree)), default=math.pi)


def _steady_angle(shader: bpy.types.Node) -> float:
    if shader.type in MATTE:
        return math.pi
    if shader.type != "BSDF_PRINCIPLED" or not all(_is_zero(shader, name) for name in ABSENT):
        return 0.0
    if _is_zero(shader, "Specular IOR Level"):
        return math.pi
    roughness = shader.inputs["Roughness"]
    # the slopes of microfacets spread by the square of the roughness
    return 0.0 if roughness.is_linked else SHARE * roughness.default_value**2


def _is_zero(shader: bpy.types.Node, name: str) -> bool:
    socket = shader.inputs.get(name)
    return socket is None or not socket.is_linked and socket.default_value == 0.0


def _knows_view(node: bpy.types.Node) -> bool:
    known = SOCKETS_BY_VIEW.get(node.type, ())
    return node.type in BY_VIEW or any(output.is_linked and output.name in known for output in node.outputs)
