"""Scenes of `scenes` with lamps of all kinds, and how `reflection_mesh.caustics` is called, drawn from one seed."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from tests.fuzz.blender.scene_shapes import chosen
from tests.fuzz.blender.scenes import Scene, built

KINDS = ("POINT", "SPOT", "SUN", "AREA")
SHAPES = ("SQUARE", "RECTANGLE", "DISK", "ELLIPSE")


def built_with_lamps(seed: int) -> Scene:
    """Build the scene of a seed, the same every time, in a new empty file."""
    scene = built(seed)
    rng = np.random.default_rng((seed, 15))
    centre = scene.mirrors[0].matrix_world.translation
    names = [_lamp(rng, f"Lamp{number}", Vector(centre)) for number in range(chosen(rng, [1, 1, 2]))]
    names += _switched(np.random.default_rng((seed, 41)))
    render = bpy.context.scene
    render.render.engine = chosen(rng, ["CYCLES", "CYCLES", "BLENDER_WORKBENCH"])
    if render.render.engine == "CYCLES":
        render.cycles.caustics_reflective = chosen(rng, [True, True, False])
    options = {"eyes": chosen(rng, [1, 1, 3]), "depth": chosen(rng, [1, 1, 2]), "tolerance": chosen(rng, [0.5, 2.0]),
               "leave_out": chosen(rng, [True, True, False])}
    bpy.context.view_layer.update()
    names += [f"{name} {value}" for name, value in options.items()]
    return Scene(", ".join((scene.name, *names)), options, scene.mirrors)


def _switched(rng: np.random.Generator) -> list[str]:
    """Switch what says how a lamp's light falls off, and what mirrors show; told in words."""
    told = []
    for data in bpy.data.lights:
        if data.type in {"POINT", "SPOT"} and rng.random() < 0.3:
            data.use_soft_falloff = False
            told.append("hard falloff")
    for obj in bpy.context.scene.objects:
        if obj.type == "MESH" and rng.random() < 0.1:
            obj.visible_glossy = False
            told.append(f"{obj.name} in no mirror")
    return told


def _lamp(rng: np.random.Generator, name: str, centre: Vector) -> str:
    kind = chosen(rng, KINDS)
    data = bpy.data.lights.new(name, kind)
    data.energy, data.color = float(10.0 ** rng.uniform(-3, 4)), rng.uniform(0.0, 1.0, 3).tolist()
    size = chosen(rng, [0.0, 0.01, 0.3])
    if kind == "SUN":
        data.angle = size
    elif kind == "AREA":
        data.shape, data.size, data.size_y = chosen(rng, SHAPES), max(size, 0.01), 0.2
        data.spread = chosen(rng, [np.pi, 1.0, 0.01])
    else:
        data.shadow_soft_size = size
        if kind == "SPOT":
            data.spot_size, data.spot_blend = chosen(rng, [0.3, 1.5, np.pi]), chosen(rng, [0.0, 0.5, 1.0])
    lamp = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(lamp)
    lamp.location = centre + Vector(rng.normal(0.0, chosen(rng, [0.2, 2.0, 20.0]), 3).tolist())
    towards = centre + Vector(rng.normal(0.0, 0.3, 3).tolist()) - lamp.location
    lamp.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
    lamp.scale = [0.0 if rng.random() < 0.01 else chosen(rng, [1.0, 1.0, 1.0, -2.0, 0.5]) for _ in range(3)]
    if rng.random() < 0.1:
        lamp.hide_render = True
    if rng.random() < 0.5:
        lamp.select_set(True)
    return kind.lower() + " lamp"
