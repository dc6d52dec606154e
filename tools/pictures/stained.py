"""The picture of docs/caustics.md on stained mirrors: what one throws, by Cycles and by *Generate Caustics*.

    python -m tools.pictures.stained [folder]

Leaves `stained.jpg` in the folder, docs/pictures/ by default: left Cycles' own caustics with 1024 samples per pixel,
right the mesh of light with 64.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip

from .caustics import _beside

SIZE, OWN_SAMPLES, SAMPLES = 540, 1024, 64


def main(folder: Path) -> None:
    with extension_zip.installed() as scratch:
        pictures = [_rendered(own, scratch) for own in (True, False)]
    Image.fromarray(_beside(pictures)).save(folder / "stained.jpg", quality=88)


def _rendered(own: bool, scratch: Path) -> np.ndarray:
    """The scene with Cycles' own caustics or with ours, (SIZE, SIZE, 3) bytes."""
    import bpy
    _build()
    scene = bpy.context.scene
    scene.cycles.samples = OWN_SAMPLES if own else SAMPLES
    if not own:
        bpy.ops.reflection_mesh.caustics()
    scene.render.filepath = str(scratch / "seen.png")
    bpy.ops.render.render(write_still=True)
    return np.asarray(Image.open(scene.render.filepath).convert("RGB"))


def _build() -> None:
    """A curved mirror of coloured cells on a floor, a lamp before it, and a wall beside."""
    import bpy
    bpy.ops.wm.read_homefile(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine, scene.render.resolution_x, scene.render.resolution_y = "CYCLES", SIZE, SIZE
    # nothing that keeps Cycles from finding its own
    scene.cycles.blur_glossy = scene.cycles.sample_clamp_indirect = 0.0
    scene.cycles.use_denoising = True
    bpy.ops.mesh.primitive_plane_add(size=12.0)
    bpy.context.object.data.materials.append(_material("Floor", (0.6, 0.6, 0.6)))
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=64, y_subdivisions=2, size=1.5, location=(0.0, 1.6, 0.8),
                                    rotation=(np.pi / 2, 0.0, 0.0))
    mirror = bpy.context.object
    mirror.name = "Mirror"
    for vertex in mirror.data.vertices:  # a hollow cylinder
        vertex.co.z += 0.25 * vertex.co.x**2
    mirror.data.materials.append(_stained())
    mirror.data.shade_smooth()
    data = bpy.data.lights.new("Lamp", "SPOT")
    data.energy, data.shadow_soft_size, data.spot_size, data.spot_blend = 700.0, 0.05, 0.7, 0.2
    lamp = bpy.data.objects.new("Lamp", data)
    scene.collection.objects.link(lamp)
    lamp.location = (-1.2, -1.4, 2.6)
    _look(lamp, (0.0, 1.6, 0.8))
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(camera)
    scene.camera = camera
    camera.location, camera.data.lens = (2.0, -4.4, 3.6), 45.0
    _look(camera, (0.15, 0.3, 0.1))
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.12, 0.12, 0.13)
    mirror.select_set(True)
    bpy.context.view_layer.objects.active = mirror
    bpy.context.view_layer.update()


def _material(name: str, colour: tuple):
    import bpy
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    made.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*colour, 1.0)
    made.node_tree.nodes["Principled BSDF"].inputs["Roughness"].default_value = 1.0
    made.node_tree.nodes["Principled BSDF"].inputs["Specular IOR Level"].default_value = 0.0
    return made


def _stained():
    import bpy
    made = bpy.data.materials.new("Stained")
    made.use_nodes = True
    tree = made.node_tree
    shader = tree.nodes["Principled BSDF"]
    shader.inputs["Metallic"].default_value, shader.inputs["Roughness"].default_value = 1.0, 0.0
    place, cells = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexVoronoi")
    vivid = tree.nodes.new("ShaderNodeHueSaturation")
    cells.inputs["Scale"].default_value = 6.0
    vivid.inputs["Saturation"].default_value, vivid.inputs["Value"].default_value = 1.6, 1.2
    tree.links.new(place.outputs["UV"], cells.inputs["Vector"])
    tree.links.new(cells.outputs["Color"], vivid.inputs["Color"])
    tree.links.new(vivid.outputs["Color"], shader.inputs["Base Color"])
    return made


def _look(obj, at: tuple) -> None:
    from mathutils import Vector
    obj.rotation_euler = (Vector(at) - Vector(obj.location)).to_track_quat("-Z", "Y").to_euler()


if __name__ == "__main__":
    main(Path(sys.argv[1]) if sys.argv[1:] else extension_zip.ROOT / "docs" / "pictures")
