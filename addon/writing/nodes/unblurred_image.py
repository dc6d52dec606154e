"""An image between its texels, for EEVEE: its own look-up blurs some faces of fine meshes.

EEVEE looks images up in smaller copies of them (mipmaps) and by an anisotropic filter. What lies beside a face in the
image comes into the smaller copies, and the filter of OpenGL in software blurs some faces and leaves others sharp, be
there one texel a pixel or less. No setting of a material turns either off, but for *Closest*: so four look-ups of that
kind are mixed as linear interpolation does it.
"""
from __future__ import annotations

from collections.abc import Callable

import bpy

from ...faults import AllOrNothing, remove_new, unused
from .copied_nodes import copied
from .shader_builder import ShaderBuilder

MARK = "reflection_mesh_unblurred"
TWIN_BELOW = 1000.0  # vertical distance at which nodes for EEVEE alone are placed


def show_unblurred(tree: bpy.types.NodeTree, looks: list[bpy.types.Node], output: bpy.types.Node,
                   whole: AllOrNothing) -> None:
    """Let EEVEE show what an output shows of a tree, but each image that the nodes `looks` show there between its
    texels; by an output of its own, and nodes of its own from the images on. All others show what they did."""
    behind = _beyond([output], lambda node: node.inputs, lambda link: link.from_node)
    looks = [look for look in looks if look in behind]
    between = [node for node in _beyond(looks, lambda node: node.outputs, lambda link: link.to_node)
               if node in behind and node not in looks and node != output]
    groups = {}
    for look in looks:
        groups[look] = tree.nodes.new("ShaderNodeGroup")
        groups[look].node_tree, groups[look].location = _unblurred(look.image, whole), look.location
        for link in look.inputs["Vector"].links:
            tree.links.new(link.from_socket, groups[look].inputs["Vector"])
    made = copied(between, tree)
    own = next((node for node in tree.nodes if node.type == "OUTPUT_MATERIAL" and node.target == "EEVEE"), None)
    if own is None:
        own = tree.nodes.new("ShaderNodeOutputMaterial")
        own.target = "EEVEE"
    for node, twin in [*made.items(), (output, own)]:
        twin.location = (node.location[0], node.location[1] - TWIN_BELOW)
        for socket, new in zip(node.inputs, twin.inputs):
            for link in socket.links:
                source = link.from_socket
                if link.from_node in groups:
                    source = groups[link.from_node].outputs[source.name]
                elif link.from_node in made:
                    source = made[link.from_node].outputs[list(link.from_node.outputs).index(source)]
                tree.links.new(source, new)


def _unblurred(image: bpy.types.Image, whole: AllOrNothing) -> bpy.types.NodeTree:
    """Return a node group that computes the colour and the alpha of an image at UV coordinates, by linear interpolation
    of its own texels. Beyond the border it repeats the border.
    """
    group = bpy.data.node_groups.new(f"{image.name} Unblurred", "ShaderNodeTree")
    # whoever takes back what shows it may have removed it
    whole.undo(remove_new, group)
    group[MARK] = True
    for name, kind, way in (("Vector", "Vector", "INPUT"), ("Color", "Color", "OUTPUT"), ("Alpha", "Float", "OUTPUT")):
        group.interface.new_socket(name, in_out=way, socket_type=f"NodeSocket{kind}")
    build = ShaderBuilder(group)
    size = (*image.size, 1.0)
    place = build.vector("MULTIPLY", build.add("NodeGroupInput").outputs["Vector"], size)
    texels = build.vector("SUBTRACT", place, (0.5, 0.5, 0.0))
    corner = build.vector("FLOOR", texels)
    along = build.add("ShaderNodeSeparateXYZ")
    build.feed(build.vector("FRACTION", texels), along.inputs[0])
    rows = [[_texel(build, image, build.vector("DIVIDE", build.vector("ADD", corner, (right, up, 0.0)), size))
             for right in (0.5, 1.5)] for up in (0.5, 1.5)]
    output = build.add("NodeGroupOutput")
    for name, mixed in (("Color", _colour), ("Alpha", _number)):
        lower, upper = (mixed(build, along.outputs[0], *(look.outputs[name] for look in row)) for row in rows)
        build.feed(mixed(build, along.outputs[1], lower, upper), output.inputs[name])
    return group


def forget_unblurred(groups: list[bpy.types.NodeTree]) -> None:
    """Remove those node groups of this kind that nothing else uses."""
    bpy.data.batch_remove(unused(groups))


def unblurred_in(tree: bpy.types.NodeTree | None) -> list[bpy.types.NodeTree]:
    """Return the groups of this kind that a tree uses."""
    return list(dict.fromkeys(node.node_tree for node in (tree.nodes if tree else ())
                              if node.type == "GROUP" and node.node_tree is not None and MARK in node.node_tree))


def _beyond(nodes: list[bpy.types.Node], sockets: Callable, other: Callable) -> list[bpy.types.Node]:
    """Some nodes, and those that links lead to, one after the other."""
    found = dict.fromkeys(nodes)
    left = list(nodes)
    while left:
        for socket in sockets(left.pop()):
            for node in map(other, socket.links):
                if node not in found:
                    found[node] = None
                    left.append(node)
    return list(found)


def _texel(build: ShaderBuilder, image: bpy.types.Image, place: bpy.types.NodeSocket) -> bpy.types.Node:
    look = build.add("ShaderNodeTexImage", name=image.name, image=image, interpolation="Closest", extension="EXTEND")
    build.feed(place, look.inputs["Vector"])
    return look


def _colour(build: ShaderBuilder, share, first, second) -> bpy.types.NodeSocket:
    return build.blended("MIX", share, first, second)


def _number(build: ShaderBuilder, share, first, second) -> bpy.types.NodeSocket:
    node = build.add("ShaderNodeMix")
    for value, socket in zip((share, first, second), (node.inputs[0], node.inputs[2], node.inputs[3])):
        build.feed(value, socket)
    return node.outputs[0]
