"""Scenes with a lamp before a mirror, what renders of them show, and all that light may change in a file."""
from __future__ import annotations

import bpy
import numpy as np
import parts
import pytest
from shown_nodes import fog, grooves, link, random_number_in_group, right_of_the_picture

SIZE = 96
SAMPLES = 128


def principled(name: str, colour=(0.8, 0.8, 0.8), **values) -> bpy.types.Material:
    """A lit material, rough where nothing else is said."""
    made = parts.material(name, "PRINCIPLED", 1.0, 0.0)
    shader = shader_of(made)
    for socket, value in {"Base Color": (*colour, 1.0), **values}.items():
        shader.inputs[socket].default_value = value
    return made


def tinted(name: str, colour: tuple[float, float, float]) -> bpy.types.Material:
    """A material that lets light through, and colours it."""
    made = parts.material(name, "PRINCIPLED", 1.0, 0.0)
    clear = made.node_tree.nodes.new("ShaderNodeBsdfTransparent")
    clear.inputs["Color"].default_value = (*colour, 1.0)
    link(made.node_tree, clear.outputs[0], made.node_tree.get_output_node("ALL").inputs["Surface"])
    return made


def shader_of(material: bpy.types.Material) -> bpy.types.Node:
    return next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")


def patterned(output: str, node: str = "ShaderNodeTexCoord") -> bpy.types.Material:
    """A material whose colour is noise by the coordinates `output` of a node."""
    made = principled("Pattern")
    tree = made.node_tree
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = 4.0
    link(tree, tree.nodes.new(node).outputs[output], noise.inputs["Vector"])
    link(tree, noise.outputs["Color"], shader_of(made).inputs["Base Color"])
    return made


def source_material(kind: str, box: bpy.types.Object) -> bpy.types.Material:
    """What the reflected object shows."""
    if kind in ("Generated", "Object", "Normal", "UV", "Camera", "Reflection"):
        return patterned(kind)
    if kind == "Gloss":
        return principled("Glossy", (0.7, 0.1, 0.1), Roughness=0.25)
    if kind == "Glass":
        return principled("Glass", (0.9, 1.0, 0.9), **{"Transmission Weight": 1.0, "Roughness": 0.0})
    made = principled("Source", (0.9, 0.3, 0.1))
    tree, shader = made.node_tree, shader_of(made)
    if kind == "Bump":
        bump, noise = tree.nodes.new("ShaderNodeBump"), tree.nodes.new("ShaderNodeTexNoise")
        bump.inputs["Distance"].default_value = 0.6
        link(tree, noise.outputs[0], bump.inputs["Height"])
        link(tree, bump.outputs[0], shader.inputs["Normal"])
    elif kind == "Normal map":
        link(tree, grooves(tree), shader.inputs["Normal"])
    elif kind == "View distance":
        # fog: what is far away is pale
        link(tree, fog(tree), shader.inputs["Base Color"])
    elif kind == "Light path":
        # dark but in mirrors
        link(tree, tree.nodes.new("ShaderNodeLightPath").outputs["Is Glossy Ray"], shader.inputs["Base Color"])
    elif kind == "Window":
        link(tree, right_of_the_picture(tree), shader.inputs["Base Color"])
    elif kind == "Random":
        ramp = tree.nodes.new("ShaderNodeCombineColor")
        link(tree, tree.nodes.new("ShaderNodeObjectInfo").outputs["Random"], ramp.inputs[1])
        link(tree, ramp.outputs[0], shader.inputs["Base Color"])
    elif kind == "Instances":
        ramp = tree.nodes.new("ShaderNodeCombineColor")
        ramp.mode, ramp.inputs[1].default_value, ramp.inputs[2].default_value = "HSV", 1.0, 1.0
        link(tree, random_number_in_group(tree), ramp.inputs[0])
        link(tree, ramp.outputs[0], shader.inputs["Base Color"])
    elif kind == "Attribute":
        heat = box.data.attributes.new("warmth", "FLOAT", "POINT")
        heat.data.foreach_set("value", np.linspace(0.0, 1.0, len(heat.data), dtype=np.float32))
        read = tree.nodes.new("ShaderNodeAttribute")
        read.attribute_name = "warmth"
        link(tree, read.outputs["Fac"], shader.inputs["Base Color"])
    elif kind == "Alpha":
        checks = tree.nodes.new("ShaderNodeTexChecker")
        checks.inputs["Scale"].default_value = 3.0
        link(tree, checks.outputs["Fac"], shader.inputs["Alpha"])
    elif kind == "Backfacing":
        side, mixed = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeMix")
        mixed.data_type = "RGBA"
        mixed.inputs[6].default_value, mixed.inputs[7].default_value = (0.9, 0.1, 0.1, 1.0), (0.1, 0.1, 0.9, 1.0)
        link(tree, side.outputs["Backfacing"], mixed.inputs[0])
        link(tree, mixed.outputs[2], shader.inputs["Base Color"])
    return made


