"""What the sample scenes are made of: materials, shapes, lamps, eyes and skies."""
from __future__ import annotations

from collections.abc import Callable

import bpy
import bmesh
import numpy as np
from mathutils import Vector

RESOLUTION = 1024
LIGHT = np.array([-0.45, -0.55, 0.70])
RED, ORANGE, YELLOW, GREEN = (0.75, 0.07, 0.06), (0.90, 0.30, 0.03), (0.90, 0.65, 0.06), (0.10, 0.45, 0.12)
TEAL, BLUE, VIOLET, WHITE = (0.03, 0.42, 0.45), (0.05, 0.14, 0.65), (0.35, 0.09, 0.50), (0.85, 0.84, 0.80)


# ---- materials ----------------------------------------------------------------------------------------------------

def _emission(name: str, node_type: str) -> tuple[bpy.types.Material, bpy.types.Node]:
    """A material that emits the colour of one texture node."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    colour, emission, output = (nodes.new(kind) for kind in
                                (node_type, "ShaderNodeEmission", "ShaderNodeOutputMaterial"))
    colour.location, emission.location, output.location = (-300, 0), (0, 0), (200, 0)
    links.new(colour.outputs["Color"], emission.inputs["Color"])
    links.new(emission.outputs["Emission"], output.inputs["Surface"])
    return material, colour


def picture(name: str, pixels: np.ndarray) -> bpy.types.Material:
    """A material that emits the image `pixels` (height, width, 3), display-referred, packed into the file."""
    height, width, _ = pixels.shape
    image = bpy.data.images.new(name, width, height)
    rgba = np.ones((height, width, 4), dtype=np.float32)
    rgba[..., :3] = np.clip(pixels, 0.0, 1.0)
    image.pixels.foreach_set(rgba.ravel())
    image.pack()
    material, node = _emission(name, "ShaderNodeTexImage")
    node.image = image
    return material


def mirror_material(name: str, metallic: bool = False) -> bpy.types.Material:
    """A perfect mirror: a Glossy BSDF, or a metallic Principled BSDF, of roughness 0."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    if metallic:
        shader = nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        shader.inputs["Metallic"].default_value = 1.0
    else:
        nodes.remove(nodes["Principled BSDF"])
        shader = nodes.new("ShaderNodeBsdfAnisotropic")
        shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
        links.new(shader.outputs["BSDF"], nodes["Material Output"].inputs["Surface"])
    shader.inputs["Roughness"].default_value = 0.0
    return material


def lit(name: str, colour: tuple) -> bpy.types.Material:
    """A plain lit material for what takes no part."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.diffuse_color = (*colour, 1.0)
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1.0)
    return material


def surface(name: str, colour: tuple, texture: str = "", coordinates: str = "UV", scale: float = 5.0,
            **values) -> bpy.types.Material:
    """A lit material: a Principled BSDF whose base colour a procedural texture may darken in places."""
    material = lit(name, colour)
    tree = material.node_tree
    shader = tree.nodes["Principled BSDF"]
    for key, value in values.items():
        shader.inputs[key.replace("_", " ")].default_value = value
    if texture:
        place, pattern, mixed = (tree.nodes.new(kind) for kind in
                                 ("ShaderNodeTexCoord", f"ShaderNodeTex{texture}", "ShaderNodeMix"))
        mixed.data_type = "RGBA"
        mixed.inputs[6].default_value = (*(0.25 * part for part in colour), 1.0)
        mixed.inputs[7].default_value = (*colour, 1.0)
        pattern.inputs["Scale"].default_value = scale
        tree.links.new(place.outputs[coordinates], pattern.inputs["Vector"])
        tree.links.new(pattern.outputs["Fac" if "Fac" in pattern.outputs else "Color"], mixed.inputs[0])
        tree.links.new(mixed.outputs[2], shader.inputs["Base Color"])
    return material


def fresnel_water(name: str, colour: tuple) -> bpy.types.Material:
    """Still water: a mirror from the side, a dark ground from above."""
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.remove(tree.nodes["Principled BSDF"])
    share, ground, gloss, both = (tree.nodes.new(f"ShaderNode{kind}") for kind in
                                  ("Fresnel", "BsdfDiffuse", "BsdfAnisotropic", "MixShader"))
    share.inputs["IOR"].default_value = 1.33
    ground.inputs["Color"].default_value = (*colour, 1.0)
    gloss.inputs["Roughness"].default_value = 0.0
    gloss.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    for source, target in ((share.outputs[0], both.inputs[0]), (ground.outputs[0], both.inputs[1]),
                           (gloss.outputs[0], both.inputs[2]),
                           (both.outputs[0], tree.nodes["Material Output"].inputs["Surface"])):
        tree.links.new(source, target)
    return material


def leaf(name: str, colour: tuple) -> bpy.types.Material:
    """A leaf on a transparent card, by the alpha of an image."""
    u = (np.arange(128) + 0.5) / 64 - 1.0
    x, y = np.meshgrid(u, u)
    inside = np.abs(x) < 0.55 * np.sqrt(np.maximum(1.0 - y * y, 0.0)) * (1.0 - 0.5 * y)
    vein = 1.0 - 0.45 * (np.abs(x) < 0.03) - 0.25 * (np.abs((8.0 * (y + np.abs(x))) % 2.0 - 1.0) < 0.12)
    image = bpy.data.images.new(name, 128, 128, alpha=True)
    rgba = np.ones((128, 128, 4), dtype=np.float32)
    rgba[..., :3] = np.array(colour) ** (1.0 / 2.2) * vein[..., None]
    rgba[..., 3] = inside
    image.pixels.foreach_set(rgba.ravel())
    image.pack()
    material = surface(name, colour, Roughness=0.6)
    tree = material.node_tree
    look = tree.nodes.new("ShaderNodeTexImage")
    look.image = image
    tree.links.new(look.outputs["Color"], tree.nodes["Principled BSDF"].inputs["Base Color"])
    tree.links.new(look.outputs["Alpha"], tree.nodes["Principled BSDF"].inputs["Alpha"])
    return material


def lamp(name: str, location: tuple, target: tuple, watts: float, size: float, colour: tuple = (1, 1, 1)) -> None:
    """An area lamp that shines at `target`."""
    data = bpy.data.lights.new(name, "AREA")
    data.energy, data.size, data.color = watts, size, colour
    made = bpy.data.objects.new(name, data)
    made.location = location
    made.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(made)


def checks(size: int, count: int, dark: tuple, light: tuple, shadows: list = (), extent: float = 1.0) -> np.ndarray:
    """A chequer of `count` x `count` fields, with soft shadows (x, y, radius) in a square of half width `extent`."""
    u = (np.arange(size) + 0.5) / size
    field = (np.floor(u[:, None] * count) + np.floor(u[None, :] * count)) % 2
    pixels = np.where(field[..., None] > 0, light, dark).astype(np.float64)
    x, y = np.meshgrid((2 * u - 1) * extent, (2 * u - 1) * extent)
    shade = np.ones((size, size))
    for sx, sy, radius in shadows:
        shade *= 1.0 - 0.6 * np.exp(-((x - sx) ** 2 + (y - sy) ** 2) / (0.8 * radius) ** 2)
    return pixels * shade[..., None]


# ---- objects ------------------------------------------------------------------------------------------------------

def add(kind: str, name: str, location: tuple, material: bpy.types.Material | tuple, *, scale=(1, 1, 1),
        smooth: bool = False, **options) -> bpy.types.Object:
    """A primitive `kind` of Blender's Add menu, with its options; `material` may be a colour, painted with its light as
    an attribute."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=location, **options)
    added = bpy.context.object
    added.name = added.data.name = name
    added.scale = scale
    if smooth:
        added.data.shade_smooth()
    if isinstance(material, tuple):
        bpy.context.view_layer.update()
        material = painted(added, material)
    added.data.materials.append(material)
    return added


