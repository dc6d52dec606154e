"""Builds trees of shader nodes, from what a tree already has."""
from __future__ import annotations

import bpy

from .node_builder import Builder


class ShaderBuilder(Builder):
    """Adds shader nodes to a tree. Each value may be a socket, a number or a colour."""

    def feed(self, value, socket: bpy.types.NodeSocket) -> None:
        """Link or assign a value (a socket, a number or a colour) to a socket."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif socket.type == "RGBA":
            socket.default_value = (value,) * 3 + (1.0,) if isinstance(value, float) else value
        else:
            socket.default_value = value

    def glow(self, colour) -> bpy.types.NodeSocket:
        node = self.add("ShaderNodeEmission")
        self.feed(colour, node.inputs["Color"])
        return node.outputs[0]

    def mixed(self, factor, first, second) -> bpy.types.NodeSocket:
        node = self.add("ShaderNodeMixShader")
        for value, socket in zip((factor, first, second), node.inputs, strict=True):
            if value is not None:
                self.feed(value, socket)
        return node.outputs[0]

    def blended(self, how: str, factor, first, second) -> bpy.types.NodeSocket:
        """Colours mixed or multiplied."""
        node = self.add("ShaderNodeMix", data_type="RGBA", blend_type=how)
        for value, socket in ((factor, node.inputs[0]), (first, node.inputs[6]), (second, node.inputs[7])):
            self.feed(value, socket)
        return node.outputs[2]

    def calculated(self, how: str, first, second=0.0) -> bpy.types.NodeSocket:
        """Return the result of a Math node of one or two numbers."""
        node = self.add("ShaderNodeMath", operation=how)
        self.feed(first, node.inputs[0])
        self.feed(second, node.inputs[1])
        return node.outputs[0]

    def vector(self, how: str, first, second=None, **inputs) -> bpy.types.NodeSocket:
        """Return the result of a Vector Math node of one or two vectors. Further inputs are given by name."""
        node = self.add("ShaderNodeVectorMath", operation=how)
        for value, socket in ((first, node.inputs[0]), (second, node.inputs[1]),
                              *((value, node.inputs[name]) for name, value in inputs.items())):
            if value is not None:
                self.feed(value, socket)
        return next(socket for socket in node.outputs if socket.enabled)

    def unit_vector(self, attribute: str) -> bpy.types.NodeSocket:
        """Return the direction of a vector attribute. Interpolated between points, unit vectors are shorter."""
        return self.vector("NORMALIZE", self.add("ShaderNodeAttribute", attribute_name=attribute).outputs["Vector"])

    def combined(self, x, y, z) -> bpy.types.NodeSocket:
        """Return a vector of three numbers."""
        node = self.add("ShaderNodeCombineXYZ")
        for value, socket in zip((x, y, z), node.inputs):
            self.feed(value, socket)
        return node.outputs[0]

    def separated(self, vector) -> tuple:
        """Return the three components of a vector."""
        node = self.add("ShaderNodeSeparateXYZ")
        self.feed(vector, node.inputs[0])
        return tuple(node.outputs)

    def dot(self, first, second) -> bpy.types.NodeSocket:
        """Return the dot product of two vectors."""
        return self.vector("DOT_PRODUCT", first, second)

    def added(self, first: bpy.types.NodeSocket, second: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Two surfaces at once."""
        node = self.add("ShaderNodeAddShader")
        self.feed(first, node.inputs[0])
        self.feed(second, node.inputs[1])
        return node.outputs[0]


def given(socket: bpy.types.NodeSocket):
    """Return the socket that is linked to `socket`, or else its own value."""
    if socket.is_linked:
        return socket.links[0].from_socket
    value = socket.default_value
    return float(value) if isinstance(value, (int, float)) else tuple(value)


def cut(tree: bpy.types.NodeTree, socket: bpy.types.NodeSocket, value: float) -> None:
    """Remove the links to a socket and set its value."""
    for link in list(socket.links):
        tree.links.remove(link)
    socket.default_value = value


def node_behind(socket: bpy.types.NodeSocket) -> bpy.types.Node | None:
    """Return the node that feeds a socket, ignoring reroutes; None if nothing does."""
    while socket.is_linked and socket.links[0].from_node.type == "REROUTE":
        socket = socket.links[0].from_node.inputs[0]
    return socket.links[0].from_node if socket.is_linked else None
