"""What part of light goes straight through materials: what is open in part, as leaves, curtains and films are."""
from __future__ import annotations

import bpy

from ... import compat
from .material_nodes import shown_output
from .opaque_materials import is_clear, is_fog

GREY = 1e-3  # by how much red, green and blue of what goes through may differ


def transparency(material: bpy.types.Material | None) -> float | None:
    """The part of light that goes straight through `material`, 1 for clear glass; None where its nodes tell another
    one here and there, or for each colour."""
    if material is None or not compat.uses_nodes(material):
        return 0.0
    if is_fog(material) or is_clear(material):
        return 1.0
    output = shown_output(material.node_tree)
    return 0.0 if output is None else _through(output.inputs["Surface"])


def _through(socket: bpy.types.NodeSocket) -> float | None:
    """The part that goes through what is plugged into a socket for shaders."""
    if not socket.is_linked:
        return 0.0
    link = socket.links[0]
    node = link.from_node
    if node.mute or link.is_muted:
        return None
    if node.type == "REROUTE":
        return _through(node.inputs[0])
    if node.type == "GROUP" and node.node_tree is not None:
        return _through_group(node, link.from_socket)
    if node.type == "BSDF_PRINCIPLED":
        alpha = _number(node.inputs["Alpha"])
        return None if alpha is None else 1.0 - min(max(alpha, 0.0), 1.0)
    if node.type == "BSDF_TRANSPARENT":
        colour = node.inputs["Color"]
        red_green_blue = colour.default_value[:3]
        if colour.is_linked or max(red_green_blue) - min(red_green_blue) > GREY:
            return None
        return min(sum(red_green_blue) / 3.0, 1.0)
    if node.type in {"MIX_SHADER", "ADD_SHADER"}:
        return _through_both(node)
    return 0.0


def _through_both(node: bpy.types.Node) -> float | None:
    first, second = (_through(socket) for socket in node.inputs if socket.type == "SHADER")
    if node.type == "ADD_SHADER":
        return None if first is None or second is None else min(first + second, 1.0)
    factor = _number(node.inputs[0])
    if factor is not None:
        factor = min(max(factor, 0.0), 1.0)
        first, second = (0.0 if part == 0.0 else value for part, value in ((1.0 - factor, first), (factor, second)))
    if first is None or second is None:
        return None
    if factor is None:
        return first if first == second else None
    return (1.0 - factor) * first + factor * second


def _through_group(node: bpy.types.Node, source: bpy.types.NodeSocket) -> float | None:
    output = next((one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output), None)
    inside = None if output is None else next(
        (one for one in output.inputs if one.identifier == source.identifier), None)
    return 0.0 if inside is None else _through(inside)


def _number(socket: bpy.types.NodeSocket) -> float | None:
    """The number that a socket is given, where it is the same everywhere."""
    if not socket.is_linked:
        return float(socket.default_value)
    link = socket.links[0]
    if link.from_node.type != "VALUE" or link.from_node.mute or link.is_muted:
        return None
    return float(link.from_socket.default_value)