def mirror_material(kind: str) -> bpy.types.Material:
    """What the mirror does to what it shows."""
    silver = principled("Silver", (0.95, 0.7, 0.35) if kind == "Tint" else (1.0, 1.0, 1.0), Metallic=1.0, Roughness=0.0)
    tree = silver.node_tree
    if kind == "Textured tint":
        checks = tree.nodes.new("ShaderNodeTexChecker")
        checks.inputs["Color1"].default_value, checks.inputs["Color2"].default_value = (1, .9, .5, 1), (.3, .5, .7, 1)
        link(tree, checks.outputs["Color"], shader_of(silver).inputs["Base Color"])
    elif kind == "Rough":
        shader_of(silver).inputs["Roughness"].default_value = 0.1
    elif kind == "Half open":
        shader_of(silver).inputs["Alpha"].default_value = 0.7
    elif kind == "Pane":
        shader_of(silver).inputs["Metallic"].default_value = 0.0
        shader_of(silver).inputs["Transmission Weight"].default_value = 1.0
    elif kind in ("Fresnel", "Layer weight"):
        share = tree.nodes.new("ShaderNodeFresnel" if kind == "Fresnel" else "ShaderNodeLayerWeight")
        ground, gloss, both = (tree.nodes.new(f"ShaderNode{name}") for name in ("BsdfDiffuse", "BsdfAnisotropic",
                                                                               "MixShader"))
        gloss.inputs["Roughness"].default_value, gloss.inputs["Color"].default_value = 0.0, (1.0, 1.0, 1.0, 1.0)
        ground.inputs["Color"].default_value = (0.1, 0.3, 0.2, 1.0)
        for output, socket in ((share.outputs[0], both.inputs[0]), (ground.outputs[0], both.inputs[1]),
                               (gloss.outputs[0], both.inputs[2])):
            link(tree, output, socket)
        link(tree, both.outputs[0], next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs[0])
    return silver


def scene_of(context: bpy.types.Context, source: str = "", mirror: str = "") -> bpy.types.Object:
    """A box or an open tube, where the camera sees its image beside itself, and a floor before a wall mirror, under a
    lamp; returns the mirror."""
    scene = context.scene
    if source == "Backfacing":
        box = parts.add("cylinder", "Box", radius=0.9, depth=1.2, end_fill_type="NOTHING", location=(1.9, -1.2, 1.0),
                        rotation=(0.9, 0.4, 0.3))
    else:
        box = parts.add("cube", "Box", size=1.3, location=(1.9, -1.2, 1.0), rotation=(0.3, 0.2, 0.5))
    box.data.materials.append(source_material(source, box))
    if source == "Instances":
        box = _instanced(box)
    floor = parts.add("plane", "Floor", size=8.0, location=(0.0, -1.0, -0.6))
    floor.data.materials.append(principled("Floor", (0.5, 0.5, 0.6)))
    wall = parts.add_wall_mirror()
    wall.data.materials.append(mirror_material(mirror))
    bpy.ops.object.light_add(type="AREA", location=(-2.5, -3.0, 3.5), rotation=(0.8, -0.4, 0.0))
    context.object.data.energy, context.object.data.size = 250.0, 1.5
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.2, 0.25, 0.3)
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = False, False
    scene.cycles.samples = SAMPLES
    parts.select(box, floor, wall)
    return wall


def _instanced(box: bpy.types.Object) -> bpy.types.Object:
    """Three smaller copies of a box as instances of one collection; returns what instances them: an object with
    Geometry Nodes would make instances of its own, told from each other in the same way."""
    library = bpy.data.collections.new("Library")
    bpy.context.scene.collection.objects.unlink(box)
    library.objects.link(box)
    box.name, box.scale = "Inner", (0.6, 0.6, 0.6)
    row = bpy.data.collections.new("Row")
    for number in range(3):
        placed = bpy.data.objects.new(f"Placed {number}", None)
        placed.instance_type, placed.instance_collection = "COLLECTION", library
        placed.location = (-1.2 * number + 0.4, 0.3 * number, 0.2)
        row.objects.link(placed)
    whole = bpy.data.objects.new("Box", None)
    whole.instance_type, whole.instance_collection = "COLLECTION", row
    bpy.context.scene.collection.objects.link(whole)
    bpy.context.view_layer.update()
    return whole


