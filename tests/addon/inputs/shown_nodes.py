"""Nodes by which materials of reflected objects ask where they are, whose they are and how they are seen."""
from __future__ import annotations

import bpy


def link(tree: bpy.types.NodeTree, output, socket) -> None:
    tree.links.new(output, socket)


def grooves(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Normals that a map in the first UV map tells."""
    told, place = tree.nodes.new("ShaderNodeNormalMap"), tree.nodes.new("ShaderNodeTexCoord")
    waves, tilt = tree.nodes.new("ShaderNodeTexWave"), tree.nodes.new("ShaderNodeCombineXYZ")
    waves.inputs["Scale"].default_value = 2.0
    tilt.inputs[1].default_value, tilt.inputs[2].default_value = 0.5, 0.8
    for output, socket in ((place.outputs["UV"], waves.inputs["Vector"]), (waves.outputs["Fac"], tilt.inputs[0]),
                           (tilt.outputs[0], told.inputs["Color"])):
        link(tree, output, socket)
    return told.outputs[0]


def fog(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """How pale something is by how far from the camera it lies."""
    told = tree.nodes.new("ShaderNodeMapRange")
    told.inputs["From Min"].default_value, told.inputs["From Max"].default_value = 4.0, 9.0
    link(tree, tree.nodes.new("ShaderNodeCameraData").outputs["View Distance"], told.inputs["Value"])
    return told.outputs[0]


def right_of_the_picture(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """1 in the right third of the picture, where a part of the box is."""
    where, told = tree.nodes.new("ShaderNodeSeparateXYZ"), tree.nodes.new("ShaderNodeMath")
    told.operation, told.inputs[1].default_value = "GREATER_THAN", 0.7
    link(tree, tree.nodes.new("ShaderNodeTexCoord").outputs["Window"], where.inputs[0])
    link(tree, where.outputs["X"], told.inputs[0])
    return told.outputs[0]


def random_number_in_group(tree: bpy.types.NodeTree) -> bpy.types.NodeSocket:
    """Object Info's, in a group of its own."""
    group = bpy.data.node_groups.new("Any", "ShaderNodeTree")
    group.interface.new_socket("Number", in_out="OUTPUT", socket_type="NodeSocketFloat")
    link(group, group.nodes.new("ShaderNodeObjectInfo").outputs["Random"], group.nodes.new("NodeGroupOutput").inputs[0])
    held = tree.nodes.new("ShaderNodeGroup")
    held.node_tree = group
    return held.outputs[0]
