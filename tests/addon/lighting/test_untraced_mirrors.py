"""Light without any mirror traced: what is shaded are the sources, and the world along reflected directions."""
from __future__ import annotations

import bpy
import bmesh
import numpy as np
import parts
import pytest
from lamp_scenes import SIZE, link, picture, principled, psnr, scene_of, shine


def light_images() -> list[np.ndarray]:
    """The picture of light, and that for other programs."""
    return [np.array(bpy.data.images[name].pixels[:]) for name in ("Reflection Light", "Reflection Light Export")]


@pytest.mark.parametrize("mirror", ["Tint", "Half open", "Pane", "Fresnel"])
def test_light_is_the_same_if_no_ray_of_camera_or_gloss_meets_mirrors(blank, mirror):
    wall = scene_of(blank, "UV", mirror)
    # else light that bounces off the mirror is another
    for name in ("Box", "Floor"):
        bpy.data.objects[name].data.materials.clear()
        bpy.data.objects[name].data.materials.append(parts.material("Paint", "DIFFUSE"))
    wall.visible_diffuse = wall.visible_shadow = False
    found = []
    for seen in (True, False):
        wall.visible_camera = wall.visible_glossy = wall.visible_transmission = seen
        parts.select(bpy.data.objects["Box"], bpy.data.objects["Floor"], wall)
        parts.generate()
        bpy.ops.reflection_mesh.light(samples=4)
        found.append(light_images())
        bpy.ops.reflection_mesh.clear()
    for one, other in zip(*found):
        np.testing.assert_array_equal(one, other)


def test_a_render_of_a_lit_file_needs_no_mirror(blank, room):
    """The sky of a gradient, that a ball shows beside what is reflected, is on faces of the reflection."""
    scene_of(blank)
    shine(blank.scene)
    for name in ("Mirror", "Floor"):
        bpy.data.objects.remove(bpy.data.objects[name])
    ball = parts.add("uv_sphere", "Ball", radius=1.6, segments=48, ring_count=24, location=(0.0, 1.0, 1.0))
    ball.data.shade_smooth()
    ball.data.materials.append(bpy.data.materials["Silver"])
    parts.select(bpy.data.objects["Box"], ball)
    reference, other = picture(room), picture(room, seed=7)
    result = parts.generate()
    assert (parts.attribute(result, "source_object") >= 0).all()
    bpy.ops.reflection_mesh.light(samples=64)
    assert (parts.attribute(result, "source_object") == -1).any()
    ball.hide_render = True
    assert psnr(picture(room), reference) > psnr(other, reference) - 1.5


def test_mirrors_show_the_world_that_other_mirrors_show(blank, room):
    """A gold and a blue wall that meet in a corner, under a world whose colour is the direction."""
    walls = [parts.add("plane", "Gold", size=4.0, location=(0.0, 2.0, 1.2), rotation=(np.pi / 2, 0.0, 0.0)),
             parts.add("plane", "Blue", size=4.0, location=(2.0, 0.0, 1.2), rotation=(0.0, -np.pi / 2, 0.0))]
    for wall, colour in zip(walls, ((0.9, 0.6, 0.2), (0.3, 0.5, 0.9))):
        wall.data.materials.append(principled(wall.name, colour, Metallic=1.0, Roughness=0.0))
    ball = parts.add("uv_sphere", "Ball", radius=0.5, location=(0.4, -0.2, 1.0))
    ball.data.materials.append(parts.material("Shine"))
    scene = blank.scene
    scene.camera.location, scene.camera.rotation_euler = (-1.8, -5.0, 2.2), (1.35, 0.0, -0.38)
    scene.render.engine, scene.cycles.samples, scene.cycles.use_denoising = "CYCLES", 32, False
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.world = bpy.data.worlds.new("World")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    tree = scene.world.node_tree
    half = tree.nodes.new("ShaderNodeVectorMath")
    half.operation, half.inputs[1].default_value, half.inputs[2].default_value = "MULTIPLY_ADD", (0.5,) * 3, (0.5,) * 3
    link(tree, tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], half.inputs[0])
    link(tree, half.outputs[0], next(node for node in tree.nodes if node.type == "BACKGROUND").inputs["Color"])
    parts.select(ball, *walls)
    reference, other = picture(room), picture(room, seed=7)
    parts.generate(depth=2)
    parts.select(*(obj for obj in scene.objects if obj.reflection_mesh.role == "REFLECTION"))
    bpy.ops.reflection_mesh.light(samples=32)
    for wall in walls:
        wall.hide_render = True
    assert psnr(picture(room), reference) > psnr(other, reference)


def test_what_is_deleted_from_a_lit_reflection_leaves_nothing_behind(blank, room):
    """The box, in front of a floor whose light lies behind it."""
    wall = scene_of(blank, "UV", "Tint")
    box = bpy.data.objects["Box"]
    box.visible_glossy = False
    reference, other = picture(room), picture(room, seed=7)
    box.visible_glossy = True
    parts.select(box, bpy.data.objects["Floor"], wall)
    result = parts.generate(hidden_faces=True)
    bpy.ops.reflection_mesh.light(samples=64)
    number = [source.object for source in result.reflection_mesh.sources].index(box)
    work = bmesh.new()
    work.from_mesh(result.data)
    layer = work.faces.layers.int["source_object"]
    bmesh.ops.delete(work, geom=[face for face in work.faces if face[layer] == number], context="FACES")
    work.to_mesh(result.data)
    work.free()
    assert psnr(picture(room), reference) > psnr(other, reference) - 3.0
