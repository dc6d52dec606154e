"""Mirrors whose shader stands in a group of nodes look as Cycles shows them, in a preview and with light."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from grouped_shaders import into_a_group
from lamp_scenes import picture, principled, psnr, scene_of

GOLD = (0.9, 0.5, 0.2)


@pytest.fixture
def wall(blank) -> bpy.types.Object:
    """A golden wall by the group's material alone, before a box; another material stands beside it on no face."""
    scene_of(blank)
    wall = bpy.data.objects["Mirror"]
    wall.data.materials.clear()
    wall.reflection_mesh.role = "AUTO"
    wall.data.materials.append(principled("Gold", GOLD, Metallic=1.0, Roughness=0.0))
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], wall)
    return wall


def test_light_is_tinted_as_in_cycles(wall, room):
    into_a_group(wall.data.materials[0], 0.0)
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    assert result.reflection_mesh.mirror == wall
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.5


def test_a_preview_is_that_of_the_same_shader_without_a_group(wall, room):
    shown = []
    for grouped in (False, True):
        if grouped:
            into_a_group(wall.data.materials[0], 0.0)
        parts.generate(preview=True)
        assert "Gold.001" not in bpy.data.materials
        shown.append(picture(room))
        bpy.ops.reflection_mesh.clear()
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], wall)
    assert np.abs(shown[0] - shown[1]).mean() < 0.002


def test_a_groups_colour_is_the_number_that_blender_makes_of_it(wall, room):
    """The group's own colour is mixed in as a factor: by its luminance, 0.54, which is not its mean, 0.6."""
    material = wall.data.materials[0]
    group = bpy.data.node_groups.new("Shine", "ShaderNodeTree")
    group.interface.new_socket("Amount", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    begin, end, shine, metal = (group.nodes.new(kind) for kind in (
        "NodeGroupInput", "NodeGroupOutput", "ShaderNodeMixShader", "ShaderNodeBsdfAnisotropic"))
    metal.inputs["Roughness"].default_value = 0.0
    group.links.new(begin.outputs["Amount"], shine.inputs["Fac"])
    group.links.new(metal.outputs[0], shine.inputs[1])
    group.links.new(group.nodes.new("ShaderNodeEmission").outputs[0], shine.inputs[2])
    group.links.new(shine.outputs[0], end.inputs["Shader"])
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    node.inputs["Amount"].default_value = (0.2, 0.6, 1.0, 1.0)
    tree.links.new(node.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    wall.reflection_mesh.role = "MIRROR"
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.5
