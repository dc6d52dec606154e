"""Materials whose shader stands in a group of nodes."""
from __future__ import annotations

import bpy


def shader_of(material: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in material.node_tree.nodes if node.type.startswith("BSDF"))


def into_a_group(material: bpy.types.Material, roughness: float | None = None) -> bpy.types.Node:
    """Put a material's shader into a group, where a socket of the group tells its roughness, within another one."""
    tree, own = material.node_tree, shader_of(material)
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    kind, values = own.bl_idname, {name: own.inputs[name].default_value for name in ("Roughness", "Metallic")
                                   if name in own.inputs}
    values |= {name: tuple(own.inputs[name].default_value) for name in ("Base Color", "Color") if name in own.inputs}
    tree.nodes.remove(own)
    inner, outer = (bpy.data.node_groups.new(name, "ShaderNodeTree") for name in ("Inner", "Outer"))
    for group in (inner, outer):
        group.interface.new_socket("Rough", in_out="INPUT", socket_type="NodeSocketFloat")
        group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    shader, start, end = map(inner.nodes.new, (kind, "NodeGroupInput", "NodeGroupOutput"))
    for name, value in values.items():
        shader.inputs[name].default_value = value
    if roughness is not None:
        inner.links.new(start.outputs[0], shader.inputs["Roughness"])
    inner.links.new(shader.outputs[0], end.inputs[0])
    held, start, end = map(outer.nodes.new, ("ShaderNodeGroup", "NodeGroupInput", "NodeGroupOutput"))
    held.node_tree = inner
    outer.links.new(start.outputs[0], held.inputs[0])
    outer.links.new(held.outputs[0], end.inputs[0])
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = outer
    node.inputs[0].default_value = roughness or 0.0
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    return node
