"""A mirror that throws the light of a large lamp on matt objects, drawn from one seed.

Of a large lamp Cycles finds caustics of its own without much noise, which say what is right. Beside light that comes
straight from the lamp nothing else is left: paint under varnish is black, and what is matt has no gloss.
"""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Euler, Vector

from tests.fuzz.blender import lit_scenes
from tests.fuzz.blender.lit_materials import MIRRORS as MATERIALS
from tests.fuzz.blender.lit_materials import OBJECTS, mirror_material, object_material
from tests.fuzz.blender.scene_shapes import chosen
from tests.fuzz.blender.scenes import Scene, select

SIZE, SAMPLES = 48, 512
MATT = ("plain", "textured", "painted")
SHARP = ("metal", "textured metal", "painted metal", "open", "mirror over paint", "coated", "half mirror")
SHAPES = ("wall", "disc", "waves", "cube", "ball", "pipe", "bowl")
PLACES = 8  # on the lamp


def thrown_scene(seed: int) -> Scene:
    """Build the scene of a seed, the same every time, in a new empty file."""
    rng = np.random.default_rng((seed, 16))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    shape, mirror = lit_scenes.added_object(rng, "Mirror", {name: lit_scenes.MIRRORS[name] for name in SHAPES})
    of, material = mirror_material(rng, tuple(MATERIALS.keys() - set(SHARP)))
    mirror.data.materials.append(material)
    mirror.reflection_mesh.role, mirror.location = "MIRROR", (0.0, 1.2, 0.2)
    if shape in lit_scenes.FLAT:
        turned = np.pi * (rng.random() < 0.3)
        mirror.rotation_euler = Euler((np.pi / 2 + rng.uniform(-0.5, 0.2) + turned, 0.0, rng.uniform(-0.5, 0.5)))
    names = [str(seed), f"{shape} of {of}"]
    glossy = tuple(OBJECTS.keys() - set(MATT))
    names.append("floor of " + lit_scenes.added_floor(rng, glossy))
    if rng.random() < 0.5:
        bpy.ops.mesh.primitive_plane_add(size=8.0, location=(-3.2, -1.0, 0.0), rotation=(0.0, np.pi / 2, 0.0))
        names.append("wall of " + _made_of(rng, glossy))
    for _ in range(chosen(rng, [0, 1, 2])):
        kind, obj = lit_scenes.added_object(rng, "Object", lit_scenes.OBJECTS)
        obj.location = (rng.uniform(-2.0, 2.0), rng.uniform(-3.0, -0.6), rng.uniform(-1.0, 0.8))
        obj.rotation_euler, obj.scale = rng.uniform(-1.5, 1.5, 3).tolist(), 3 * (chosen(rng, [0.4, 0.6]),)
        names.append(f"{kind} of " + _made_of(rng, glossy))
    names.append(_lamp(rng, mirror))
    _view(rng)
    for obj in bpy.context.scene.objects:
        _matt(obj)
    bpy.context.view_layer.update()
    select(list(bpy.context.scene.objects), mirror)
    return Scene(", ".join(names), {"eyes": PLACES}, [mirror])


def _made_of(rng: np.random.Generator, without: tuple[str, ...]) -> str:
    of, material = object_material(rng, without)
    bpy.context.object.data.materials.append(material)
    return of


def _lamp(rng: np.random.Generator, mirror: bpy.types.Object) -> str:
    kind = chosen(rng, ["POINT", "AREA", "SPOT", "SUN"])
    data = bpy.data.lights.new("Lamp", kind)
    data.color = rng.uniform(0.5, 1.0, 3).tolist()
    data.energy = float(rng.uniform(2.0, 4.0)) if kind == "SUN" else float(rng.uniform(300.0, 800.0))
    if kind == "SUN":
        data.angle = float(rng.uniform(0.15, 0.4))
    elif kind == "AREA":
        data.shape = chosen(rng, ["SQUARE", "RECTANGLE", "DISK", "ELLIPSE"])
        data.size, data.size_y = rng.uniform(0.6, 1.2, 2).tolist()
        data.spread = chosen(rng, [np.pi, 2.0])
    else:
        data.shadow_soft_size = float(rng.uniform(0.3, 0.6))
    if kind == "SPOT":
        data.spot_size, data.spot_blend, data.energy = chosen(rng, [0.6, 1.2]), chosen(rng, [0.1, 0.5, 1.0]), 2000.0
    lamp = bpy.data.objects.new("Lamp", data)
    bpy.context.scene.collection.objects.link(lamp)
    lamp.location = (rng.uniform(-2.5, 2.5), rng.uniform(-5.0, -1.5), rng.uniform(1.5, 4.5))
    towards = mirror.location + Vector(rng.normal(0.0, 0.3, 3).tolist()) - lamp.location
    lamp.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    return kind.lower() + " lamp"


def _view(rng: np.random.Generator) -> None:
    scene, camera = bpy.context.scene, bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera, camera.data.lens = camera, 45.0
    camera.location = (rng.uniform(-1.0, 4.0), -6.5, 3.5)
    camera.rotation_euler = (Vector((-0.5, -0.8, -0.8)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    scene.render.engine, scene.world = "CYCLES", None
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = SAMPLES, False, False
    cycles.caustics_refractive, cycles.blur_glossy, cycles.sample_clamp_indirect = False, 0.0, 0.0
    # light that goes on from what it lights is no part of the mesh; nor is what has met the mirror twice, which Cycles
    # follows by one bounce more than it is told
    cycles.diffuse_bounces, cycles.glossy_bounces = 1, 0


def _matt(obj: bpy.types.Object) -> None:
    """Take the gloss from what is matt, and all colour from what lies under a mirror's varnish."""
    for tree in [material.node_tree for material in getattr(obj.data, "materials", None) or ()]:
        for shader in tree.nodes:
            matt = shader.type == "BSDF_PRINCIPLED" and shader.inputs["Metallic"].default_value == 0.0
            if matt:
                shader.inputs["Specular IOR Level"].default_value = 0.0
            if obj.reflection_mesh.role == "MIRROR" and (matt or shader.type == "BSDF_DIFFUSE"):
                colour = shader.inputs["Base Color" if matt else "Color"]
                for link in list(colour.links):
                    tree.links.remove(link)
                colour.default_value = (0.0, 0.0, 0.0, 1.0)
