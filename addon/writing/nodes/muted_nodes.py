"""Muted nodes and links of a tree, taken out so that what is left says what engines show."""
from __future__ import annotations

import bpy


def take_out_muted(tree: bpy.types.NodeTree) -> None:
    """Take muted links out of a tree, which is our own, and muted nodes: what they pass on is linked past them."""
    for link in [link for link in tree.links if link.is_muted]:
        tree.links.remove(link)
    for node in [node for node in tree.nodes if node.mute]:
        for passed in list(node.internal_links):
            for link in list(passed.to_socket.links):
                _pass(tree, passed.from_socket, link.to_socket)
        tree.nodes.remove(node)


def _pass(tree: bpy.types.NodeTree, source: bpy.types.NodeSocket, target: bpy.types.NodeSocket) -> None:
    """Give a socket what another one is given, a link or a value of the same kind."""
    if source.is_linked:
        tree.links.new(source.links[0].from_socket, target)
    elif source.type == target.type and hasattr(target, "default_value"):
        target.default_value = source.default_value
