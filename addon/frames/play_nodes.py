"""Geometry Nodes that take out of a file's colours what was packed into them, and no more: they need no extension."""
from __future__ import annotations

import bpy

from ..writing import UV_MAP, Builder
from .packed_mesh import MATERIAL, colour_names
from .write_frame import material_key

NAME = "Reflection Frames"


def unpacking_nodes(attributes: list, materials: list, unlit_apart: bool = False) -> bpy.types.NodeTree:
    """A node group that gives a mesh its attributes by their names, and its faces the materials of an object's slots.

    Parameters
    ----------
    attributes : list of (name, kind, domain)
        As they were packed.
    materials : list of (name, library)
        Those of the slots, in their order.
    unlit_apart : bool
        Whether frames that show no light have slots of their own, as many, behind those.
    """
    tree = bpy.data.node_groups.new(NAME, "GeometryNodeTree")
    tree.is_modifier = True
    for way in ("INPUT", "OUTPUT"):
        tree.interface.new_socket("Geometry", in_out=way, socket_type="NodeSocketGeometry")
    unpack = _Unpack(tree)
    geometry = unpack.builder.add("NodeGroupInput").outputs[0]
    for index, entry in enumerate(materials):
        geometry = unpack.with_material(geometry, index, material_key(*entry))
    for lit_by in [colour_names(*entry)[0] for entry in attributes if entry[0] == UV_MAP][:unlit_apart]:
        geometry = unpack.unlit_behind(geometry, lit_by, max(len(materials), 1))
    for attribute in attributes:
        geometry = unpack.stored(geometry, *attribute)
    for colour in [MATERIAL] + [colour for attribute in attributes for colour in colour_names(*attribute)]:
        geometry = unpack.builder.through("GeometryNodeRemoveAttribute", geometry, Name=colour)
    unpack.builder.join(geometry, unpack.builder.add("NodeGroupOutput").inputs[0])
    return tree


class _Unpack:
    """Nodes that take colours apart, put together what belongs together, and store it."""

    def __init__(self, tree: bpy.types.NodeTree) -> None:
        self.builder = Builder(tree)

    def with_material(self, geometry: bpy.types.NodeSocket, index: int, key: tuple) -> bpy.types.NodeSocket:
        """Faces whose number is `key`, in parts, show the material of slot `index`."""
        chosen = None
        for part, number in zip(key, self._numbers(MATERIAL), strict=True):
            same = self.builder.add("FunctionNodeCompare", data_type="INT", operation="EQUAL")
            first, second = (socket for socket in same.inputs if socket.enabled)
            self.builder.join(self._rounded(number), first)
            second.default_value = part
            chosen = same.outputs[0] if chosen is None else self._both(chosen, same.outputs[0])
        node = self.builder.add("GeometryNodeSetMaterialIndex")
        self.builder.join(geometry, node.inputs["Geometry"])
        self.builder.join(chosen, node.inputs["Selection"])
        node.inputs["Material Index"].default_value = index
        return node.outputs["Geometry"]

    def unlit_behind(self, geometry: bpy.types.NodeSocket, lit_by: str, count: int) -> bpy.types.NodeSocket:
        """In frames without the colour `lit_by`, add `count` to the material index of all faces."""
        lit = self.builder.read(lit_by, "FLOAT_COLOR").node.outputs["Exists"]
        unlit, further = (self.builder.add(kind, operation=operation) for kind, operation in (
            ("FunctionNodeBooleanMath", "NOT"), ("ShaderNodeMath", "ADD")))
        self.builder.join(lit, unlit.inputs[0])
        self.builder.join(self.builder.add("GeometryNodeInputMaterialIndex").outputs[0], further.inputs[0])
        further.inputs[1].default_value = count
        node = self.builder.add("GeometryNodeSetMaterialIndex")
        for output, name in ((geometry, "Geometry"), (unlit.outputs[0], "Selection"),
                             (self._rounded(further.outputs[0]), "Material Index")):
            self.builder.join(output, node.inputs[name])
        return node.outputs["Geometry"]

    def _both(self, one: bpy.types.NodeSocket, other: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        node = self.builder.add("FunctionNodeBooleanMath", operation="AND")
        self.builder.join(one, node.inputs[0])
        self.builder.join(other, node.inputs[1])
        return node.outputs[0]

    def stored(self, geometry: bpy.types.NodeSocket, name: str, kind: str, domain: str) -> bpy.types.NodeSocket:
        """Store an attribute under its own name."""
        numbers = [number for colour in colour_names(name, kind, domain) for number in self._numbers(colour)]
        if domain == "EDGE":
            numbers = list(map(self._at_first_corner, numbers))
        node = self.builder.add("GeometryNodeStoreNamedAttribute", data_type=kind, domain=domain)
        node.inputs["Name"].default_value = name
        self.builder.join(geometry, node.inputs["Geometry"])
        value = next(socket for socket in node.inputs if socket.name == "Value" and socket.enabled)
        self.builder.join(self._together(kind, numbers), value)
        return node.outputs["Geometry"]

    def _numbers(self, colour: str) -> list:
        node = self.builder.add("FunctionNodeSeparateColor", mode="RGB")
        self.builder.join(self.builder.read(colour, "FLOAT_COLOR"), node.inputs[0])
        return list(node.outputs[:3])

    def _at_first_corner(self, number: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Return the value at one of the corners from which an edge starts. All of them have the same value."""
        corner = self.builder.add("GeometryNodeCornersOfEdge")
        there = self.builder.add("GeometryNodeFieldAtIndex", data_type="FLOAT", domain="CORNER")
        index = next(socket for socket in there.inputs if socket.name == "Index")
        value = next(socket for socket in there.inputs if socket.name == "Value" and socket.enabled)
        self.builder.join(corner.outputs["Corner Index"], index)
        self.builder.join(number, value)
        return next(socket for socket in there.outputs if socket.enabled)

    def _together(self, kind: str, numbers: list) -> bpy.types.NodeSocket:
        if kind in {"INT", "INT8", "BOOLEAN"}:
            return self._rounded(numbers[0])
        if kind == "FLOAT":
            return numbers[0]
        node = self.builder.add("FunctionNodeCombineColor" if kind.endswith("COLOR") else "ShaderNodeCombineXYZ")
        for number, socket in zip(numbers, node.inputs, strict=False):
            self.builder.join(number, socket)
        return node.outputs[0]

    def _rounded(self, number: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Round to an integer, since the mean of three equal numbers may be slightly off."""
        node = self.builder.add("FunctionNodeFloatToInt", rounding_mode="ROUND")
        self.builder.join(number, node.inputs[0])
        return node.outputs[0]
