"""Texels that are baked of objects: all that lies in them counts the same, and none is dark for what lies beside it in
the picture."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from lamp_scenes import link, picture, principled, psnr, scene_of


def light(samples: int = 64) -> None:
    assert bpy.ops.reflection_mesh.light(samples=samples, kind="OBJECTS", every=True) == {"FINISHED"}


def card_scene(context: bpy.types.Context, made: bpy.types.Material) -> None:
    """A card of that material before a wall mirror, under an even sky."""
    wall = scene_of(context)
    for obj in [obj for obj in context.scene.objects if obj.name in {"Box", "Floor"} or obj.type == "LIGHT"]:
        bpy.data.objects.remove(obj)
    context.scene.world.color = (0.8, 0.8, 0.8)
    card = parts.add("plane", "Card", size=9.0, location=(0.0, -8.0, 1.0), rotation=(-np.pi / 2, 0.0, 0.0))
    card.data.materials.append(made)
    parts.select(card, wall)
    context.view_layer.update()


def striped(output: str) -> tuple[bpy.types.Material, bpy.types.NodeSocket]:
    """A material that emits stripes along a side of the UV map, and where their number is put in."""
    made = parts.material("Stripes")
    tree = made.node_tree
    place, sides, times, wave, side = (tree.nodes.new(f"ShaderNode{kind}") for kind in (
        "TexCoord", "SeparateXYZ", "Math", "Math", "Math"))
    times.operation, wave.operation, side.operation = "MULTIPLY", "PINGPONG", "GREATER_THAN"
    wave.inputs[1].default_value, side.inputs[1].default_value = 0.5, 0.25
    link(tree, place.outputs["UV"], sides.inputs[0])
    link(tree, sides.outputs[output], times.inputs[0])
    link(tree, times.outputs[0], wave.inputs[0])
    link(tree, wave.outputs[0], side.inputs[0])
    glow = tree.nodes.new("ShaderNodeEmission")
    link(tree, side.outputs[0], glow.inputs["Strength"])
    link(tree, glow.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    return made, times.inputs[1]


def image_of(result: bpy.types.Object) -> bpy.types.Image:
    """The picture that a result shows."""
    nodes = result.reflection_mesh.light_material.node_tree.nodes
    return next(node.image for node in nodes if node.type == "TEX_IMAGE")


def texels_across(result: bpy.types.Object) -> float:
    """How many texels lie along a side of what a result shows."""
    points = np.array([point.co for point in result.reflection_mesh.light_map.vertices]).reshape(-1, 3, 3)
    sides = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    return float(np.sort(sides, axis=1)[0, 1] * image_of(result).size[0])


@pytest.mark.parametrize("output", ["X", "Y"])
def test_all_that_lies_in_a_texel_counts_the_same(blank, output):
    """Of stripes one of which goes to a texel, half of them dark, every texel tells a half, wherever they begin."""
    made, number = striped(output)
    card_scene(blank, made)
    result = parts.generate()
    light()
    number.default_value = texels_across(result)
    light(1024)
    image = image_of(result)
    pixels = np.array(image.pixels[:]).reshape(*image.size, 4)[..., 0]
    points = np.array([point.co for point in result.reflection_mesh.light_map.vertices]).reshape(-1, 3, 3)[..., :2]
    rows, columns = (points.mean(axis=1) * image.size[0]).astype(int).T[::-1]
    found = [pixels[row - 3:row + 4, column - 3:column + 4] for row, column in zip(rows, columns)]
    assert np.abs(np.array(found) - 0.5).max() < 0.1


@pytest.mark.parametrize("shining", [False, True])
def test_a_pattern_goes_on_where_triangles_meet(blank, room, shining):
    """Stripes that end at a diagonal of texels, and begin again beyond it."""
    made, number = striped("X")
    number.default_value = 9.0
    tree = made.node_tree
    wave = next(node for node in tree.nodes if node.type == "MATH" and node.operation == "PINGPONG").outputs[0]
    shader = tree.nodes.new("ShaderNodeEmission" if shining else "ShaderNodeBsdfDiffuse")
    link(tree, wave, shader.inputs["Color"])
    link(tree, shader.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    card_scene(blank, made)
    reference = picture(room)
    parts.generate()
    light()
    assert psnr(picture(room), reference) > 36.0


def test_no_seam_is_seen_where_triangles_meet(blank, room):
    """Of a card that is one colour, also along its diagonal."""
    card_scene(blank, principled("Paper", (0.8, 0.8, 0.8), **{"Specular IOR Level": 0.0}))
    reference = picture(room)[20:-20, 20:-20]
    parts.generate()
    light()
    shown = picture(room)[20:-20, 20:-20]
    assert np.abs(shown - reference).mean() < 0.01
    card = shown[len(shown) // 3:]
    assert np.abs(card - np.median(card)).max() < 0.02