def painted(target: bpy.types.Object, colour: tuple) -> bpy.types.Material:
    """Writes colour times light into a colour attribute and returns the material that emits it."""
    mesh = target.data
    normals = np.empty(len(mesh.loops) * 3, dtype=np.float32)
    mesh.corner_normals.foreach_get("vector", normals)
    turn = np.array(target.matrix_world.inverted_safe().to_3x3().transposed(), dtype=np.float64)
    normals = normals.reshape(-1, 3) @ turn.T
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    light = 0.34 + 0.20 * normals[:, 2] + 0.62 * np.maximum(normals @ (LIGHT / np.linalg.norm(LIGHT)), 0.0)
    rgba = np.ones((len(mesh.loops), 4), dtype=np.float32)
    rgba[:, :3] = np.array(colour) * np.maximum(light, 0.1)[:, None]
    mesh.color_attributes.new("Painted Light", "FLOAT_COLOR", "CORNER").data.foreach_set("color", rgba.ravel())
    material = bpy.data.materials.get("Painted")
    if material is None:
        material, node = _emission("Painted", "ShaderNodeVertexColor")
        node.layer_name = "Painted Light"
    return material


def moulded(name: str, columns: int, rows: int, shape: Callable, material: bpy.types.Material) -> bpy.types.Object:
    """Blender's grid primitive with its points (n, 2) in [-1, 1] moved to `shape(points)` (n, 3), smooth-shaded."""
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=columns, y_subdivisions=rows, size=2.0)
    made = bpy.context.object
    made.name = made.data.name = name
    mesh = made.data
    points = np.empty(len(mesh.vertices) * 3)
    mesh.vertices.foreach_get("co", points)
    mesh.vertices.foreach_set("co", shape(points.reshape(-1, 3)[:, :2]).ravel())
    edit = bmesh.new()
    edit.from_mesh(mesh)
    bmesh.ops.remove_doubles(edit, verts=edit.verts, dist=1e-4)
    edit.to_mesh(mesh)
    edit.free()
    mesh.update()
    mesh.shade_smooth()
    mesh.materials.append(material)
    return made


def eye(location: tuple, target: tuple, lens: float = 50.0) -> None:
    """The scene's camera."""
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = location
    camera.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = lens
    bpy.context.scene.collection.objects.link(camera)
    bpy.context.scene.camera = camera


def sky() -> bpy.types.World:
    """A clear sky, pale at the horizon and deep blue above, so that mirrors stand out from what is behind them."""
    world = bpy.data.worlds.new("Sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    direction, split, ramp = (nodes.new(kind) for kind in
                              ("ShaderNodeTexCoord", "ShaderNodeSeparateXYZ", "ShaderNodeValToRGB"))
    direction.location, split.location, ramp.location = (-800, 300), (-600, 300), (-350, 300)
    links.new(direction.outputs["Generated"], split.inputs["Vector"])
    links.new(split.outputs["Z"], ramp.inputs["Fac"])
    links.new(ramp.outputs["Color"], nodes["Background"].inputs["Color"])
    ramp.color_ramp.elements[0].color = (0.72, 0.76, 0.80, 1.0)
    ramp.color_ramp.elements[1].color = (0.06, 0.15, 0.38, 1.0)
    return world
