"""A newcomer's own scene, lit, textured and animated."""
from __future__ import annotations

import bpy
import numpy as np
import parts
from lamp_scenes import SIZE, patterned, principled


def room_of(context: bpy.types.Context, balls: int) -> bpy.types.Object:
    """A tiled room with as many balls on its floor, two lamps, a curved mirror of metal, and a camera that moves."""
    floor = parts.add("plane", "Floor", size=12.0)
    floor.data.materials.append(patterned("Object"))
    back = parts.add("plane", "Wall", size=12.0, location=(0.0, -7.0, 3.0), rotation=(np.pi / 2, 0.0, 0.0))
    back.data.materials.append(principled("Plaster", (0.3, 0.5, 0.8)))
    rng = np.random.default_rng(5)
    for number in range(balls):
        ball = parts.add("uv_sphere", f"Ball {number}", segments=16, ring_count=8, radius=0.25,
                         location=(*rng.uniform((-3.0, -5.5), (3.0, -1.5)), 0.25))
        ball.data.materials.append(principled(f"Paint {number}", rng.uniform(0.1, 0.9, 3)))
    mirror = parts.add("uv_sphere", "Metal", segments=48, ring_count=24, radius=1.4, location=(0.0, 0.6, 1.4))
    mirror.data.shade_smooth()
    mirror.data.materials.append(principled("Metal", (0.95, 0.8, 0.6), Metallic=1.0, Roughness=0.0))
    for kind, place, energy in (("POINT", (2.0, -4.0, 4.0), 400.0), ("AREA", (-2.0, -3.0, 5.0), 300.0)):
        bpy.ops.object.light_add(type=kind, location=place)
        bpy.context.object.data.energy = energy
    camera = context.scene.camera
    camera.keyframe_insert("location", frame=1)
    camera.location.x += 1.0
    camera.keyframe_insert("location", frame=24)
    scene = context.scene
    scene.frame_set(1)
    scene.render.engine, scene.view_settings.view_transform = "CYCLES", "Standard"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = 64, False, False
    return mirror
