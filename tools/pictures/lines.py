"""Makes the pictures of docs/lines.md: what Line Art and Freestyle draw of reflections.

    python -m tools.pictures.lines [folder]

Leaves `line_art.jpg` (a still life round a silver ball as Line Art draws it, without the reflection and with it) and
`freestyle.jpg` (the same by Cycles with Freestyle's lines, before and after) in the folder, docs/pictures/ by default.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip

SIZE, GAP = 640, 6
INK = (0.03, 0.03, 0.05)


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        still_life()
        by_line_art = [_line_art(scratch / "plain.png"), None]
        by_freestyle = [_freestyle(scratch / "cycles.png"), None]
        import bpy
        render = bpy.context.scene.render
        render.use_freestyle = True  # results are made for lines where there are some
        bpy.ops.reflection_mesh.generate()
        render.use_freestyle = False
        by_line_art[1] = _line_art(scratch / "reflected.png")
        bpy.ops.reflection_mesh.light(samples=128)
        by_freestyle[1] = _freestyle(scratch / "inked.png")
        _beside(folder / "line_art.jpg", by_line_art)
        _beside(folder / "freestyle.jpg", by_freestyle)


def still_life() -> None:
    """A silver ball on a floor, among solids, with roles and a camera."""
    import bpy
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = bpy.context.scene
    add = bpy.ops.mesh
    add.primitive_plane_add(size=14.0)
    _named("Floor", (0.86, 0.84, 0.8))
    add.primitive_cube_add(size=1.1, location=(-2.1, -2.2, 0.56), rotation=(0.0, 0.0, 0.5))
    _named("Box", (0.85, 0.45, 0.3))
    add.primitive_monkey_add(size=1.7, location=(1.9, -2.3, 0.75), rotation=(-0.6, 0.0, 2.9))
    bpy.ops.object.subdivision_set(level=2)
    bpy.context.object.modifiers[0].render_levels = 2
    _named("Suzanne", (0.9, 0.72, 0.4), smooth=True)
    add.primitive_cylinder_add(radius=0.4, depth=1.2, vertices=64, location=(-0.85, -3.2, 0.61))
    _named("Cylinder", (0.4, 0.6, 0.55))
    add.primitive_torus_add(major_radius=0.55, minor_radius=0.2, major_segments=96, minor_segments=32,
                            location=(0.55, -2.9, 0.21))
    _named("Ring", (0.45, 0.55, 0.8), smooth=True)
    add.primitive_cone_add(radius1=0.55, depth=1.4, vertices=64, location=(3.1, -1.3, 0.71))
    _named("Cone", (0.75, 0.5, 0.65))
    add.primitive_uv_sphere_add(radius=2.2, segments=128, ring_count=64, location=(0.07, 0.6, 2.2))
    _named("Ball", (1.0, 1.0, 1.0), smooth=True, metallic=1.0)
    bpy.ops.object.light_add(type="AREA", location=(-4.0, -6.0, 7.0), rotation=(0.75, 0.0, -0.6))
    bpy.context.object.data.energy, bpy.context.object.data.size = 900.0, 4.0
    bpy.ops.object.camera_add(location=(0.0, -9.0, 4.4), rotation=(1.26, 0.0, 0.0))
    scene.camera = bpy.context.object
    scene.camera.data.lens = 54.0
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.5, 0.5, 0.5)
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.view_settings.view_transform = "Standard"
    bpy.ops.object.select_all(action="DESELECT")


def _named(name: str, colour: tuple, *, smooth: bool = False, metallic: float = 0.0) -> None:
    """Name the active object, give it a material and its role."""
    import bpy
    obj = bpy.context.object
    obj.name = name
    material = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Metallic"].default_value = metallic
    shader.inputs["Roughness"].default_value = 1.0 - metallic
    obj.data.materials.append(material)
    if smooth:
        bpy.ops.object.shade_smooth()
    obj.reflection_mesh.role = "MIRROR" if metallic else "DIFFUSE"


def _line_art(path: Path) -> Path:
    """Line Art's lines of the whole scene by its defaults, on white paper; nothing of it stays."""
    import bpy
    scene = bpy.context.scene
    bpy.ops.object.grease_pencil_add(type="LINEART_SCENE")
    lines = bpy.context.object
    lines.modifiers[0].radius = 0.011
    ink = lines.modifiers[0].target_material
    ink.grease_pencil.color = (*INK, 1.0)
    paper = bpy.data.materials.new("Paper")
    if bpy.app.version < (5, 0, 0):
        paper.use_nodes = True
    tree = paper.node_tree
    tree.nodes.clear()
    tree.links.new(tree.nodes.new("ShaderNodeEmission").outputs[0],
                   tree.nodes.new("ShaderNodeOutputMaterial").inputs[0])
    layer = bpy.context.view_layer
    layer.material_override = paper
    engine, world = scene.render.engine, scene.world
    scene.world = bpy.data.worlds.new("Paper")
    scene.world.color = (1.0, 1.0, 1.0)
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 4
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    scene.render.engine, scene.world, layer.material_override = engine, world, None
    bpy.data.objects.remove(lines)
    return path


def _freestyle(path: Path) -> Path:
    """Cycles' picture with Freestyle's lines: silhouettes, borders, creases and marked edges."""
    import bpy
    scene, layer = bpy.context.scene, bpy.context.view_layer
    scene.render.engine, scene.cycles.samples = "CYCLES", 48
    scene.render.use_freestyle = layer.use_freestyle = True
    # of reflections Freestyle draws silhouettes and marked edges alone
    reflections = bpy.data.collections.new("Reflections")
    scene.collection.children.link(reflections)
    for obj in list(scene.objects):
        if obj.reflection_mesh.role == "REFLECTION":
            reflections.objects.link(obj)
    sets = layer.freestyle_settings.linesets
    while len(sets):
        sets.remove(sets[0])
    for side in ("EXCLUSIVE", "INCLUSIVE"):
        lines = sets.new(side)
        lines.select_by_collection, lines.collection, lines.collection_negation = True, reflections, side
        lines.select_crease = lines.select_border = side == "EXCLUSIVE"
        lines.select_edge_mark = True
        lines.linestyle = lines.linestyle or bpy.data.linestyles.new("Ink")
        lines.linestyle.color, lines.linestyle.thickness = INK, 1.8
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    scene.render.use_freestyle = False
    bpy.data.collections.remove(reflections)
    return path


def _beside(path: Path, pictures: list) -> None:
    """Two pictures side by side on white."""
    sheet = np.full((SIZE, 2 * SIZE + GAP, 3), 255, dtype=np.uint8)
    for column, picture in enumerate(pictures):
        left = column * (SIZE + GAP)
        sheet[:, left:left + SIZE] = np.asarray(Image.open(picture).convert("RGB"))
    Image.fromarray(sheet).save(path, quality=88, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures")
