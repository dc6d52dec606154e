"""Writes the sample scenes: one small .blend per kind of mirror, from Blender's own primitives.

    python sample_blends/make_samples.py [folder] [name ...]

Run it with the oldest supported `bpy` (4.2), so that every supported Blender opens the files. What most mirrors show
is unlit (emission of an image or of a colour attribute with the light painted in), so that a reflection can be judged
by its colours; frames, lids and stands are lit and take no part. Three scenes, of `LIT`, have lamps, and mirrors with
a colour and a Fresnel of their own. Mirror and diffuse objects are saved selected.
"""
from __future__ import annotations

import os
import shutil
import sys
import tempfile
from collections.abc import Callable
from math import pi, radians
from pathlib import Path

os.environ["HOME"] = os.sep  # a .blend remembers the home folder of whoever wrote it, in its file browsers
import bpy  # first: outside Blender it is what makes bmesh and mathutils importable
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
        rotation=(0, 0, 0), smooth: bool = False, **options) -> bpy.types.Object:
    """A primitive `kind` of Blender's Add menu; `material` may be a colour, painted with its light as an attribute."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=location, rotation=rotation, **options)
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


# ---- scenes: each returns its mirror and the objects that take no part -------------------------------------------

def sphere() -> tuple:
    """A convex mirror between shapes, some of them behind the camera."""
    mirror = add("uv_sphere", "Mirror Sphere", (0, 0, 1.25), mirror_material("Mirror"), segments=48, ring_count=24,
                 smooth=True)
    add("grid", "Floor", (0, 0, 0), picture("Floor", checks(512, 14, (0.22, 0.16, 0.14), (0.93, 0.88, 0.78), [
        (0, 0, 1.0), (-2.1, 0.6, 0.9), (1.9, 0.9, 0.8), (1.1, -1.6, 0.5), (-1.1, -1.6, 0.6), (-4.2, -4.2, 1.2),
        (4.2, -4.0, 1.1), (0.6, 3.2, 1.2), (-0.4, -8.0, 1.3)], 9.0)),
        x_subdivisions=18, y_subdivisions=18, size=18)
    add("cube", "Red Cube", (-2.1, 0.6, 0.66), RED, size=1.3, rotation=(0, 0, 0.5))
    add("cone", "Yellow Cone", (1.9, 0.9, 0.91), YELLOW, radius1=0.75, depth=1.8, vertices=32, smooth=False)
    add("torus", "Teal Ring", (1.1, -1.6, 0.31), TEAL, major_radius=0.42, minor_radius=0.16, major_segments=32,
        minor_segments=12, smooth=True, rotation=(0.35, 0.2, 0))
    add("ico_sphere", "Violet Gem", (-1.1, -1.6, 0.46), VIOLET, radius=0.45, subdivisions=2)
    add("cylinder", "Green Column", (-4.2, -4.2, 1.51), GREEN, radius=0.6, depth=3.0, vertices=24)
    add("cylinder", "Blue Column", (4.2, -4.0, 1.51), BLUE, radius=0.6, depth=3.0, vertices=24)
    add("cube", "Orange Wall", (0.6, 3.2, 1.01), ORANGE, size=2, scale=(1.7, 0.12, 1.0))
    add("monkey", "Suzanne", (-0.6, -8.0, 2.2), WHITE, size=3.4, rotation=(0, 0, pi), smooth=True)
    eye((0.7, -5.6, 2.5), (0.0, 0.0, 1.05), 50)
    return mirror, ()


def flat_mirror() -> tuple:
    """A plane mirror of one quad over a floor of one quad: textures must be right inside large triangles."""
    mirror = add("plane", "Flat Mirror", (0, 1.6, 1.55), mirror_material("Mirror"), size=2, scale=(1.9, 1.35, 1),
                 rotation=(pi / 2, 0, 0))
    wood = lit("Wood", (0.16, 0.07, 0.03))
    frame = [add("cube", f"Frame {side}", place, wood, size=1, scale=scale) for side, place, scale in (
        ("left", (-1.99, 1.62, 1.55), (0.18, 0.14, 3.06)), ("right", (1.99, 1.62, 1.55), (0.18, 0.14, 3.06)),
        ("top", (0, 1.62, 2.99), (3.8, 0.14, 0.18)), ("bottom", (0, 1.62, 0.11), (3.8, 0.14, 0.18)))]
    add("plane", "Floor", (0, 0, 0), picture("Floor", checks(512, 16, (0.10, 0.18, 0.24), (0.90, 0.90, 0.86), [
        (-1.1, -0.5, 0.6), (0.9, -0.3, 0.7), (0.1, 0.5, 0.4), (-3.4, -3.4, 1), (3.2, -5.0, 1)], 6.0)), size=12)
    add("monkey", "Suzanne", (0.9, -0.3, 0.66), ORANGE, size=1.3, rotation=(-0.3, 0, pi - 0.7), smooth=True)
    add("cube", "Red Cube", (-1.1, -0.5, 0.46), RED, size=0.9, rotation=(0, 0, 0.6))
    add("ico_sphere", "Teal Ball", (0.1, 0.5, 0.36), TEAL, radius=0.35, subdivisions=4, smooth=True)
    add("cone", "Green Cone", (-3.4, -3.4, 1.51), GREEN, radius1=0.9, depth=3.0, vertices=32)
    add("cylinder", "Violet Column", (3.2, -5.0, 1.51), VIOLET, radius=0.6, depth=3.0, vertices=24)
    eye((-1.7, -4.9, 2.3), (0.0, 0.9, 1.1), 40)
    return mirror, frame


def bowl() -> tuple:
    """A concave mirror: near things upright and enlarged, far things upside down, caustics between."""
    radius, opening = 3.2, radians(34)

    def dish(points: np.ndarray) -> np.ndarray:
        longest = np.abs(points).max(axis=1)
        round_off = longest / np.maximum(np.linalg.norm(points, axis=1), 1e-12)
        angle, turn = longest * opening, points * np.where(longest > 0, round_off, 0.0)[:, None]
        turn /= np.maximum(np.linalg.norm(turn, axis=1, keepdims=True), 1e-12)
        flat = np.sin(angle)[:, None] * turn
        return radius * np.column_stack([flat[:, 0], np.cos(angle), flat[:, 1]])

    mirror = moulded("Bowl", 32, 32, dish, mirror_material("Mirror", metallic=True))
    mirror.location, mirror.rotation_euler = (0, -1.75, 1.55), (radians(-8), 0, 0)
    add("grid", "Floor", (0, -1, 0), picture("Floor", checks(512, 16, (0.20, 0.10, 0.22), (0.92, 0.90, 0.82), [
        (-0.75, 0.2, 0.35), (0.8, 0.3, 0.35), (-3.0, -4.0, 0.9), (3.0, -4.4, 0.9), (0, 2.2, 1.3)], 8.0)),
        x_subdivisions=16, y_subdivisions=16, size=16)
    add("cube", "Red Cube", (-0.75, -0.8, 0.26), RED, size=0.5, rotation=(0, 0, 0.4))
    add("cone", "Yellow Cone", (0.8, -0.7, 0.41), YELLOW, radius1=0.35, depth=0.8, vertices=32)
    add("cylinder", "Green Column", (-3.0, -5.0, 1.51), GREEN, radius=0.5, depth=3.0, vertices=24)
    add("cylinder", "Blue Column", (3.0, -5.4, 1.51), BLUE, radius=0.5, depth=3.0, vertices=24)
    add("torus", "Orange Ring", (0.0, -8.0, 2.2), ORANGE, major_radius=1.0, minor_radius=0.3, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, 0), smooth=True)
    eye((0.6, -4.9, 2.1), (0, 0.6, 1.35), 44)
    return mirror, ()


def water() -> tuple:
    """Gentle waves, convex and concave in turn, flat enough that what stands behind stays on one sheet."""
    def waves(points: np.ndarray) -> np.ndarray:
        x, y = 6.2 * points[:, 0], 6.2 * points[:, 1] + 0.7
        height = (0.011 * np.sin(1.1 * x + 2.0 * y) + 0.008 * np.sin(-1.3 * x + 1.9 * y + 1.0)
                  + 0.005 * np.sin(2.6 * x + 0.7 * y + 2.0))
        return np.column_stack([x, y, height])

    mirror = moulded("Water", 40, 40, waves, mirror_material("Water"))
    add("cube", "Jetty", (-2.6, 4.4, 0.62), picture("Planks", checks(256, 12, (0.30, 0.17, 0.09), (0.80, 0.58, 0.34))),
        size=1, scale=(4.0, 1.4, 0.3))
    for k, x in enumerate((-4.2, -2.6, -1.0)):
        add("cylinder", f"Post {k + 1}", (x, 3.6, 0.75), WHITE, radius=0.14, depth=1.3, vertices=20, smooth=False)
    add("cube", "House", (-3.2, 4.5, 1.42), RED, size=1.3)
    add("cone", "Roof", (-3.2, 4.5, 2.47), VIOLET, radius1=1.15, depth=0.8, vertices=4, rotation=(0, 0, pi / 4))
    add("torus", "Gate", (1.9, 3.4, 1.62), ORANGE, major_radius=1.1, minor_radius=0.2, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, -0.3), smooth=True)
    add("uv_sphere", "Buoy", (0.2, 1.6, 0.75), YELLOW, radius=0.42, segments=24, ring_count=12, smooth=True)
    add("monkey", "Suzanne", (4.0, 4.9, 1.3), TEAL, size=1.7, rotation=(0, 0, -0.5), smooth=True)
    add("grid", "Hills", (0, 6.95, 1.72), picture("Hills", _hills()), size=1, scale=(22, 3.4, 1), x_subdivisions=16,
        y_subdivisions=3, rotation=(pi / 2, 0, 0))
    eye((0.4, -7.6, 3.6), (0.0, 1.6, 0.75), 42)
    return mirror, ()


def _hills() -> np.ndarray:
    """Ridges in three greens before a sky of the evening."""
    x, y = np.meshgrid(np.linspace(0, 1, 512), np.linspace(0, 1, 128))
    pixels = np.array([0.98, 0.80, 0.62]) + y[..., None] * np.array([-0.45, -0.22, 0.18])
    ridges = ((0.62, (0.38, 0.48, 0.50), 3.1), (0.45, (0.24, 0.38, 0.34), 4.7), (0.25, (0.13, 0.26, 0.18), 7.3))
    for level, colour, f in ridges:
        ridge = level + 0.10 * np.sin(2 * pi * f * x + 9 * level) + 0.05 * np.sin(5 * pi * f * x + 4)
        pixels[y < ridge] = colour
    return pixels


def cylinder() -> tuple:
    """A developable mirror over a painted floor, as in anamorphic pictures."""
    def tube(points: np.ndarray) -> np.ndarray:
        angle = pi * points[:, 0]
        return np.column_stack([np.cos(angle), np.sin(angle), 1.25 * points[:, 1]])

    mirror = moulded("Mirror Cylinder", 64, 12, tube, mirror_material("Mirror", metallic=True))
    mirror.location = (0, 0.6, 1.35)
    lid = add("cylinder", "Lid", (0, 0.6, 2.64), lit("Lid", (0.10, 0.08, 0.07)), radius=1.03, depth=0.08, vertices=64)
    u = (np.arange(1536) + 0.5) / 768 - 1
    x, y = np.meshgrid(u * 6, u * 6 - 0.6)
    distance, angle = np.hypot(x, y), np.arctan2(y, x)
    wheel = np.array([0.50, 0.40, 0.42]) + 0.24 * np.cos(angle[..., None] + np.array([0.3, 2.4, 4.5]))
    ring = ((np.floor(distance / 0.55) + np.floor(angle / (pi / 12))) % 2)[..., None]
    fine = np.where(ring > 0, wheel, np.array([0.94, 0.90, 0.82]))
    soft = fine.reshape(512, 3, 512, 3, 3).mean(axis=(1, 3))
    add("grid", "Floor", (0, 0, 0), picture("Rings", soft), size=12, x_subdivisions=12, y_subdivisions=12)
    add("cube", "Red Cube", (-1.75, -0.5, 0.46), RED, size=0.9, rotation=(0, 0, 0.3))
    add("cone", "Yellow Cone", (1.7, -0.5, 0.71), YELLOW, radius1=0.6, depth=1.4, vertices=32)
    add("ico_sphere", "Teal Ball", (-0.2, -1.6, 0.41), TEAL, radius=0.4, subdivisions=4, smooth=True)
    add("cylinder", "Blue Column", (-3.4, -3.2, 1.51), BLUE, radius=0.5, depth=3.0, vertices=24)
    add("monkey", "Suzanne", (2.9, -4.4, 1.6), ORANGE, size=2.0, rotation=(0, 0, pi + 0.6), smooth=True)
    eye((0.5, -5.6, 3.3), (0.0, 0.2, 1.05), 45)
    return mirror, (lid,)


def suzanne() -> tuple:
    """Suzanne as the mirror, rounded by a modifier: convex, concave and seeing herself."""
    mirror = add("monkey", "Suzanne", (0, 0, 1.3), mirror_material("Mirror"), size=2.4, rotation=(-0.15, 0, 0.35),
                 smooth=True)
    rounding = mirror.modifiers.new("Subdivision", "SUBSURF")
    rounding.levels = rounding.render_levels = 1
    add("grid", "Floor", (0, -1, 0), picture("Floor", checks(512, 14, (0.42, 0.09, 0.07), (0.93, 0.87, 0.74), [
        (0, 1, 1.2), (-1.9, 0.4, 0.8), (1.9, 0.8, 0.8), (-2.8, -4.6, 0.8), (2.8, -4.6, 0.8)], 8.0)), size=16,
        x_subdivisions=16, y_subdivisions=16)
    add("cube", "Blue Cube", (-1.9, -0.6, 0.56), BLUE, size=1.1, rotation=(0, 0, 0.5))
    add("torus", "Green Ring", (1.9, -0.2, 0.92), GREEN, major_radius=0.7, minor_radius=0.2, major_segments=40,
        minor_segments=14, rotation=(pi / 2, 0, 0.6), smooth=True)
    add("cylinder", "Teal Column", (-2.8, -5.6, 1.51), TEAL, radius=0.5, depth=3.0, vertices=24)
    add("cylinder", "Orange Column", (2.8, -5.6, 1.51), ORANGE, radius=0.5, depth=3.0, vertices=24)
    add("plane", "Sky Panel", (0, -5.0, 5.2), picture("Panel", checks(128, 4, (0.55, 0.66, 0.80), (0.98, 0.98, 0.98))),
        size=5, rotation=(pi + 0.6, 0, 0))
    eye((0.7, -4.6, 2.1), (0.0, 0.0, 1.25), 50)
    return mirror, ()


def mirrors() -> tuple:
    """Two walls in a corner and a ball, all mirrors: each is seen in the others, as often as the depth allows."""
    wall = add("plane", "Wall Mirror", (0, 1.8, 1.6), mirror_material("Mirror"), size=2, scale=(2.2, 1.6, 1),
               rotation=(pi / 2, 0, 0))
    add("plane", "Side Mirror", (2.2, -0.2, 1.6), mirror_material("Side Mirror"), size=2, scale=(1.6, 1.9, 1),
        rotation=(0, -pi / 2, 0))
    add("uv_sphere", "Ball Mirror", (-1.0, 0.4, 0.8), mirror_material("Ball Mirror", metallic=True), radius=0.7,
        segments=64, ring_count=32, smooth=True)
    add("plane", "Floor", (0, 0, 0), picture("Floor", checks(512, 16, (0.10, 0.18, 0.24), (0.90, 0.90, 0.86), [
        (-1.0, 0.4, 0.7), (0.7, -0.4, 0.7), (-0.2, -1.6, 0.5), (-3.0, -3.0, 0.9)], 6.0)), size=12)
    add("monkey", "Suzanne", (0.7, -0.4, 0.75), ORANGE, size=1.2, rotation=(-0.3, 0, pi - 0.6), smooth=True)
    add("cube", "Red Cube", (-0.2, -1.6, 0.36), RED, size=0.7, rotation=(0, 0, 0.6))
    add("cone", "Green Cone", (-3.0, -3.0, 1.5), GREEN, radius1=0.8, depth=3.0, vertices=32)
    eye((-2.6, -5.2, 2.6), (0.5, 0.9, 1.1), 36)
    return wall, []


def room() -> tuple:
    """A golden ball in a room with two lamps: shadows, light from wall to wall, textures of every kind."""
    gold = surface("Gold", (0.95, 0.78, 0.48), Metallic=1.0, Roughness=0.0)
    mirror = add("uv_sphere", "Golden Ball", (0, 0, 1.0), gold, radius=1.0, segments=64, ring_count=32, smooth=True)
    add("plane", "Tiles", (0, -1.5, 0), surface("Tiles", (0.80, 0.74, 0.66), "Checker", scale=18.0, Roughness=0.35),
        size=9)
    plaster = surface("Plaster", (0.78, 0.76, 0.70), Roughness=0.9)
    add("plane", "Left Wall", (-4.5, -1.5, 1.75), surface("Red Wall", (0.62, 0.12, 0.08), Roughness=0.9), size=1,
        scale=(3.5, 9, 1), rotation=(0, pi / 2, 0))
    add("plane", "Right Wall", (4.5, -1.5, 1.75), surface("Green Wall", (0.12, 0.42, 0.16), Roughness=0.9), size=1,
        scale=(3.5, 9, 1), rotation=(0, -pi / 2, 0))
    add("plane", "Back Wall", (0, 3.0, 1.75), plaster, size=1, scale=(9, 3.5, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Front Wall", (0, -6.0, 1.75), surface("Bricks", (0.85, 0.48, 0.30), "Brick", scale=4.0,
                                                        Roughness=0.9), size=1, scale=(9, 3.5, 1),
        rotation=(-pi / 2, 0, 0))
    add("monkey", "Suzanne", (-1.9, -1.7, 0.72), surface("Marble", (0.85, 0.80, 0.86), "Noise", "Generated", 5.0),
        size=1.4, rotation=(-0.3, 0, 2.5), smooth=True)
    add("cube", "Crate", (1.9, -1.5, 0.5), surface("Wood", (0.60, 0.34, 0.14), "Wave", "Object", 2.0), size=1.0,
        rotation=(0, 0, 0.5))
    add("torus", "Blue Ring", (0.3, -2.4, 0.2), surface("Glaze", (0.05, 0.14, 0.65), Roughness=0.15),
        major_radius=0.55, minor_radius=0.19, major_segments=40, minor_segments=16, smooth=True)
    lamp("Ceiling Lamp", (1.5, -2.0, 3.4), (0.5, -1.5, 0), 260.0, 1.2)
    lamp("Warm Lamp", (-3.2, -4.6, 2.6), (0, -1, 0.8), 90.0, 0.5, (1.0, 0.62, 0.30))
    eye((0.6, -5.4, 2.0), (0.0, 0.0, 0.95), 48)
    return mirror, ()


def bathroom() -> tuple:
    """A tinted flat mirror over a shelf, before a wall of tiles."""
    silver = surface("Tinted Silver", (0.70, 0.86, 0.80), Metallic=1.0, Roughness=0.0)
    mirror = add("plane", "Mirror", (0, 1.48, 1.75), silver, size=1, scale=(2.6, 1.7, 1), rotation=(pi / 2, 0, 0))
    tiles = surface("Wall Tiles", (0.82, 0.86, 0.88), "Brick", scale=9.0, Roughness=0.2)
    wall = add("plane", "Mirror Wall", (0, 1.5, 1.6), tiles, size=1, scale=(6, 3.2, 1), rotation=(pi / 2, 0, 0))
    add("plane", "Floor", (0, -1.0, 0), surface("Floor", (0.30, 0.33, 0.36), "Checker", scale=24.0, Roughness=0.3),
        size=6, scale=(1, 5 / 6, 1))
    add("plane", "Door Wall", (0, -3.5, 1.6), surface("Paint", (0.80, 0.72, 0.58), Roughness=0.8), size=1,
        scale=(6, 3.2, 1), rotation=(-pi / 2, 0, 0))
    add("cube", "Door", (-1.0, -3.46, 1.05), surface("Door", (0.32, 0.17, 0.08), "Wave", "Object", 3.0,
                                                     Roughness=0.4), size=1, scale=(0.95, 0.06, 2.1))
    add("plane", "Side Wall", (3.0, -1.0, 1.6), tiles, size=1, scale=(3.2, 5, 1), rotation=(0, -pi / 2, 0))
    add("cube", "Shelf", (0, 1.2, 0.80), surface("Shelf", (0.55, 0.42, 0.28), "Noise", "Generated", 8.0), size=1,
        scale=(2.6, 0.5, 0.06))
    add("uv_sphere", "Soap", (-0.75, 1.12, 0.90), surface("Soap", (0.90, 0.45, 0.55), Roughness=0.25), radius=0.13,
        scale=(1.4, 1.0, 0.6), segments=32, ring_count=16, smooth=True)
    add("cylinder", "Bottle", (0.55, 1.15, 1.03), surface("Bottle", (0.06, 0.30, 0.34), Roughness=0.1), radius=0.1,
        depth=0.4, vertices=40, smooth=False)
    add("monkey", "Suzanne", (0.3, -0.6, 1.45), surface("Skin", (0.75, 0.45, 0.30), Roughness=0.5), size=1.0,
        rotation=(-0.1, 0, pi + 0.25), smooth=True)
    add("cube", "Towel", (2.9, -0.5, 1.5), surface("Towel", (0.10, 0.20, 0.55), "Checker", "Object", 8.0,
                                                   Roughness=1.0), size=1, scale=(0.08, 0.7, 1.0))
    lamp("Mirror Lamp", (0, 0.9, 2.9), (0, 0.4, 1.0), 60.0, 0.9, (1.0, 0.92, 0.80))
    lamp("Window", (-2.8, -1.5, 2.0), (0, -1.0, 1.0), 90.0, 1.2, (0.70, 0.85, 1.0))
    eye((-1.0, -2.6, 1.85), (0.15, 1.4, 1.55), 35)
    return mirror, (wall,)


def pond() -> tuple:
    """Water that mirrors by Fresnel, under a wall with posts and hanging leaves."""
    def waves(points: np.ndarray) -> np.ndarray:
        x, y = 6.0 * points[:, 0], 6.0 * points[:, 1]
        return np.column_stack([x, y, 0.010 * np.sin(1.2 * x + 1.9 * y) + 0.007 * np.sin(-1.5 * x + 2.1 * y + 1.0)])

    mirror = moulded("Pond", 40, 40, waves, fresnel_water("Water", (0.02, 0.05, 0.05)))
    add("cube", "Wall", (0, 5.2, 0.9), surface("Stone", (0.55, 0.50, 0.44), "Voronoi", "Object", 2.2, Roughness=0.9),
        size=1, scale=(12, 0.6, 2.2))
    for k, x in enumerate((-3.6, -1.2, 1.4, 3.8)):
        add("cylinder", f"Post {k + 1}", (x, 4.1, 0.9), surface(f"Post {k + 1}", (RED, YELLOW, BLUE, WHITE)[k],
                                                                Roughness=0.5), radius=0.18, depth=2.2, vertices=24)
    add("uv_sphere", "Buoy", (0.4, 1.9, 0.75), surface("Buoy", (0.90, 0.30, 0.03), Roughness=0.3), radius=0.4,
        segments=24, ring_count=12, smooth=True)
    leaves = [leaf("Green Leaf", (0.10, 0.42, 0.06)), leaf("Yellow Leaf", (0.80, 0.55, 0.05))]
    places = np.random.default_rng(5).uniform((-4.0, 2.2, 1.2), (4.5, 4.0, 2.6), (26, 3))
    for k, place in enumerate(places):
        turn = tuple(np.random.default_rng(k).uniform(-0.7, 0.7, 3) + (pi / 2, 0, 0))
        add("plane", f"Leaf {k + 1}", tuple(place), leaves[k % 2], size=0.55, rotation=turn)
    eye((0.5, -6.6, 2.6), (0.0, 2.0, 0.75), 42)
    return mirror, ()


def anamorphosis() -> tuple:
    """A tube of 7 cm on a sheet of A3: *Write Mirror UVs* puts the picture `Compass` of this file on it."""
    def tube(points: np.ndarray) -> np.ndarray:
        angle = pi * points[:, 0]
        return np.column_stack([0.035 * np.cos(angle), 0.035 * np.sin(angle), 0.07 + 0.065 * points[:, 1]])

    mirror = moulded("Mirror Tube", 64, 2, tube, mirror_material("Mirror"))
    mirror.location = (0, 0.085, 0)
    lid = add("cylinder", "Lid", (0, 0.085, 0.1375), lit("Lid", (0.10, 0.08, 0.07)), radius=0.036, depth=0.004,
              vertices=64)
    table = add("plane", "Table", (0, 0, -0.001), surface("Table", (0.20, 0.09, 0.04), "Wave", "Object", 6.0), size=1.4)
    add("plane", "Sheet", (0, 0, 0), surface("Paper", (0.8, 0.8, 0.8), Roughness=1.0), size=1, scale=(0.42, 0.297, 1))
    soft = _compass(1536).reshape(512, 3, 512, 3, 3).mean(axis=(1, 3))
    image = picture("Compass", soft).node_tree.nodes["Image Texture"].image
    image.use_fake_user = True
    bpy.data.materials.remove(bpy.data.materials["Compass"])
    eye((0, -0.38, 0.50), (0, 0.06, 0.05), 90)
    return mirror, (lid, table)


def _compass(size: int) -> np.ndarray:
    """A compass rose within a ring of checks, its north red: a picture that is neither symmetric nor plain."""
    u = (np.arange(size) + 0.5) / (0.5 * size) - 1.0
    x, y = np.meshgrid(u, u)
    distance, angle = np.hypot(x, y), np.arctan2(x, y)
    pixels = np.full((size, size, 3), (0.96, 0.92, 0.82))
    ring = np.floor(angle / (pi / 36)) % 2 == np.floor((distance - 0.72) / 0.06) % 2
    pixels[(0.72 < distance) & (distance < 0.84) & ring] = (0.12, 0.16, 0.30)
    for points, reach, turn, colours in ((4, 0.45, pi / 4, ((0.30, 0.50, 0.52), (0.62, 0.76, 0.74))),
                                         (4, 0.68, 0.0, ((0.12, 0.16, 0.30), (0.55, 0.60, 0.74)))):
        off = (angle - turn + pi / points) % (2 * pi / points) - pi / points
        along, across = distance * np.cos(off), distance * np.abs(np.sin(off))
        star = across < 0.32 * (reach - along)
        star &= along > 0.0
        for side, colour in zip((off < 0, off >= 0), colours):
            pixels[star & side] = colour
    north = (np.abs(angle) < pi / 4) & (np.abs(x) < 0.32 * (0.68 - y)) & (y > np.abs(x))
    pixels[north & (x < 0)], pixels[north & (x >= 0)] = (0.72, 0.10, 0.08), (0.92, 0.45, 0.36)
    # an N above it
    n = (np.abs(y - 0.915) < 0.06) & (np.abs(x) < 0.05)
    pixels[n & ((np.abs(x) > 0.032) | (np.abs(x + (y - 0.915) * 0.75) < 0.014))] = (0.72, 0.10, 0.08)
    return pixels


LIT = (room, bathroom, pond)
SCENES = {scene.__name__: scene for scene in (sphere, flat_mirror, bowl, water, cylinder, suzanne, mirrors,
                                             anamorphosis, *LIT)}


def write(name: str, folder: Path) -> Path:
    """Builds the scene `name` in an empty file and saves it, compressed, into `folder`."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    mirror, bystanders = SCENES[name]()
    scene.world = sky()
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler = Vector(-LIGHT).to_track_quat("-Z", "Y").to_euler()
    sun.data.energy = 3.0
    if SCENES[name] not in (room, bathroom):
        scene.collection.objects.link(sun)
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = RESOLUTION
    scene.cycles.samples = 64
    scene.view_settings.view_transform = "Standard"
    for item in scene.objects:
        item.select_set(item.type == "MESH" and item not in bystanders)
    bpy.context.view_layer.objects.active = mirror
    # A .blend remembers where it was saved: a neutral folder first, so that no path of the writer's travels with it.
    with tempfile.TemporaryDirectory(prefix="sample_blends_") as neutral:
        saved = Path(neutral) / f"{name}.blend"
        bpy.ops.wm.save_as_mainfile(filepath=str(saved), compress=True, copy=False)
        return Path(shutil.copy(saved, folder / saved.name))


def main(arguments: list[str]) -> None:
    folder = Path(__file__).parent
    if arguments and arguments[0] not in SCENES:
        folder = Path(arguments.pop(0))
        folder.mkdir(parents=True, exist_ok=True)
    for name in arguments or SCENES:
        written = write(name, folder)
        print(f"{written.name}: {written.stat().st_size / 1024:.0f} KiB")


if __name__ == "__main__":
    main(sys.argv[1:])
