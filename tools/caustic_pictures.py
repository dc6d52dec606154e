"""The pictures of docs/caustics.md: light that mirrors throw, by Cycles and by *Generate Caustics*.

    python tools/caustic_pictures.py [folder]

Leaves `caustics.jpg` in the folder, docs/ by default: the sample `ring`, and waves that throw sunlight on a wall; left
Cycles' own caustics, right the meshes of light, both at as many samples per pixel.
"""
from __future__ import annotations

import sys
from pathlib import Path

import extension_zip
import numpy as np
from PIL import Image

ROOT = Path(__file__).resolve().parent.parent
SIZE, SAMPLES = 420, 48


def main(folder: Path) -> None:
    with extension_zip.installed() as scratch:
        rows = [np.concatenate([_rendered(scene, own, scratch) for own in (True, False)], axis=1)
                for scene in (_ring, _waves)]
        Image.fromarray(np.concatenate(rows)).save(folder / "caustics.jpg", quality=88)


def _rendered(make, own: bool, scratch: Path) -> np.ndarray:
    """The scene with Cycles' own caustics or with ours, (SIZE, SIZE, 3) bytes."""
    import bpy
    make()
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, False
    scene.cycles.blur_glossy = scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.transparent_max_bounces = 64
    if not own:
        bpy.ops.reflection_mesh.caustics()
    scene.render.filepath = str(scratch / "seen.png")
    bpy.ops.render.render(write_still=True)
    return np.asarray(Image.open(scene.render.filepath).convert("RGB"))


def _ring() -> None:
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "ring.blend"))


def _waves() -> None:
    """A metal as wavy as water before a wall, in the sun."""
    import bpy
    from mathutils import Vector
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_blends" / "ring.blend"))
    scene = bpy.context.scene
    gold = bpy.data.materials["Gold"]
    gold.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.9, 0.95, 1.0, 1.0)
    for name in ("Ring", "Dice", "Table", "Lamp"):
        bpy.data.objects.remove(bpy.data.objects[name])
    count = 96
    x, y = np.meshgrid(np.linspace(-2.0, 2.0, count), np.linspace(-2.2, 1.4, count), indexing="ij")
    z = (0.012 * np.sin(3.1 * x + 4.7 * y) + 0.010 * np.sin(-5.3 * x + 2.9 * y + 1.0) + 0.007 * np.sin(
        7.1 * x + 1.3 * y + 2.0) + 0.006 * np.sin(-2.2 * x + 8.3 * y + 0.5))
    index = np.arange(count * count).reshape(count, count)
    quads = np.stack((index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]), axis=-1).reshape(-1, 4)
    mesh = bpy.data.meshes.new("Water")
    mesh.from_pydata(np.stack((x, y, z), axis=-1).reshape(-1, 3).tolist(), [], quads.tolist())
    mesh.shade_smooth()
    mesh.materials.append(gold)
    water = bpy.data.objects.new("Water", mesh)
    scene.collection.objects.link(water)
    bpy.ops.mesh.primitive_plane_add(size=6.0, location=(0.0, 1.5, 2.0), rotation=(np.pi / 2, 0.0, 0.0))
    wall = bpy.context.object
    wall.data.materials.append(bpy.data.materials.new("Plaster"))
    if bpy.app.version < (5, 0, 0):
        wall.active_material.use_nodes = True
    shader = wall.active_material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (0.75, 0.70, 0.62, 1.0)
    shader.inputs["Roughness"].default_value, shader.inputs["Specular IOR Level"].default_value = 1.0, 0.0
    sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.data.energy, sun.data.angle = 1.3, 0.009
    sun.rotation_euler = Vector((0.25, 1.0, -0.9)).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(sun)
    camera = scene.camera
    camera.location = (-0.8, -4.4, 1.9)
    camera.rotation_euler = (Vector((0.1, 1.0, 0.9)) - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 42
    bpy.context.view_layer.update()
    for obj in scene.objects:
        obj.select_set(obj in (water, wall, sun))
    bpy.context.view_layer.objects.active = water


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs")
