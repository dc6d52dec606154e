"""What mirrors of all colours make of light, and what colour it has where it falls."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from caustic_scene import light_and_lamp_behind, paint, ratios, rendered, scene_of


def coated(colour=(1.0, 0.5, 0.2), ior: float = 1.33, over: bool = True) -> bpy.types.Material:
    """A mirror that is mixed by Fresnel with black, as water over a dark ground."""
    made = paint("Coat", "GLOSSY", colour)
    tree = made.node_tree
    share, both, ground = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("Fresnel", "MixShader", "BsdfDiffuse"))
    share.inputs["IOR"].default_value, ground.inputs["Color"].default_value = ior, (0.0, 0.0, 0.0, 1.0)
    tree.links.new(share.outputs[0], both.inputs[0])
    tree.links.new(tree.nodes[0].outputs[0], both.inputs[2 if over else 1])
    tree.links.new(ground.outputs[0], both.inputs[1 if over else 2])
    tree.links.new(both.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    return made


def seen_of_white_world(scene: bpy.types.Scene, material: bpy.types.Material, angle: float, tmp_path,
                        behind: bool = False) -> tuple:
    """A mirror of that material over a black ground, and its picture of a white world, seen at an angle, or its
    back's."""
    scene.render.engine, scene.view_settings.view_transform = "CYCLES", "Raw"
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.cycles.use_denoising, scene.cycles.blur_glossy = False, 0.0
    scene.world = bpy.data.worlds.new("White")
    if bpy.app.version < (5, 0, 0):
        scene.world.use_nodes = True
    background = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    mirror = parts.add("plane", "Mirror", size=100.0, rotation=(np.pi * behind, 0.0, 0.0))
    mirror.data.materials.append(material)
    ground = parts.add("plane", "Ground", size=100.0, location=(0.0, 0.0, -0.5))
    ground.data.materials.append(paint("Black", "DIFFUSE", (0.0, 0.0, 0.0)))
    camera = scene.camera
    camera.data.type, camera.data.ortho_scale = "ORTHO", 1.0
    camera.location = (0.0, -3.0 * np.sin(angle), 3.0 * np.cos(angle))
    camera.rotation_euler = (angle, 0.0, 0.0)
    return mirror, rendered(tmp_path, 64).mean(axis=(0, 1))


@pytest.mark.parametrize("over", [True, False])
@pytest.mark.parametrize("angle", [0.0, 0.9, 1.35])
def test_water_sends_back_what_cycles_says(blank, room, tmp_path, over, angle):
    mirror, seen = seen_of_white_world(blank.scene, coated(over=over), angle, tmp_path)
    tint = room("addon.illumination").Tint.of(mirror)
    found = tint.at(np.full((1, 3), np.cos(angle)))[0, 0]
    assert tint.constant and np.allclose(found, seen, rtol=0.05 if over else 0.01, atol=0.002)


def shader_alone(kind: str, **values) -> bpy.types.Material:
    made = parts.material("Pane", "PRINCIPLED")
    tree = made.node_tree
    shader = tree.nodes.new(kind)
    for name, value in {"Roughness": 0.0, **values}.items():
        shader.inputs[name].default_value = value
    tree.links.new(shader.outputs[0], tree.get_output_node("ALL").inputs["Surface"])
    return made


def by_layer_weight(output: str = "Fresnel", blend: float = 0.4) -> bpy.types.Material:
    made = coated(over=True)
    tree = made.node_tree
    weight = tree.nodes.new("ShaderNodeLayerWeight")
    weight.inputs["Blend"].default_value = blend
    tree.links.new(weight.outputs[output], next(n for n in tree.nodes if n.type == "MIX_SHADER").inputs[0])
    return made


