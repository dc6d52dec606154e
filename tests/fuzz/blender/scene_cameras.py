"""Cameras drawn at random: most see the mirror, some in an odd way, a few not at all."""
from __future__ import annotations

import bpy
import numpy as np
from mathutils import Vector

from tests.fuzz.blender.scene_shapes import chosen

KINDS = (*14 * ("perspective",), *4 * ("orthographic",), *2 * ("odd lens", "shifted", "clipped", "inside", "scaled",
         "odd pixels", "along an axis"), "panoramic", "turned away", "none", "on the mirror")
RESOLUTIONS = ((64, 64), (64, 64), (100, 80), (64, 90), (200, 200), (150, 4), (1, 1))
LARGE = ((128, 96), (200, 200), (256, 144), (300, 4))


def drawn_camera(rng: np.random.Generator, centre: Vector, direction: Vector, mirror: bpy.types.Object,
                 large: bool) -> str:
    """A camera in `direction` from `centre`, where the mirror stands, as the scene's; and what is special in it."""
    scene, kind = bpy.context.scene, chosen(rng, KINDS)
    scene.render.resolution_x, scene.render.resolution_y = chosen(rng, LARGE if large else RESOLUTIONS)
    scene.render.resolution_percentage = chosen(rng, [100, 100, 100, 50, 7])
    data = bpy.data.cameras.new("Camera")
    camera = bpy.data.objects.new("Camera", data)
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location = centre + direction * chosen(rng, [2.0, 5.0, 8.0])
    looks = direction if kind == "turned away" else -direction
    camera.rotation_euler = looks.to_track_quat("-Z", "Y").to_euler()
    if kind == "orthographic":
        data.type, data.ortho_scale = "ORTHO", chosen(rng, [4.0, 4.0, 10.0, 1e-3, 1e4])
    elif kind == "panoramic":
        data.type = "PANO"
    elif kind == "odd lens":
        data.lens = chosen(rng, [1.0, 500.0, 5000.0])
    elif kind == "shifted":
        data.shift_x, data.shift_y = rng.uniform(-1.0, 1.0, 2).tolist()
        data.sensor_fit = chosen(rng, ["AUTO", "VERTICAL", "HORIZONTAL"])
    elif kind == "clipped":
        data.clip_start, data.clip_end = chosen(rng, [(4.0, 5.0), (1e-6, 1e9), (0.1, 0.2), (100.0, 10.0)])
    elif kind in ("inside", "on the mirror"):
        camera.location = centre + direction * (0.1 if kind == "inside" else 0.0)
    elif kind == "scaled":
        camera.scale = chosen(rng, [(1.0, 1.0, -1.0), (2.0, 2.0, 2.0), (0.0, 1.0, 1.0), (1.0, 3.0, 1.0)])
    elif kind == "none":
        scene.camera = chosen(rng, [None, mirror])
    elif kind == "odd pixels":
        scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = chosen(rng, [(1.0, 7.0), (5.0, 1.0), (200.0, 1.0)])
    elif kind == "along an axis":
        camera.location, camera.rotation_euler = centre + Vector((0.0, 0.0, 5.0)), (0.0, 0.0, 0.0)
    return kind
