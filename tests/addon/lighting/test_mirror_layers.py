"""Light that stays with the objects, in curved mirrors whose own look goes by their UV maps and attributes."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, mirror_material, picture, principled, psnr, scene_of, shader_of


def random_picture() -> bpy.types.Image:
    image = bpy.data.images.new("Random", 8, 8)
    pixels = np.random.default_rng(4).uniform(0.2, 1.0, (64, 4)).astype(np.float32)
    image.pixels.foreach_set(pixels.ravel())
    return image


def _ball(scene, paint: str) -> bpy.types.Object:
    """A ball in the place of the wall mirror: tinted, or varnished paint, by a map or colours that differ from those of
    what it shows; a part of tinted ones is matte."""
    bpy.data.objects.remove(bpy.data.objects["Mirror"])
    ball = parts.add("uv_sphere", "Mirror", radius=1.5, location=(0.0, 1.0, 0.9), segments=24, ring_count=12,
                     rotation=(0.5, 0.2, 0.4))
    ball.data.shade_smooth()
    if paint == "Fresnel from behind":
        ball.data.flip_normals()
        ball.data.materials.append(mirror_material("Fresnel"))
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], ball)
        ball.reflection_mesh.role = "MIRROR"
        return ball
    varnished = paint.startswith("varnish")
    made = principled("Ball", Metallic=0.0 if varnished else 1.0, Roughness=0.9 if varnished else 0.0)
    tree, shader = made.node_tree, shader_of(made)
    if varnished:
        shader.inputs["Coat Weight"].default_value, shader.inputs["Coat Roughness"].default_value = 1.0, 0.0
    ball.data.materials.append(made)
    ball.data.materials.append(principled("Matte", (0.2, 0.2, 0.2)))
    if "colours" in paint:
        layer = ball.data.color_attributes.new("Col", "BYTE_COLOR", "CORNER")
        colours = np.random.default_rng(3).uniform(0.2, 1.0, (len(layer.data), 4)).astype(np.float32)
        layer.data.foreach_set("color", colours.ravel())
        read = tree.nodes.new("ShaderNodeVertexColor")
        read.layer_name = "" if paint.endswith("active") else "Col"
        link(tree, read.outputs["Color"], shader.inputs["Base Color"])
    elif "box" in paint:
        by_box = tree.nodes.new("ShaderNodeTexImage")
        by_box.projection, by_box.projection_blend = "BOX", 0.4 if "blended" in paint else 0.0
        by_box.image, by_box.interpolation = random_picture(), "Closest"
        link(tree, tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], by_box.inputs["Vector"])
        link(tree, by_box.outputs["Color"], shader.inputs["Base Color"])
    else:
        checks = tree.nodes.new("ShaderNodeTexChecker")
        checks.inputs["Color1"].default_value, checks.inputs["Color2"].default_value = (1, .9, .5, 1), (.2, .4, .9, 1)
        if "map" in paint:
            checks.inputs["Scale"].default_value = 16.0
            ball.data.uv_layers[0].name = "Livery"
            coordinates = tree.nodes.new("ShaderNodeUVMap")
            coordinates.uv_map = "Livery"
            link(tree, coordinates.outputs[0], checks.inputs["Vector"])
        else:
            checks.inputs["Scale"].default_value = 16.0 if paint == "tint" else 3.0
            coordinates = tree.nodes.new("ShaderNodeTexCoord").outputs
            link(tree, coordinates["UV" if paint == "tint" else "Normal"], checks.inputs["Vector"])
        link(tree, checks.outputs["Color"], shader.inputs["Base Color"])
    for polygon in ball.data.polygons:
        polygon.material_index = int(polygon.center.z < -0.9 and not varnished)
    ball.reflection_mesh.role = "MIRROR"
    parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], ball)
    return ball


@pytest.mark.slow
@pytest.mark.parametrize(("paint", "faces"), [
    ("tint", "cut"), ("varnish map", "cut"), ("tint by colours", "cut"), ("varnish by colours, the active", "cut"),
    ("tint by normals", "cut"), ("tint by box", "cut"), ("tint by blended box", "cut"),
    ("Fresnel from behind", "cut"), ("varnish map", "whole")])
def test_its_look_stays_on_a_curved_mirror(blank, room, monkeypatch, paint, faces):
    scene_of(blank)
    ball = _ball(blank.scene, paint)
    if faces == "whole":
        # what is dense is drawn by its vertices, over several triangles of the mirror
        monkeypatch.setattr(room("core.whole_faces.whole"), "LEAST_TRIANGLES", 1000)
        fine = bpy.data.objects["Floor"].modifiers.new("Fine", "SUBSURF")
        fine.subdivision_type, fine.levels, fine.render_levels = "SIMPLE", 5, 5
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    spans = np.empty(len(result.data.polygons), dtype=np.int32)
    result.data.attributes["mirror_face"].data.foreach_get("value", spans)
    assert ((spans < 0).mean() > 0.05) == (faces == "whole")
    bpy.ops.reflection_mesh.light(samples=64)
    assert psnr(picture(room), reference) > psnr(other, reference) + 0.5
    if paint == "varnish map":
        # generated again it keeps it
        parts.select(ball)
        parts.generate()
        assert psnr(picture(room), reference) > psnr(other, reference) + 0.5


@pytest.mark.parametrize("kind", ["emission", "edge", "Metallic BSDF", "conductor"])
def test_a_metal_that_shines_or_has_an_edge_tint_does_so_in_light_on_objects(blank, room, kind):
    scene_of(blank)
    ball = _ball(blank.scene, "metal")
    if kind in {"Metallic BSDF", "conductor"} and not hasattr(bpy.types, "ShaderNodeBsdfMetallic"):
        pytest.skip("Blender has the Metallic BSDF from 4.3 on.")
    made = principled("Metal", (0.9, 0.5, 0.4), Metallic=1.0, Roughness=0.0)
    shader = shader_of(made)
    if kind == "emission":
        shader.inputs["Emission Color"].default_value = (0.1, 0.3, 0.1, 1.0)
        shader.inputs["Emission Strength"].default_value = 1.0
    elif kind == "edge":
        shader.inputs["Specular Tint"].default_value = (0.1, 0.3, 0.9, 1.0)
    else:
        tree = made.node_tree
        metal = tree.nodes.new("ShaderNodeBsdfMetallic")
        metal.inputs["Base Color"].default_value = (0.9, 0.5, 0.4, 1.0)
        metal.inputs["Edge Tint"].default_value = (0.1, 0.3, 0.9, 1.0)
        metal.inputs["Roughness"].default_value = 0.0
        if kind == "conductor":
            metal.fresnel_type = "PHYSICAL_CONDUCTOR"
            metal.inputs["IOR"].default_value = (0.18, 0.42, 1.47)  # gold's
            metal.inputs["Extinction"].default_value = (3.4, 2.35, 1.95)
        link(tree, metal.outputs[0], tree.get_output_node("ALL").inputs[0])
    ball.data.materials.clear()
    ball.data.materials.append(made)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate()
    assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    assert psnr(picture(room), reference) > psnr(other, reference) + 0.5