def two_mirrors(kind: str, *, grouped: bool = False, factor: float = 0.3) -> bpy.types.Material:
    """A red mirror and a green one, mixed or added; in a group that is given its first colour and its roughness."""
    made = paint("Two", "GLOSSY", (0.6, 0.1, 0.1))
    tree = made.node_tree
    end = tree.get_output_node("ALL").inputs["Surface"]
    if grouped:
        inner = bpy.data.node_groups.new("Chrome", "ShaderNodeTree")
        for name, side, sort in (("Paint", "INPUT", "Color"), ("Rough", "INPUT", "Float"), ("Out", "OUTPUT", "Shader")):
            inner.interface.new_socket(name, in_out=side, socket_type=f"NodeSocket{sort}")
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
        node.inputs["Paint"].default_value = (0.6, 0.1, 0.1, 1.0)
        tree.links.new(node.outputs[0], end)
        tree, end = inner, inner.nodes.new("NodeGroupOutput").inputs[0]
    both, *mirrors = (tree.nodes.new(f"ShaderNode{name}") for name in (kind, "BsdfAnisotropic", "BsdfAnisotropic"))
    for mirror, colour, socket in zip(mirrors, ((0.6, 0.1, 0.1), (0.1, 0.3, 0.05)), both.inputs[-2:], strict=True):
        mirror.inputs["Roughness"].default_value, mirror.inputs["Color"].default_value = 0.0, (*colour, 1.0)
        tree.links.new(mirror.outputs[0], socket)
    if grouped:
        given = tree.nodes.new("NodeGroupInput")
        mirrors[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        mirrors[0].inputs["Roughness"].default_value = 0.5
        tree.links.new(given.outputs["Paint"], mirrors[0].inputs["Color"])
        tree.links.new(given.outputs["Rough"], mirrors[0].inputs["Roughness"])
    if kind == "MixShader":
        both.inputs[0].default_value = factor
    tree.links.new(both.outputs[0], end)
    return made


def half_of(material: bpy.types.Material) -> bpy.types.Material:
    """Mixed with black by halves."""
    tree = material.node_tree
    end = tree.get_output_node("ALL").inputs["Surface"]
    both, ground = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeBsdfDiffuse")
    ground.inputs["Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.new(end.links[0].from_socket, both.inputs[1])
    tree.links.new(ground.outputs[0], both.inputs[2])
    tree.links.new(both.outputs[0], end)
    return material


def conductor() -> bpy.types.Material:
    """Gold, by its index (M. Polyanskiy, refractiveindex.info, at 640, 540 and 450 nm)."""
    material = shader_alone("ShaderNodeBsdfMetallic")
    node = next(one for one in material.node_tree.nodes if one.type == "BSDF_METALLIC")
    node.fresnel_type = "PHYSICAL_CONDUCTOR"
    for name, values in (("IOR", (0.18, 0.42, 1.47)), ("Extinction", (3.4, 2.35, 1.95)), ("Roughness", 0.0)):
        node.inputs[name].default_value = values
    return material


def lacquered(rough: float, metallic: float = 1.0) -> bpy.types.Material:
    return shader_alone("ShaderNodeBsdfPrincipled", **{
        "Base Color": (0.7, 0.3, 0.02, 1.0) if metallic else (0.0, 0.0, 0.0, 1.0), "Metallic": metallic,
        "Coat Weight": 0.8, "Coat Roughness": rough, "Coat IOR": 1.8})


NOT_METAL = {
    "mirrors added": lambda: two_mirrors("AddShader"),
    "mirrors mixed": lambda: two_mirrors("MixShader"),
    "mirrors in a group": lambda: two_mirrors("AddShader", grouped=True),
    "mix in a mix": lambda: half_of(two_mirrors("MixShader", grouped=True)),
    "water in a mix": lambda: half_of(coated()),
    "lacquered metal": lambda: lacquered(0.0),
    "lacquered lacquer": lambda: lacquered(0.0, metallic=0.0),
    "glass": lambda: shader_alone("ShaderNodeBsdfGlass", IOR=1.6),
    "pane": lambda: shader_alone("ShaderNodeBsdfPrincipled", **{"Transmission Weight": 1.0, "Metallic": 0.0}),
    "lacquer": lambda: shader_alone("ShaderNodeBsdfPrincipled", **{
        "Base Color": (0.0, 0.0, 0.0, 1.0), "Metallic": 0.0, "Specular IOR Level": 0.8}),
    "coat": lambda: shader_alone("ShaderNodeBsdfPrincipled", **{
        "Base Color": (0.0, 0.0, 0.0, 1.0), "Metallic": 0.0, "Specular IOR Level": 0.0, "Roughness": 0.6,
        "Coat Weight": 0.7, "Coat Roughness": 0.0}),
    "part metal": lambda: shader_alone("ShaderNodeBsdfPrincipled", **{
        "Base Color": (0.9, 0.5, 0.2, 1.0), "Metallic": 0.5, "Transmission Weight": 1.0}),
    "water": coated,
    "layer weight": by_layer_weight,
    "facing": lambda: by_layer_weight("Facing"),
    "facing more": lambda: by_layer_weight("Facing", 0.8),
    "open": lambda: shader_alone("ShaderNodeBsdfPrincipled", **{
        "Base Color": (0.9, 0.5, 0.2, 1.0), "Metallic": 1.0, "Alpha": 0.3})}
if hasattr(bpy.types, "ShaderNodeBsdfMetallic"):  # from Blender 4.3 on
    NOT_METAL["conductor"] = conductor


# what is metal and glass in parts is met from outside
@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "behind"), [(kind, behind) for kind in NOT_METAL for behind in (False, True)
                                              if not (behind and kind == "part metal")])
