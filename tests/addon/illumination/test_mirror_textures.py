"""Colours that change over mirrors, in the light that these throw, and light that has met several mirrors."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import AIM, TINT, aim, light_of_mirror, paint, ratios, rendered, scene_of


def stained(mirror: bpy.types.Object, kind: str) -> None:
    """A colour over the mirror by a texture."""
    tree = mirror.active_material.node_tree
    if kind.startswith("stored"):
        painted(mirror, tree, kind)
        return
    node = {"UV image": "Image", "box": "Image", "named map": "Checker", "Object": "Checker"}.get(kind, "Noise")
    if kind == "named map":
        layer = mirror.data.uv_layers.new(name="Second")
        layer.uv.foreach_set("vector", np.array([0.1, 0.2, 0.8, 0.1, 0.9, 0.7, 0.3, 0.9], dtype=np.float32))
    target = tree.nodes[0].inputs["Color"]
    if kind == "normals":
        target = by_normals(tree, target)
    if kind == "group":
        group = bpy.data.node_groups.new("Stain", "ShaderNodeTree")
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        holder = tree.nodes.new("ShaderNodeGroup")
        holder.node_tree = group
        tree.links.new(holder.outputs[0], target)
        tree, target = group, group.nodes.new("NodeGroupOutput").inputs[0]
    texture = tree.nodes.new(f"ShaderNodeTex{node}")
    if node == "Image":
        image = bpy.data.images.new("Stain", 4, 4)
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set(np.random.default_rng(3).uniform(0.1, 1.0, 64).astype(np.float32))
        texture.image, texture.interpolation = image, "Linear"
        if kind == "box":
            texture.projection, texture.projection_blend = "BOX", 0.3
            tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Object"], texture.inputs["Vector"])
    else:
        texture.inputs["Scale"].default_value = 3.0
    if node == "Checker":
        for name, colour in (("Color1", (1.0, 0.2, 0.1, 1.0)), ("Color2", (0.2, 0.9, 1.0, 1.0))):
            texture.inputs[name].default_value = colour
        place = tree.nodes.new("ShaderNodeUVMap" if kind == "named map" else "ShaderNodeTexCoord")
        if kind == "named map":
            place.uv_map = "Second"
        tree.links.new(place.outputs[0 if kind == "named map" else "Object"], texture.inputs["Vector"])
    colour = texture.outputs["Color"]
    if kind == "ramp and curves":
        ramp, curves, mix = (tree.nodes.new(f"ShaderNode{name}") for name in ("ValToRGB", "RGBCurve", "Mix"))
        ramp.color_ramp.elements[0].position, ramp.color_ramp.elements[0].color = 0.4, (0.9, 0.1, 0.2, 1.0)
        ramp.color_ramp.elements.new(0.5).color = (0.1, 0.8, 0.9, 1.0)
        curves.mapping.curves[3].points.new(0.5, 0.8)
        curves.mapping.update()
        mix.data_type, mix.blend_type, mix.inputs[0].default_value = "RGBA", "MULTIPLY", 0.7
        mix.inputs[7].default_value = (1.0, 0.5, 0.8, 1.0)
        for first, second in ((texture.outputs[0], ramp.inputs[0]), (ramp.outputs[0], curves.inputs["Color"]),
                              (curves.outputs[0], mix.inputs[6])):
            tree.links.new(first, second)
        colour = mix.outputs[2]
    tree.links.new(colour, target)


def by_normals(tree: bpy.types.NodeTree, target: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """A colour by the mirror's normal, to the side that is seen; and the socket for a pattern that it is to have."""
    half, mixed = tree.nodes.new("ShaderNodeVectorMath"), tree.nodes.new("ShaderNodeMix")
    half.operation = "MULTIPLY_ADD"
    half.inputs[1].default_value, half.inputs[2].default_value = 3 * (0.3,), 3 * (0.6,)
    mixed.data_type, mixed.blend_type, mixed.inputs[0].default_value = "RGBA", "MULTIPLY", 1.0
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Normal"], half.inputs[0])
    tree.links.new(half.outputs[0], mixed.inputs[6])
    tree.links.new(mixed.outputs[2], target)
    return mixed.inputs[7]


