"""The shaders that a surface is mixed of."""
from __future__ import annotations

import bpy

from .material_nodes import shown_output

MIXING = {"MIX_SHADER", "ADD_SHADER", "REROUTE"}


def surface_shaders(tree: bpy.types.NodeTree) -> list:
    """The nodes behind the active output's Surface socket that are neither mixes nor groups, but what is in these."""
    output = shown_output(tree)
    return [] if output is None else list(dict.fromkeys(_behind(output.inputs["Surface"])))


def _behind(socket: bpy.types.NodeSocket) -> list:
    if not socket.is_linked:
        return []
    source = socket.links[0].from_socket
    node = source.node
    if node.type in MIXING:
        return [shader for one in node.inputs if one.type == "SHADER" for shader in _behind(one)]
    if node.type != "GROUP" or node.node_tree is None:
        return [node]
    output = next((one for one in node.node_tree.nodes if one.type == "GROUP_OUTPUT" and one.is_active_output), None)
    inside = [] if output is None else [one for one in output.inputs if one.identifier == source.identifier]
    return [shader for one in inside for shader in _behind(one)]
