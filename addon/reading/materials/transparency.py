"""Compute the share of light that passes straight through partly transparent materials such as leaves and curtains."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import shown_output
from .opaque_materials import is_clear, is_fog
from .shader_graph import MIXING, Groups, fed_by, outermost

GREY = 1e-3  # largest difference between red, green and blue of a transparent colour that counts as grey


def transparency(material: bpy.types.Material | None) -> float | None:
    """Return the share of light that passes straight through `material`, 1 for clear glass. Return None if the share
    varies over the surface or differs between the colour channels.
    """
    if material is None or not compat.uses_nodes(material):
        return 0.0
    if is_fog(material) or is_clear(material):
        return 1.0
    output = shown_output(material.node_tree)
    return 0.0 if output is None else _through(output.inputs["Surface"])


def _through(socket: bpy.types.NodeSocket, groups: Groups = ()) -> float | None:
    """Return the share that passes through the shader linked to a shader socket, None if it varies."""
    source, groups = fed_by(socket, groups)
    if source is None:
        return 0.0
    node = source.node
    if node.type == "BSDF_PRINCIPLED":
        alpha = _number(node.inputs["Alpha"], groups)
        return None if alpha is None else 1.0 - min(max(alpha, 0.0), 1.0)
    if node.type == "BSDF_TRANSPARENT":
        colour, _ = outermost(node.inputs["Color"], groups)
        red_green_blue = colour.default_value[:3]
        if colour.is_linked or max(red_green_blue) - min(red_green_blue) > GREY:
            return None
        return min(sum(red_green_blue) / 3.0, 1.0)
    if node.type in MIXING:
        return _through_both(node, groups)
    return 0.0


def _through_both(node: bpy.types.Node, groups: Groups) -> float | None:
    first, second = (_through(socket, groups) for socket in node.inputs if socket.type == "SHADER")
    if node.type == "ADD_SHADER":
        return None if first is None or second is None else min(first + second, 1.0)
    factor = _number(node.inputs[0], groups)
    if factor is not None:
        factor = min(max(factor, 0.0), 1.0)
        first, second = (0.0 if part == 0.0 else value for part, value in ((1.0 - factor, first), (factor, second)))
    if first is None or second is None:
        return None
    if factor is None:
        return first if first == second else None
    return (1.0 - factor) * first + factor * second


def _number(socket: bpy.types.NodeSocket, groups: Groups) -> float | None:
    """Return the constant value of a socket, None if the value varies."""
    source, _ = fed_by(socket, groups)
    if source is None:
        return float(outermost(socket, groups)[0].default_value)
    return float(source.default_value) if source.node.type == "VALUE" else None
