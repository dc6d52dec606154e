"""Nodes of one tree made anew in another, as Blender itself does by its clipboard alone."""
from __future__ import annotations

from collections.abc import Iterable

import bpy

STRUCTURES = ("image_user", "texture_mapping", "color_mapping")
OWN = {"parent", "select", "show_options", "name", "location_absolute"}  # properties of a node's place in its tree


def copied(nodes: Iterable[bpy.types.Node], tree: bpy.types.NodeTree) -> dict[bpy.types.Node, bpy.types.Node]:
    """Copy nodes into `tree` with the links among them. Return the copies by the original nodes."""
    made = {node: _copy(node, tree) for node in nodes}
    for node, copy in made.items():
        for socket, new in zip(node.inputs, copy.inputs):
            for link in socket.links:
                if link.from_node in made:
                    place = list(link.from_node.outputs).index(link.from_socket)
                    tree.links.new(made[link.from_node].outputs[place], new)
    return made


def _copy(node: bpy.types.Node, tree: bpy.types.NodeTree) -> bpy.types.Node:
    made = tree.nodes.new(node.bl_idname)
    _take_over(node, made)
    for name in STRUCTURES:
        if hasattr(node, name):
            _take_over(getattr(node, name), getattr(made, name))
    if hasattr(node, "color_ramp"):
        _ramp(node.color_ramp, made.color_ramp)
    if isinstance(getattr(node, "mapping", None), bpy.types.CurveMapping):
        _curves(node.mapping, made.mapping)
    for socket, new in zip(node.inputs, made.inputs):
        if hasattr(socket, "default_value") and hasattr(new, "default_value"):
            new.default_value = socket.default_value
    for socket, new in zip(node.outputs, made.outputs):
        # a value or a colour of its own
        if not node.inputs and hasattr(socket, "default_value"):
            new.default_value = socket.default_value
    return made


def _take_over(source: bpy.types.bpy_struct, target: bpy.types.bpy_struct) -> None:
    for known in source.bl_rna.properties:
        if not known.is_readonly and known.identifier not in OWN and known.type != "COLLECTION":
            setattr(target, known.identifier, getattr(source, known.identifier))


def _ramp(source: bpy.types.ColorRamp, target: bpy.types.ColorRamp) -> None:
    for name in ("color_mode", "interpolation", "hue_interpolation"):
        setattr(target, name, getattr(source, name))
    while len(target.elements) > 1:
        target.elements.remove(target.elements[-1])
    for place, element in enumerate(source.elements):
        new = target.elements[0] if place == 0 else target.elements.new(element.position)
        new.position, new.color = element.position, element.color


def _curves(source: bpy.types.CurveMapping, target: bpy.types.CurveMapping) -> None:
    _take_over(source, target)
    for curve, new in zip(source.curves, target.curves):
        while len(new.points) > 2:
            new.points.remove(new.points[-1])
        for place, point in enumerate(curve.points):
            one = new.points[place] if place < 2 else new.points.new(*point.location)
            one.location, one.handle_type = point.location, point.handle_type
    target.update()