@pytest.mark.parametrize("angle", [0.0, 0.9, 1.2])
def test_what_is_no_metal_sends_back_what_cycles_says(blank, room, tmp_path, kind, angle, behind):
    """It threw all of the light; and backs as fronts, at which glass and water send back what comes from within."""
    mirror, seen = seen_of_white_world(blank.scene, NOT_METAL[kind](), angle, tmp_path, behind)
    mirror.reflection_mesh.role = "MIRROR"
    tint = room("addon.illumination").Tint.of(mirror)
    found = tint.at(np.full((1, 3), np.cos(angle) * (-1.0 if behind else 1.0)))[0, 0]
    assert tint.constant and np.allclose(found, seen, rtol=0.05, atol=0.004)


@pytest.mark.parametrize("grouped", [False, True])
def test_cycles_caustics_of_mixed_mirrors_are_left_out(blank, capfd, grouped):
    """As far as nothing of them is lit, which would be dark without the lamp: that is told."""
    floor, mirror, lamp = scene_of(shadow_soft_size=0.1)
    for material, alone in ((two_mirrors("MixShader", grouped=grouped), True),
                            (half_of(two_mirrors("AddShader", grouped=grouped)), False)):
        mirror.data.materials[0] = material
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert (lamp.light_linking.receiver_collection is not None) == alone
        assert ("which is lit as well as it mirrors" in capfd.readouterr().out) == (not alone)
        assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}


def test_light_that_meets_water_from_below_is_thrown_as_such(blank):
    """A mirror that turns its back to the lamp, so small that light meets it at one angle."""
    floor, mirror, lamp = scene_of()
    mirror.data.materials[0], mirror.reflection_mesh.role = coated(ior=2.0), "MIRROR"
    mirror.scale, thrown = (0.02, 0.02, 0.02), []
    for turn in (-0.5, 0.5):
        mirror.rotation_euler = (0.0, np.pi * turn, 0.0)
        blank.view_layer.update()
        parts.select(floor, lamp, mirror)
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        mesh = bpy.data.objects["Mirror Caustics"].data
        light = np.empty(9 * len(mesh.polygons), dtype=np.float32)
        mesh.attributes["caustic_light"].data.foreach_get("vector", light)
        thrown.append(np.array([face.area for face in mesh.polygons]) @ light.reshape(-1, 9).mean(axis=1))
    way = mirror.location - lamp.location
    c = way.x / way.length
    # Fresnel's equations, with Snell's law
    inner = [np.sqrt(1.0 - (1.0 - c * c) / index**2) for index in (2.0, 0.5)]
    sent = [0.5 * (((c - n * t) / (c + n * t))**2 + ((n * c - t) / (n * c + t))**2)
            for n, t in zip((2.0, 0.5), inner)]
    assert sent[1] > 1.5 * sent[0]
    assert abs(thrown[1] / thrown[0] / (sent[1] / sent[0]) - 1.0) < 0.01