def painted(mirror: bpy.types.Object, tree: bpy.types.NodeTree, kind: str) -> None:
    """A colour over the mirror that is stored on its mesh."""
    rng, target = np.random.default_rng(5), tree.nodes[0].inputs["Color"]
    if kind == "stored numbers":
        mirror.data.attributes.new("Age", "FLOAT", "POINT").data.foreach_set("value", rng.uniform(0.1, 0.9, 4))
        age, ramp = tree.nodes.new("ShaderNodeAttribute"), tree.nodes.new("ShaderNodeValToRGB")
        age.attribute_name = "Age"
        ramp.color_ramp.elements[0].color = (0.9, 0.1, 0.2, 1.0)
        tree.links.new(age.outputs["Fac"], ramp.inputs[0])
        tree.links.new(ramp.outputs[0], target)
        return
    colours = mirror.data.color_attributes.new("Shade", *(
        ("BYTE_COLOR", "POINT") if kind == "stored active colour" else ("FLOAT_COLOR", "CORNER")))
    colours.data.foreach_set("color", rng.uniform(0.1, 1.0, 16).astype(np.float32))
    shade = tree.nodes.new("ShaderNodeVertexColor" if kind == "stored active colour" else "ShaderNodeAttribute")
    if kind == "stored active colour":
        tree.links.new(shade.outputs["Color"], target)
        return
    shade.attribute_name = "Shade"
    # a colour's brightness, which is not the mean of its parts
    grey = tree.nodes.new("ShaderNodeMath")
    tree.links.new(shade.outputs["Color"], grey.inputs[0])
    grey.inputs[1].default_value = 0.1
    tree.links.new(grey.outputs[0], target)


def as_a_window(mirror: bpy.types.Object) -> None:
    """Let the mirror's colour be that of what passes through it."""
    tree = mirror.active_material.node_tree
    clear = tree.nodes.new("ShaderNodeBsdfTransparent")
    tree.links.new(tree.nodes[0].inputs["Color"].links[0].from_socket, clear.inputs["Color"])
    tree.links.new(clear.outputs[0], tree.get_output_node("ALL").inputs["Surface"])


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["UV image", "named map", "Object", "Generated", "group", "ramp and curves",
                                  "box", "box behind", "normals", "normals behind",
                                  "stored colour", "stored active colour", "stored numbers"])
def test_a_stained_mirror_throws_its_picture(blank, tmp_path, capfd, kind):
    """As light that comes from behind through a window of the same stain."""
    floor, mirror, lamp = scene_of()
    stained(mirror, kind.removesuffix(" behind"))
    if kind.endswith("behind"):
        mirror.rotation_euler = (0.0, np.pi / 2, 0.0)
    blank.view_layer.update()
    blank.scene.cycles.max_bounces = 0
    data = parts.state()["data"]
    light = light_of_mirror(tmp_path)
    assert "counts as one" not in capfd.readouterr().out
    as_a_window(mirror)
    place = lamp.location.copy()
    aim(lamp, (2.0 * AIM.x + 0.9, 0.1, 1.8))
    expected = rendered(tmp_path, 64)
    aim(lamp, place)
    ratio, there = ratios(light, expected)
    assert len(ratio) > 300 and np.ptp(np.log(there), axis=0).max() > 0.5
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 5e-3
    # pixels across edges of a chequered stain have their own samples
    assert np.percentile(np.abs(ratio - 1.0), 80) < 0.05
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    mirror.active_material.node_tree.nodes.remove(mirror.active_material.node_tree.nodes["Transparent BSDF"])
    assert parts.state()["data"] == data


def test_a_mirror_in_a_frame_throws_its_own_picture(blank, tmp_path):
    """Faces that do not mirror come first."""
    floor, mirror, lamp = scene_of()
    stained(mirror, "Object")
    blank.scene.cycles.max_bounces = 0
    alone = light_of_mirror(tmp_path)
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    places = np.array([vertex.co for vertex in mirror.data.vertices])[mirror.data.polygons[0].vertices]
    framed = bpy.data.meshes.new("Framed")
    framed.from_pydata([*places[:, ::-1] + (0.0, 9.0, 0.0), *places[:, ::-1] + (0.0, 7.0, 0.0), *places], [],
                       [(0, 1, 2, 3), (4, 5, 6, 7), (8, 9, 10, 11)])
    for material in (paint("Wood", "DIFFUSE", (0.1, 0.1, 0.1)), mirror.active_material):
        framed.materials.append(material)
    framed.polygons.foreach_set("material_index", [0, 0, 1])
    mirror.data = framed
    ratio, _ = ratios(light_of_mirror(tmp_path), alone)
    assert len(ratio) > 300 and np.percentile(np.abs(ratio - 1.0), 95) < 1e-3


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["PRINCIPLED", "coated", "GLASS"])
def test_a_mirror_that_is_open_in_part_throws_as_much_less(blank, tmp_path, kind):
    """What comes through it is not thrown."""
    floor, mirror, lamp = scene_of()
    material = paint("Metal", "PRINCIPLED", (0.9, 0.6, 0.3), "Base Color")
    shader = material.node_tree.nodes[0]
    shader.inputs["Roughness"].default_value = 1.0 if kind == "coated" else 0.0
    shader.inputs["Coat Weight"].default_value = float(kind == "coated")
    shader.inputs["Metallic"].default_value = float(kind == "PRINCIPLED")
    shader.inputs["Transmission Weight"].default_value = float(kind == "GLASS")
    mirror.data.materials[0], mirror.reflection_mesh.role = material, "MIRROR"
    blank.scene.cycles.max_bounces = 0
    whole = light_of_mirror(tmp_path)
    shader.inputs["Alpha"].default_value = 0.4
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    ratio, _ = ratios(light_of_mirror(tmp_path), whole)
    assert len(ratio) > 300 and np.allclose(ratio, 0.4, rtol=2e-3)


