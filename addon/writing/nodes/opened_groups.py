"""Groups of nodes that make shaders, put in place of their group nodes."""
from __future__ import annotations

import bpy

from .copied_nodes import copied

BORDERS = {"GROUP_INPUT", "GROUP_OUTPUT", "FRAME"}


def groups_of_shaders(tree: bpy.types.NodeTree) -> list[bpy.types.Node]:
    """Return the group nodes of a tree that make shaders."""
    return [node for node in tree.nodes if node.type == "GROUP" and node.node_tree is not None and not node.mute
            and any(output.type == "SHADER" and output.is_linked for output in node.outputs)]


def open_groups(tree: bpy.types.NodeTree) -> None:
    """Replace groups that make shaders by their contents, in a tree that must be our own."""
    while groups := groups_of_shaders(tree):
        for group in groups:
            _open(tree, group)


def _open(tree: bpy.types.NodeTree, group: bpy.types.Node) -> None:
    inner = group.node_tree
    made = copied([node for node in inner.nodes if node.type not in BORDERS], tree)
    given = {socket.identifier: socket for socket in group.inputs}
    # inputs of the group
    for node in inner.nodes:
        if node.type == "GROUP_INPUT":
            for link in [link for output in node.outputs for link in output.links if link.to_node in made]:
                target = made[link.to_node].inputs[list(link.to_node.inputs).index(link.to_socket)]
                _hand_on(tree, given.get(link.from_socket.identifier), target)
    # and what goes out
    ends = [node for node in inner.nodes if node.type == "GROUP_OUTPUT" and node.is_active_output]
    for inside in [socket for end in ends for socket in end.inputs if socket.is_linked]:
        source = inside.links[0].from_socket
        output = next((one for one in group.outputs if one.identifier == inside.identifier), None)
        for target in [link.to_socket for link in (() if output is None else output.links)]:
            if source.node.type == "GROUP_INPUT":
                _hand_on(tree, given.get(source.identifier), target)
            else:
                tree.links.new(made[source.node].outputs[list(source.node.outputs).index(source)], target)
    tree.nodes.remove(group)


def _hand_on(tree: bpy.types.NodeTree, given: bpy.types.NodeSocket | None, target: bpy.types.NodeSocket) -> None:
    """Give a socket what a group's own socket gets, a link or a value."""
    if given is None:
        return
    if given.is_linked:
        tree.links.new(given.links[0].from_socket, target)
    elif hasattr(given, "default_value") and hasattr(target, "default_value"):
        value, own = given.default_value, target.default_value
        if not hasattr(value, "__len__") and not hasattr(own, "__len__"):
            target.default_value = type(own)(value)
        elif given.type == target.type:
            target.default_value = value
        else:
            # a link lets Blender convert the value: a colour becomes its luminance, a vector its mean
            tree.links.new(_constant(tree, given), target)


def _constant(tree: bpy.types.NodeTree, given: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Add a node with the value of the socket `given`, a number, a colour or a vector; return its output."""
    if given.type == "RGBA":
        node = tree.nodes.new("ShaderNodeRGB")
        node.outputs[0].default_value = given.default_value
    elif hasattr(given.default_value, "__len__"):
        node = tree.nodes.new("ShaderNodeCombineXYZ")
        for socket, component in zip(node.inputs, given.default_value):
            socket.default_value = component
    else:
        node = tree.nodes.new("ShaderNodeValue")
        node.outputs[0].default_value = float(given.default_value)
    return node.outputs[0]
