"""What emits is lit where the reflection does not carry all that it emits by, and only there."""
from __future__ import annotations

import bpy
import parts
import pytest
from lamp_scenes import SIZE, link, picture, plain_scene, psnr

pytestmark = pytest.mark.thorough

BOTH = ((0.9, 0.2, 0.1, 1.0), (0.1, 0.3, 0.9, 1.0))
# a node and the output that is asked
ASKED = {"ray": ("LightPath", "Is Camera Ray"), "side": ("NewGeometry", "Backfacing"),
         "object": ("ObjectInfo", "Random"), "place": ("NewGeometry", "Position"),
         "Generated": ("TexCoord", "Generated"), "of the object": ("Attribute", "Fac")}
CARRIED = {"UV": ("TexCoord", "UV"), "colours": ("VertexColor", "Color"), "attribute": ("Attribute", "Color")}


def emitting(kind: str) -> bpy.types.Material:
    """The scene's box emits one of two colours, or something between, by what a node tells."""
    plain_scene()
    box = bpy.data.objects["Box"]
    box.visible_camera = False
    shade = box.data.color_attributes.new("Shade", "FLOAT_COLOR", "CORNER")
    for number, entry in enumerate(shade.data):
        entry.color = (number / len(shade.data), 0.3, 0.2, 1.0)
    box["warmth"] = 0.8
    made = box.data.materials[0]
    tree = made.node_tree
    name, output = (ASKED | CARRIED)[kind]
    asked, mixed = tree.nodes.new(f"ShaderNode{name}"), tree.nodes.new("ShaderNodeMix")
    if name == "Attribute":
        of_object = kind == "of the object"
        asked.attribute_name, asked.attribute_type = ("warmth", "OBJECT") if of_object else ("Shade", "GEOMETRY")
    mixed.data_type = "RGBA"
    mixed.inputs[6].default_value, mixed.inputs[7].default_value = BOTH
    link(tree, asked.outputs[output], mixed.inputs[0])
    link(tree, mixed.outputs[2], tree.nodes["Emission"].inputs["Color"])
    return made


def judged(room, scene: bpy.types.Scene) -> float:
    """PSNR of the lit reflection against Cycles."""
    scene.render.engine, scene.world = "CYCLES", scene.world or bpy.data.worlds.new("World")
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.samples, scene.cycles.use_denoising = 64, False
    reference = picture(room)
    result = parts.generate()
    if room("addon.lighting").needs_light(result):
        assert bpy.ops.reflection_mesh.light(samples=64) == {"FINISHED"}
    return psnr(picture(room), reference)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ASKED)
def test_what_emits_by_the_ray_the_side_or_the_object_is_lit(blank, room, kind):
    emitting(kind)
    # measured: 67.7 to 75.0 dB
    assert judged(room, blank.scene) > 66.0
    assert bpy.data.objects["Mirror Reflection"].reflection_mesh.light_material is not None


@pytest.mark.thorough
@pytest.mark.parametrize("kind", CARRIED)
def test_what_emits_by_what_a_reflection_carries_is_right_without(blank, room, kind):
    emitting(kind)
    # measured: 94.3 dB and more
    assert judged(room, blank.scene) > 80.0
    assert bpy.data.objects["Mirror Reflection"].reflection_mesh.light_material is None


@pytest.mark.thorough
def test_fog_before_what_emits_is_in_its_light(blank, room):
    emitting("UV")
    world = blank.scene.world = bpy.data.worlds.new("Air")
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    fog = world.node_tree.nodes.new("ShaderNodeVolumeAbsorption")
    fog.inputs["Density"].default_value, fog.inputs["Color"].default_value = 0.2, (0.0, 0.0, 0.0, 1.0)
    link(world.node_tree, fog.outputs[0], world.node_tree.get_output_node("ALL").inputs["Volume"])
    # measured: 37.8 dB: sharp patterns lie between texels
    assert judged(room, blank.scene) > 37.5
