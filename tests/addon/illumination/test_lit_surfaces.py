"""What light falls on: smooth normals, gloss and glass take as much of a mesh of light as of a lamp's own."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import ALBEDO, TINT, inner, light_and_lamp_behind, paint, rendered, scene_of


def on_a_ball(floor: bpy.types.Object, smooth: bool) -> None:
    """Let the light fall on a coarse ball instead of the floor."""
    ball = parts.add("uv_sphere", "Ball", segments=24, ring_count=12, radius=2.0)
    ball.data.polygons.foreach_set("use_smooth", [smooth] * len(ball.data.polygons))
    ball.data.materials.append(floor.active_material)
    floor.data, floor.location = ball.data, (0.0, 0.0, -2.0)
    bpy.data.objects.remove(ball)


@pytest.mark.thorough
@pytest.mark.parametrize("smooth", [False, True])
def test_smooth_faces_are_lit_smoothly(blank, tmp_path, smooth):
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    on_a_ball(floor, smooth)
    parts.select(floor, lamp, mirror)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    seen = inner(light) & (expected > 0.2 * np.percentile(expected, 95, axis=(0, 1))).all(axis=2)
    ratio = light[seen] / expected[seen]
    assert len(ratio) > 500
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 2e-3
    assert np.percentile(np.abs(ratio - 1.0), 90) < 0.01


def test_faces_that_are_bent_are_lit_as_their_triangles(blank, tmp_path):
    """A flat floor, one of whose corners is raised."""
    floor, mirror, lamp = scene_of("SPOT", spot_size=0.9)
    blank.scene.cycles.max_bounces = 0
    mirror.scale, floor.scale = (3.0, 3.0, 3.0), (0.15, 0.15, 1.0)
    floor.data.vertices[3].co.z = 0.7
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 1500
    assert np.percentile(np.abs(ratio - 1.0), 95) < 0.01


@pytest.mark.thorough
@pytest.mark.parametrize("targets", [("EEVEE", "CYCLES"), ("ALL", "CYCLES"), ("EEVEE", "ALL")], ids="+".join)
def test_of_outputs_for_each_engine_the_one_for_cycles_counts(blank, tmp_path, targets):
    """The last; the other one is a mirror's on the floor, and none on the mirror."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    for obj in (floor, mirror):
        tree = obj.active_material.node_tree
        shader, output = tree.nodes[0], tree.get_output_node("ALL")
        others = [tree.nodes.new("ShaderNodeOutputMaterial"), output]
        for node, target in zip(others, targets, strict=True):
            node.target = target
        if obj == floor:
            tree.links.new(tree.nodes.new("ShaderNodeBsdfAnisotropic").outputs[0], others[0].inputs["Surface"])
        assert output.inputs["Surface"].links[0].from_node == shader
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 500
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 2e-3


@pytest.mark.thorough
@pytest.mark.parametrize("tilt, values", [
    (0.0, {}), (1.1, {}), (1.1, {"Roughness": 1.0}), (1.1, {"Roughness": 0.1, "Specular IOR Level": 1.0}),
    (0.0, {"Transmission Weight": 0.5}), (1.1, {"Alpha": 0.3})], ids=str)
