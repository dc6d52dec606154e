"""The navigator of shader graphs: from a socket to what feeds it, past reroutes, muted nodes and the borders of groups.

A place in a graph is a socket or a node with the group nodes that it is in, from outside.
"""
from __future__ import annotations

from collections.abc import Iterator

import bpy

from .material_nodes import shown_output

MIXING = {"MIX_SHADER", "ADD_SHADER"}
Groups = tuple[bpy.types.Node, ...]


def outermost(socket: bpy.types.NodeSocket, groups: Groups = ()) -> tuple[bpy.types.NodeSocket, Groups]:
    """Return the input socket that decides what an input socket gets, and the groups that it is in.

    Reroutes and muted nodes hand on one of their own inputs, and the input of a group that of the group's node.
    """
    while (link := _link(socket)) is not None:
        source, node = link.from_socket, link.from_node
        if node.type == "GROUP_INPUT" and groups:
            inner, (*outer, node) = socket, groups
            socket = next((one for one in node.inputs if one.identifier == source.identifier), inner)
            if socket is inner:
                break
            groups = tuple(outer)
        elif node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute and (passed := _passed_on(node, source)) is not None:
            socket = passed
        else:
            break
    return socket, groups


def fed_by(socket: bpy.types.NodeSocket, groups: Groups = ()) -> tuple[bpy.types.NodeSocket | None, Groups]:
    """Return the output socket that feeds an input socket, in groups too, and the groups that it is in; None where
    nothing does."""
    while True:
        socket, groups = outermost(socket, groups)
        link = _link(socket)
        if link is None or link.from_node.mute:
            return None, groups
        node = link.from_node
        if node.type != "GROUP" or node.node_tree is None:
            return link.from_socket, groups
        inside = _end_of(node.node_tree, link.from_socket.identifier)
        if inside is None:
            return None, groups
        socket, groups = inside, (*groups, node)


def shaders_behind(socket: bpy.types.NodeSocket, groups: Groups = ()) -> Iterator[tuple[bpy.types.Node, Groups]]:
    """Yield the shaders that are mixed, added or grouped to what a socket gets, with the groups that each is in."""
    source, groups = fed_by(socket, groups)
    if source is None:
        return
    if source.node.type not in MIXING:
        yield source.node, groups
        return
    for one in source.node.inputs:
        if one.type == "SHADER":
            yield from shaders_behind(one, groups)


def shaders_of(tree: bpy.types.NodeTree) -> list[tuple[bpy.types.Node, Groups]]:
    """Return the shaders that a surface is made of, each once, with the groups that it is in."""
    output = shown_output(tree)
    return [] if output is None else list(dict.fromkeys(shaders_behind(output.inputs["Surface"])))


def surface_shaders(tree: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """Return the nodes of `shaders_of`."""
    return list(dict.fromkeys(shader for shader, _ in shaders_of(tree)))


def surface_shader(tree: bpy.types.NodeTree) -> bpy.types.Node | None:
    """Return the node of the tree itself that feeds the surface, be it a mix or a group."""
    output = shown_output(tree)
    link = None if output is None else _link(outermost(output.inputs["Surface"])[0])
    return None if link is None else link.from_node


def _link(socket: bpy.types.NodeSocket) -> bpy.types.NodeLink | None:
    # Blender looks for the links of a socket among all of the tree
    return next((link for link in socket.links if not link.is_muted), None) if socket.is_linked else None


def _passed_on(node: bpy.types.Node, output: bpy.types.NodeSocket) -> bpy.types.NodeSocket | None:
    """Return the input that a muted node hands on to one of its outputs."""
    return next((link.from_socket for link in node.internal_links if link.to_socket == output), None)


def _end_of(tree: bpy.types.NodeTree, identifier: str) -> bpy.types.NodeSocket | None:
    """Return the socket of a group's active output that has an identifier."""
    ends = [node for node in tree.nodes if node.type == "GROUP_OUTPUT" and node.is_active_output]
    return next((one for end in ends for one in end.inputs if one.identifier == identifier), None)