def shine(scene, width: int = 0, kind: str = "ShaderNodeTexEnvironment") -> bpy.types.World:
    """A world that is bright to one side; of an image with a sun as wide as ours where it is `width` pixels wide."""
    world = scene.world
    if bpy.app.version < (5, 0, 0):
        world.use_nodes = True
    tree = world.node_tree
    node = tree.nodes.new(kind if width else "ShaderNodeTexGradient")
    if width:
        pixels = np.full((width // 2, width, 4), (0.2, 0.3, 0.5, 1.0), dtype=np.float32)
        rows, columns = (slice(int(0.68 * size), int(0.68 * size) + max(1, round(width * 0.53 / 360.0)))
                         for size in pixels.shape[:2])
        pixels[rows, columns, :3] = 3e4
        node.image = bpy.data.images.new("Sky", width, width // 2, float_buffer=True)
        node.image.pixels.foreach_set(pixels.ravel())
        node.image.pack()
    link(tree, node.outputs["Color"], next(one for one in tree.nodes if one.type == "BACKGROUND").inputs["Color"])
    return world


def plain_scene() -> bpy.types.Object:
    """A box that emits what it shows before a wall mirror that shows all of it: nothing that lamps change; returns the
    mirror."""
    box = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    box.data.materials.append(parts.material("Paint"))
    mirror = parts.add_wall_mirror()
    mirror.data.materials.append(parts.material("Chrome", "GLOSSY"))
    mirror.data.materials[0].node_tree.nodes[0].inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    parts.select(box, mirror)
    return mirror


def picture(room, seed: int = 0) -> np.ndarray:
    """What a render of the file shows, in sRGB, (height, width, 3)."""
    rendering = room("addon.rendering")
    scene = bpy.context.scene.copy()
    try:
        rendering.with_cycles(scene)
        scene.cycles.seed = seed
        linear = np.clip(rendering.rendered(scene)[..., :3], 0.0, 1.0)
    finally:
        bpy.data.scenes.remove(scene)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1 / 2.4) - 0.055)


def psnr(one: np.ndarray, other: np.ndarray) -> float:
    """Over the pixels inside the mirror."""
    inside = slice(SIZE // 5, -SIZE // 5)
    return float(-10.0 * np.log10(1e-12 + ((one - other)[inside, inside]**2).mean()))


def outdated(room, result: bpy.types.Object) -> bool:
    """Return True where something has changed on which the light of a result depends."""
    bpy.context.view_layer.update()
    return bool(room("addon.freshness").why_light_differs(bpy.context, result))


def lit_state() -> dict:
    """As `parts.state`, and what a light changes of a result."""
    results = {obj.name: ([(slot.link, slot.material and slot.material.name) for slot in obj.material_slots],
                          sorted(obj.data.attributes.keys()), obj.reflection_mesh.light,
                          obj.reflection_mesh.lit_from)
               for obj in bpy.context.scene.objects if obj.reflection_mesh.role == "REFLECTION"}
    scene = bpy.context.scene
    worlds = {world.name: (_settings(world), world.cycles.sampling_method, world.cycles.sample_map_resolution)
              for world in bpy.data.worlds}
    lights = {lamp.name: (_settings(lamp), _settings(lamp.cycles)) for lamp in bpy.data.lights}
    rays = {obj.name: _settings(obj) for obj in scene.objects}
    return {**parts.state(), "results": results, "lights": lights, "worlds": worlds, "rays": rays,
            "cycles": _settings(scene.cycles), "eevee": _settings(scene.eevee), "bake": _settings(scene.render.bake),
            "film": _settings(scene.render.image_settings), "view": _settings(scene.view_settings),
            "layers": [(_settings(layer), _settings(layer.cycles), layer.material_override,
                        [_settings(branch) for branch in layer.layer_collection.children])
                       for layer in scene.view_layers]}


def _settings(item) -> dict:
    """All numbers, switches and words of a block of settings, render passes among them."""
    # Blender 4.2 counts a user too many of what a copied scene held; tags are undefined, and change as it deletes
    return {name: getattr(item, name) for name in item.bl_rna.properties.keys() if name not in {"users", "tag"}
            and isinstance(getattr(item, name, None), int | float | str | bool)}


def leaves_no_trace(blank, room, monkeypatch, failing: tuple[str, str], build=scene_of) -> None:
    """Where a function, by its module and name, fails, light changes nothing and says why."""
    build(blank)
    parts.generate()
    before = lit_state()

    def fails(*arguments):
        raise room("core").ReflectionError("It failed: try again.")
    monkeypatch.setattr(room(failing[0]), failing[1], fails)
    with pytest.raises(RuntimeError, match="It failed: try again."):
        bpy.ops.reflection_mesh.light(samples=1)
    assert lit_state() == before