def textured(floor: bpy.types.Object, kind: str, coordinates: str, grouped: bool) -> None:
    """The floor's colour by a procedural texture, laid out by its own box or by what it takes without being told."""
    tree = floor.active_material.node_tree
    colour = tree.nodes[0].inputs["Color"]
    if grouped:
        group = bpy.data.node_groups.new("Pattern", "ShaderNodeTree")
        group.interface.new_socket("Color", in_out="OUTPUT", socket_type="NodeSocketColor")
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        tree.links.new(node.outputs[0], colour)
        tree, colour = group, group.nodes.new("NodeGroupOutput").inputs[0]
    texture = tree.nodes.new(f"ShaderNodeTex{kind}")
    texture.inputs["Scale"].default_value = 9.0 if coordinates != "Object" else 1.5
    if coordinates:
        place = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(place.outputs[coordinates], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], colour)


@pytest.mark.thorough
@pytest.mark.parametrize(("kind", "coordinates", "grouped"), [
    ("Noise", "Generated", False), ("Noise", "Object", False), ("Voronoi", "", False), ("Noise", "Object", True)])
def test_textures_lie_where_the_receiver_has_them(blank, tmp_path, capfd, kind, coordinates, grouped):
    """As those of the floor in the light of the lamp behind the mirror."""
    floor, mirror, lamp = scene_of()
    # no plane of 20 units whose corners are its box's
    floor.location, floor.rotation_euler, floor.scale = (0.7, -0.4, 0.0), (0.0, 0.0, 0.5), (0.3, 0.2, 1.0)
    textured(floor, kind, coordinates, grouped)
    blank.view_layer.update()
    blank.scene.cycles.max_bounces = 0
    data = parts.state()["data"]
    light, expected = light_and_lamp_behind(mirror, lamp, tmp_path)
    assert "not known" not in capfd.readouterr().out
    ratio, there = ratios(light, expected)
    assert len(ratio) > 500 and np.ptp(np.log(there)) > 0.5
    assert np.abs(np.median(ratio, axis=0) - 1.0).max() < 5e-3
    assert np.percentile(np.abs(ratio - 1.0), 90) < 0.05
    assert bpy.ops.reflection_mesh.clear() == {"FINISHED"}
    assert parts.state()["data"] == data


def test_what_only_the_object_knows_is_told(blank, capfd):
    floor, mirror, lamp = scene_of()
    tree = floor.active_material.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeObjectInfo").outputs["Color"], tree.nodes[0].inputs["Color"])
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    assert "The colour of 'Paint' is not known all over" in capfd.readouterr().out


@pytest.mark.thorough
def test_a_mirror_of_several_colours(blank, tmp_path, capfd):
    """Each of its materials throws its own: as the two halves of the mirror alone, seam included."""
    floor, mirror, lamp = scene_of()
    mesh = mirror.data
    mesh.clear_geometry()
    mesh.from_pydata([(x, y, 0.0) for y in (-0.6, 0.1, 0.6) for x in (-0.6, 0.6)], [], [(0, 1, 3, 2), (2, 3, 5, 4)])
    mesh.materials.append(paint("Blue Metal", "PRINCIPLED", (0.1, 0.3, 0.9), "Base Color"))
    mesh.polygons[1].material_index = 1
    blank.scene.cycles.max_bounces = 0

    def light() -> np.ndarray:
        parts.select(floor, lamp, mirror)
        assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
        assert "counts as one" not in capfd.readouterr().out
        lamp.hide_render = True
        # the borders of the halves are in the middle of pixels
        seen = rendered(tmp_path, 256)
        lamp.hide_render = False
        bpy.ops.reflection_mesh.clear()
        return seen
    both, halves = light(), []
    keep = mesh.copy()
    for own in (0, 1):
        mirror.data = keep.copy()
        corners = [tuple(face.vertices) for face in keep.polygons]
        places = [tuple(vertex.co) for vertex in keep.vertices]
        mirror.data.clear_geometry()
        mirror.data.from_pydata(places, [], [corners[own]])
        mirror.data.polygons[0].material_index = own
        halves.append(light())
    lit = both.sum(axis=2) > 0.2 * both.sum(axis=2).max()
    assert lit.sum() > 500 and (halves[0][lit].sum(axis=1) > 0.0).any() and (halves[1][lit].sum(axis=1) > 0.0).any()
    assert np.abs(both - sum(halves))[lit].max() < 0.02 * both.max()
    assert np.percentile(np.abs(both - sum(halves))[lit], 95) < 1e-3 * both.max()
