"""Light that stays with the objects: what is within open objects, what lights itself, and gloss close to a mirror, as
Cycles shows them in mirrors."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import link, picture, principled, psnr, scene_of, shader_of


def is_as_the_mirror_shows(room) -> bool:
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    lit, noise = psnr(picture(room), reference), psnr(other, reference)
    # measured: 2.2 to 7.4 dB above it, since light is denoised
    return lit > noise + 1.0


def tube_of(context: bpy.types.Context, material: bpy.types.Material) -> None:
    """An open tube into which a wall mirror looks."""
    scene_of(context, "Backfacing")
    bpy.data.objects["Box"].data.materials[0] = material


@pytest.mark.slow
@pytest.mark.parametrize(("node", "grouped"), [("Fresnel", False), ("LayerWeight", False), ("Fresnel", True)])
def test_fresnel_from_within_is_that_of_leaving(blank, room, node, grouped):
    """A colour by how much a surface reflects: from behind, all of it at most angles."""
    made = principled("Angle")
    tree = made.node_tree
    if grouped:
        inner, outer = bpy.data.node_groups.new("Angle", "ShaderNodeTree"), tree.nodes.new("ShaderNodeGroup")
        inner.interface.new_socket("Share", in_out="OUTPUT", socket_type="NodeSocketFloat")
        outer.node_tree = inner
        link(inner, inner.nodes.new(f"ShaderNode{node}").outputs[0], inner.nodes.new("NodeGroupOutput").inputs[0])
        told = outer.outputs[0]
    else:
        told = tree.nodes.new(f"ShaderNode{node}").outputs["Fac" if node == "Fresnel" else "Fresnel"]
    link(tree, told, shader_of(made).inputs["Base Color"])
    tube_of(blank, made)
    assert is_as_the_mirror_shows(room)


@pytest.mark.slow
def test_glass_from_within_bends_light_as_where_it_leaves(blank, room):
    """A sheet of glass, seen from behind, which bends what comes through it the other way."""
    tube_of(blank, principled("Glass", (0.3, 1.0, 0.5), **{"Transmission Weight": 1.0, "Roughness": 0.0, "IOR": 1.8}))
    assert is_as_the_mirror_shows(room)


@pytest.mark.slow
@pytest.mark.parametrize("grouped", [False, True])
def test_what_shines_lights_itself(blank, room, grouped):
    """A tube whose walls are lit by nothing but each other."""
    made = principled("Shine", (0.9, 0.9, 0.9), **{"Specular IOR Level": 0.0})
    shader_of(made).inputs["Emission Color"].default_value = (0.3, 0.15, 0.1, 1.0)
    shader_of(made).inputs["Emission Strength"].default_value = 1.0
    if grouped:
        _into_a_group(made)
    tube_of(blank, made)
    blank.scene.world.color = (0.0, 0.0, 0.0)
    bpy.data.objects.remove(next(obj for obj in bpy.data.objects if obj.type == "LIGHT"))
    assert is_as_the_mirror_shows(room)


@pytest.mark.slow
def test_gloss_is_not_left_out_where_no_one_place_sees_it_as_the_mirror_does(blank, room):
    """Compare with Cycles two mirror balls on a dark floor under a bright sky.

    They show each other over several bounces, and the sky and the lamp after the last one.
    """
    scene_of(blank)
    for name in ("Mirror", "Box"):
        bpy.data.objects.remove(bpy.data.objects[name])
    balls = [parts.add("uv_sphere", "Balls", radius=1.0, segments=48, ring_count=24, location=(place, 0.0, 0.4))
             for place in (-1.1, 1.1)]
    for ball in balls:
        ball.data.shade_smooth()
        ball.data.materials.append(principled("Chrome", Metallic=1.0, Roughness=0.0))
    parts.select(*balls)
    bpy.ops.object.join()
    floor = bpy.data.objects["Floor"]
    floor.data.materials[0] = principled("Ground", (0.15, 0.15, 0.18), Roughness=0.4)
    blank.scene.world.color = (0.6, 0.7, 0.9)
    parts.select(floor, blank.object)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    # measured: 37.8 dB, of noise 39.2: the outlines of lamps in the balls' images of each other; with the straight
    # light of the sky there it is 32.7
    assert psnr(picture(room), reference) > min(37.0, psnr(other, reference) - 1.5)


def _into_a_group(material: bpy.types.Material) -> None:
    """Let a material's Principled BSDF stand in a group of nodes."""
    tree, inner = material.node_tree, bpy.data.node_groups.new("Paint", "ShaderNodeTree")
    inner.interface.new_socket("Surface", in_out="OUTPUT", socket_type="NodeSocketShader")
    own, outer = shader_of(material), tree.nodes.new("ShaderNodeGroup")
    outer.node_tree = inner
    shader = inner.nodes.new("ShaderNodeBsdfPrincipled")
    for socket in own.inputs:
        if socket.type in {"VALUE", "RGBA"} and socket.name in shader.inputs:
            shader.inputs[socket.name].default_value = socket.default_value
    link(inner, shader.outputs[0], inner.nodes.new("NodeGroupOutput").inputs[0])
    link(tree, outer.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    tree.nodes.remove(own)