def test_what_only_the_mirror_knows_is_told(blank, capfd):
    floor, mirror, lamp = scene_of()
    tree = mirror.active_material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeObjectInfo").outputs["Color"], tree.nodes[0].inputs["Color"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "counts as one" in capfd.readouterr().out


def test_light_grows_with_the_colour_as_with_fresnel(room):
    """What a texture's colour makes of a metal's light is its plain light and as much more as the colour is."""
    tint = room("addon.illumination").Tint.of_material(paint("Gold", "PRINCIPLED", (0.2, 0.5, 0.7), "Base Color"))
    other = room("addon.illumination").Tint.of_material(paint("Blue", "PRINCIPLED", (0.9, 0.1, 0.4), "Base Color"))
    cosine = np.linspace(0.0, 1.0, 30)
    grown = tint.at(cosine) + tint.by_colour(cosine) * (np.array((0.9, 0.1, 0.4)) - (0.2, 0.5, 0.7))
    assert np.allclose(grown, other.at(cosine), atol=1e-12)


@pytest.mark.thorough
@pytest.mark.parametrize("kind", ["GLOSSY", "PRINCIPLED"])
def test_every_mirror_on_the_way_leaves_its_colour(blank, room, kind):
    """A mirror throws light on a second one, of another metal, at an angle of its own, and that on the floor."""
    floor, mirror, lamp = scene_of()
    colour = (0.2, 0.7, 0.9)
    # leans over the floor, to which it sends what comes to it above
    second = parts.add("plane", "Second", size=6.0, location=(-2.2, 0.0, 2.0), rotation=(0.0, np.pi / 2 + 0.3, 0.0))
    second.data.materials.append(paint("Blue", kind, colour, "Color" if kind == "GLOSSY" else "Base Color"))
    for own in (mirror, second):
        own.reflection_mesh.role = "MIRROR"
    lamp.location = (-0.4, 0.1, 0.9)
    blank.view_layer.update()
    parts.select(floor, lamp, second, mirror)
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT", depth=2) == {"FINISHED"}
    result = next(obj for obj in bpy.data.objects if obj.reflection_mesh.role == "CAUSTICS"
                  and obj.reflection_mesh.mirror == mirror)
    mesh = result.data
    bounces, light = np.empty(len(mesh.polygons), dtype=np.int32), np.empty(9 * len(mesh.polygons), dtype=np.float32)
    mesh.attributes["bounces"].data.foreach_get("value", bounces)
    mesh.attributes["caustic_light"].data.foreach_get("vector", light)
    twice = np.flatnonzero((bounces == 2) & (light.reshape(-1, 9).min(axis=1) > 0.0))
    assert len(twice) > 10
    start, corners = np.empty(3 * len(mesh.vertices), dtype=np.float32), np.empty(len(mesh.loops), dtype=np.int32)
    mesh.attributes["mirror_position"].data.foreach_get("vector", start)
    mesh.loops.foreach_get("vertex_index", corners)
    corners = corners.reshape(-1, 3)[twice]
    start = start.reshape(-1, 3)[corners].astype(np.float64)
    # the first mirror is upright, across x
    way = start - np.array(lamp.location)
    way[..., 0] *= -1.0
    normal = np.array(second.matrix_world.to_3x3().col[2])
    cosine = np.abs(way @ normal) / np.linalg.norm(way, axis=2)
    left = np.array(colour) if kind == "GLOSSY" else np.array(colour) + (1.0 - np.array(colour)) * (
        1.0 - cosine[..., None])**5
    seen = light.reshape(-1, 3, 3)[twice] / (np.array(lamp.data.color) * TINT * left)
    assert np.allclose(seen / seen.mean(axis=2, keepdims=True), 1.0, atol=2e-3)
