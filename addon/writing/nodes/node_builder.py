"""Builds trees of nodes."""
from __future__ import annotations

import bpy


class Builder:
    """Adds nodes to a tree from left to right; what works on geometry is of Geometry Nodes."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.tree = tree

    def add(self, kind: str, **settings) -> bpy.types.Node:
        node = self.tree.nodes.new(kind)
        node.location = (200.0 * len(self.tree.nodes), 0.0)
        for name, value in settings.items():
            setattr(node, name, value)
        return node

    def join(self, output: bpy.types.NodeSocket, socket: bpy.types.NodeSocket) -> None:
        self.tree.links.new(output, socket)

    def through(self, kind: str, geometry: bpy.types.NodeSocket, **inputs) -> bpy.types.NodeSocket:
        """Add a node to the tree that takes and returns geometry, and return its output socket "Geometry".

        Parameters
        ----------
        kind : str
            Node type (`bl_idname`), such as "GeometryNodeRealizeInstances".
        geometry : bpy.types.NodeSocket
            Socket that is linked to the node's input "Geometry".
        **inputs
            Values of other input sockets, by the socket's name.
        """
        node = self.add(kind)
        for name, value in inputs.items():
            node.inputs[name].default_value = value
        self.join(geometry, node.inputs["Geometry"])
        return node.outputs["Geometry"]

    def read(self, attribute: str, kind: str) -> bpy.types.NodeSocket:
        node = self.add("GeometryNodeInputNamedAttribute", data_type=kind)
        node.inputs["Name"].default_value = attribute
        return next(socket for socket in node.outputs if socket.name == "Attribute" and socket.enabled)

    def moved(self, geometry: bpy.types.NodeSocket, attribute: str, read: str, stored: str,
              domain: str) -> bpy.types.NodeSocket:
        """Move an attribute of the points to the faces or corners of their discs."""
        node = self.add("GeometryNodeStoreNamedAttribute", data_type=stored, domain=domain)
        node.inputs["Name"].default_value = attribute
        self.join(geometry, node.inputs["Geometry"])
        value = next(socket for socket in node.inputs if socket.name == "Value" and socket.enabled)
        self.join(self.read(attribute, read), value)
        return node.outputs["Geometry"]