def test_what_gloss_and_glass_take_is_gone(blank, tmp_path, tilt, values):
    """Beside what Cycles has more of with the colour than without: its gloss is the same in both."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    floor.data.materials[0] = paint("Varnish", "PRINCIPLED", ALBEDO, "Base Color")
    shader = floor.active_material.node_tree.nodes[0]
    for name, value in {"Metallic": 0.0, "Roughness": 0.5, **values}.items():
        shader.inputs[name].default_value = value
    camera = blank.scene.camera
    camera.rotation_euler, camera.location = (tilt, 0.0, 0.0), (0.0, -6.0 * np.sin(tilt), 6.0 * np.cos(tilt))
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    shader.inputs["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    expected = expected - rendered(tmp_path, 64) * TINT
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 400
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 0.015


@pytest.mark.thorough
@pytest.mark.parametrize("linked", [False, True])
def test_metal_sends_no_light_back_by_its_colour(blank, tmp_path, linked):
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    floor.data.materials[0] = paint("Metal", "PRINCIPLED", ALBEDO, "Base Color")
    tree = floor.active_material.node_tree
    values = tree.nodes[0].inputs
    values["Roughness"].default_value, values["Specular IOR Level"].default_value = 1.0, 0.0
    values["Metallic"].default_value = 0.4
    if linked:
        value = tree.nodes.new("ShaderNodeValue")
        value.outputs[0].default_value = 0.4
        tree.links.new(value.outputs[0], values["Metallic"])
    dull = paint("Dull", "DIFFUSE", ALBEDO)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    result = bpy.data.objects["Mirror Caustics"]
    found = []
    for _ in range(2):
        lit = rendered(tmp_path)
        result.hide_render = True
        found.append(lit - rendered(tmp_path))
        result.hide_render = False
        floor.data.materials[0] = dull
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    seen = inner(found[1])
    assert np.abs(found[0][seen] / found[1][seen] - 0.6).max() < 1e-3


def half_open(tree: bpy.types.NodeTree, colour: bpy.types.Node) -> bpy.types.Node:
    return mixed(tree, 0.3, tree.nodes.new("ShaderNodeBsdfTransparent"), colour)


def varnished(tree: bpy.types.NodeTree, colour: bpy.types.Node) -> bpy.types.Node:
    gloss = tree.nodes.new("ShaderNodeBsdfAnisotropic")
    gloss.inputs["Roughness"].default_value = 0.5
    return mixed(tree, 0.2, colour, gloss)


def on_black(tree: bpy.types.NodeTree, colour: bpy.types.Node) -> bpy.types.Node:
    """Half of it, added to black."""
    both, black = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    black.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.new(mixed(tree, 0.5, black, colour).outputs[0], both.inputs[0])
    tree.links.new(black.outputs[0], both.inputs[1])
    return both


def mixed(tree: bpy.types.NodeTree, factor: float, first: bpy.types.Node, second: bpy.types.Node) -> bpy.types.Node:
    mix = tree.nodes.new("ShaderNodeMixShader")
    mix.inputs[0].default_value = factor
    tree.links.new(first.outputs[0], mix.inputs[1])
    tree.links.new(second.outputs[0], mix.inputs[2])
    return mix


@pytest.mark.thorough
@pytest.mark.parametrize("grouped", [False, True])
@pytest.mark.parametrize("mixture", [half_open, varnished, on_black])
def test_mixed_shaders_send_light_back_as_mixed(blank, capfd, tmp_path, mixture, grouped):
    """Beside what Cycles has more of with the colour than without, the lamp behind the mirror."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    material = floor.active_material
    tree = bpy.data.node_groups.new("Paint", "ShaderNodeTree") if grouped else material.node_tree
    colour = tree.nodes.new("ShaderNodeBsdfDiffuse")
    colour.inputs["Color"].default_value = (*ALBEDO, 1.0)
    surface = mixture(tree, colour).outputs[0]
    if grouped:
        tree.interface.new_socket("Other", in_out="OUTPUT", socket_type="NodeSocketShader")
        tree.interface.new_socket("Paint", in_out="OUTPUT", socket_type="NodeSocketShader")
        tree.links.new(surface, tree.nodes.new("NodeGroupOutput").inputs[1])
        node = material.node_tree.nodes.new("ShaderNodeGroup")
        node.node_tree = tree
        surface = node.outputs[1]
    material.node_tree.links.new(surface, material.node_tree.get_output_node("ALL").inputs["Surface"])
    groups = set(bpy.data.node_groups)
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    assert "is not known all over" not in capfd.readouterr().out
    colour.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    expected = expected - rendered(tmp_path, 64) * TINT
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 400
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 5e-3
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert set(bpy.data.node_groups) == groups


def muted_mix(tree: bpy.types.NodeTree, shader: bpy.types.Node) -> bpy.types.NodeSocket:
    mix = mixed(tree, 0.5, shader, tree.nodes.new("ShaderNodeBsdfTransparent"))
    mix.mute = True
    return mix.outputs[0]


def muted_link(tree: bpy.types.NodeTree, shader: bpy.types.Node) -> bpy.types.NodeSocket:
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Color"], shader.inputs["Color"]).is_muted = True
    return shader.outputs[0]


def muted_colour(tree: bpy.types.NodeTree, shader: bpy.types.Node) -> bpy.types.NodeSocket:
    """A muted node behind a colour, and another muted one behind that."""
    first, second = (tree.nodes.new("ShaderNodeInvert") for _ in range(2))
    known = tree.nodes.new("ShaderNodeRGB")
    known.outputs[0].default_value = shader.inputs["Color"].default_value
    tree.links.new(known.outputs[0], first.inputs["Color"])
    tree.links.new(first.outputs[0], second.inputs["Color"])
    tree.links.new(second.outputs[0], shader.inputs["Color"])
    first.mute = second.mute = True
    return shader.outputs[0]


@pytest.mark.thorough
@pytest.mark.parametrize("muted", [muted_mix, muted_link, muted_colour])
def test_what_is_muted_does_not_count(blank, tmp_path, muted):
    """Beside the lamp behind the mirror, whose light Cycles shows without it."""
    floor, mirror, lamp = scene_of()
    blank.scene.cycles.max_bounces = 0
    tree = floor.active_material.node_tree
    tree.links.new(muted(tree, tree.nodes[0]), tree.get_output_node("ALL").inputs["Surface"])
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    ratio = (light / np.maximum(expected, 1e-12))[inner(light)]
    assert len(ratio) > 500
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 2e-3


@pytest.mark.parametrize("finer", ["Floor", "Mirror", ""])
def test_another_mesh_in_renders_is_told(blank, capfd, finer):
    """The light lies on the viewport's, which renders do not show: it may be hidden below theirs."""
    scene_of()
    for name in ("Floor", "Mirror"):
        rounder = bpy.data.objects[name].modifiers.new("Rounder", "SUBSURF")
        rounder.levels, rounder.render_levels = 1, 1 + (name == finer)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    told = capfd.readouterr().out
    assert (f"another mesh of '{finer}' than viewports do, by 'Rounder'" in told) == bool(finer)
    assert ("another mesh" in told) == bool(finer)
