"""A flat tinted mirror over a floor with a lamp, and pictures of the light that it throws."""
from __future__ import annotations

import bpy
import numpy as np
import parts
from mathutils import Vector

SIZE = 64
COLOUR, TINT, ALBEDO = (1.0, 0.9, 0.8), (1.0, 0.6, 0.3), (0.8, 0.5, 0.2)
LAMPS = {"POINT": {"shadow_soft_size": 0.0}, "SPOT": {"shadow_soft_size": 0.0, "spot_size": 0.6, "spot_blend": 0.5},
         "SUN": {"angle": 0.0}, "AREA": {"size": 0.02}, "ELLIPSE": {"shape": "ELLIPSE", "size": 0.02, "size_y": 0.04},
         "SPREAD": {"size": 0.02, "spread": 1.2}}
AIM = Vector((1.2, 0.0, 0.7))
GLOW = (12.0, 9.0, 6.0)


def paint(name: str, kind: str, colour, socket: str = "Color") -> bpy.types.Material:
    made = parts.material(name, kind)
    made.node_tree.nodes[0].inputs[socket].default_value = (*colour, 1.0)
    return made


def add_lamp(name: str, kind: str, place, **values) -> bpy.types.Object:
    data = bpy.data.lights.new(name, kind if kind in {"POINT", "SPOT", "SUN"} else "AREA")
    data.energy, data.color = (5.0 if kind == "SUN" else 100.0), COLOUR
    for key, value in values.items():
        setattr(data, key, value)
    lamp = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(lamp)
    aim(lamp, place)
    return lamp


def aim(lamp: bpy.types.Object, place) -> None:
    lamp.location = place
    lamp.rotation_euler = (AIM - lamp.location).to_track_quat("-Z", "Y").to_euler()


def scene_of(kind: str = "POINT", **values) -> tuple:
    """A floor, an upright tinted mirror and a lamp, all selected, seen from above without other light."""
    scene = bpy.context.scene
    scene.render.engine, scene.world, scene.view_settings.view_transform = "CYCLES", None, "Raw"
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.sample_clamp_indirect, scene.cycles.use_denoising, scene.cycles.blur_glossy = 0.0, False, 0.0
    camera = scene.camera
    camera.location, camera.rotation_euler, camera.data.type, camera.data.ortho_scale = (0, 0, 6), (0, 0, 0), "ORTHO", 3
    floor = parts.add("plane", "Floor", size=20.0)
    floor.data.materials.append(paint("Paint", "DIFFUSE", ALBEDO))
    mirror = parts.add("plane", "Mirror", size=1.2, location=AIM, rotation=(0.0, -np.pi / 2, 0.0))
    mirror.data.materials.append(paint("Metal", "GLOSSY", TINT))
    lamp = add_lamp("Lamp", kind, (-0.9, 0.1, 1.8), **{**LAMPS[kind], **values})
    parts.select(floor, lamp, mirror)
    return floor, mirror, lamp


def glowing(name: str = "Glow", strength: float = 1.0) -> bpy.types.Material:
    made = parts.material(name)
    made.node_tree.nodes["Emission"].inputs["Color"].default_value = (*(value / 12.0 for value in GLOW), 1.0)
    made.node_tree.nodes["Emission"].inputs["Strength"].default_value = 12.0 * strength
    return made


def add_mesh_lamp(kind: str) -> bpy.types.Object:
    """A panel, a ball, or a box whose sides are dark, 0.3 wide."""
    if kind == "ball":
        lamp = parts.add("uv_sphere", "Lamp Mesh", radius=0.15, segments=16, ring_count=8)
    else:
        lamp = parts.add("plane" if kind == "panel" else "cube", "Lamp Mesh", size=0.3)
    lamp.data.materials.append(glowing())
    if kind == "box":
        lamp.data.materials.append(parts.material("Case", "DIFFUSE"))
        for face in lamp.data.polygons:
            face.material_index = 0 if face.normal.z < -0.9 else 1
    aim(lamp, (-0.9, 0.1, 1.8))
    return lamp


def rendered(tmp_path, samples: int = 16) -> np.ndarray:
    scene = bpy.context.scene
    scene.cycles.samples, scene.render.filepath = samples, str(tmp_path / "seen.exr")
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = np.empty(4 * SIZE * SIZE, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    bpy.data.images.remove(image)
    return pixels.reshape(SIZE, SIZE, 4)[..., :3].astype(np.float64)


def light_and_lamp_behind(mirror: bpy.types.Object, lamp: bpy.types.Object, tmp_path) -> tuple[np.ndarray, np.ndarray]:
    """Generate the mirror's light: its picture, and that of the lamp mirrored behind the mirror, which is gone then."""
    light = light_of_mirror(tmp_path)
    mirror.hide_render = True
    aim(lamp, (2.0 * AIM.x + 0.9, 0.1, 1.8))
    return light, rendered(tmp_path, 64) * TINT


def light_of_mirror(tmp_path) -> np.ndarray:
    """Generate the mirror's light: its picture alone; it is hidden then."""
    assert bpy.ops.reflection_mesh.caustics("EXEC_DEFAULT") == {"FINISHED"}
    result = bpy.data.objects["Mirror Caustics"]
    with_light = rendered(tmp_path)
    result.hide_render = True
    return with_light - rendered(tmp_path)


def ratios(light: np.ndarray, expected: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How much brighter pixels within the light (n, 3) are than expected, and what is expected there."""
    patch = inner(light)
    return (light / np.maximum(expected, 1e-12))[patch], expected[patch]


def inner(light: np.ndarray) -> np.ndarray:
    """The pixels of a patch that are not at its border."""
    lit = light[..., 0] > 0.1 * np.percentile(light[..., 0], 99)
    for _ in range(2):
        lit &= np.roll(lit, 1, 0) & np.roll(lit, -1, 0) & np.roll(lit, 1, 1) & np.roll(lit, -1, 1)
    return lit
