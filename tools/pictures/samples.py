"""Makes the README's pictures from the software's own output.

    python -m tools.pictures.samples [folder]

Leaves `sphere.jpg` (Cycles, the reflection mesh before a mirror that reflects the sky alone, the mesh's edges),
`samples.jpg` (the reflection mesh in each sample that emits what it shows), `mirrors.jpg` (mirrors in mirrors, by
Cycles and to a depth of 1, 2 and 3), `lit.jpg` (each lit sample by Cycles, as generated, and lit) and `eevee.jpg`
(the room by Cycles, by EEVEE's own ray tracing, and by EEVEE with the lit reflection) and `anamorphosis.jpg` (the
sheet that is printed, and the mirror on it by Cycles) in the folder, docs/pictures/ by default.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip

SAMPLES = extension_zip.ROOT / "sample_blends"
PANEL, GAP = 480, 6
LIT = ("room", "bathroom", "pond")
OWN_PICTURES = (*LIT, "anamorphosis", "pool", "ring", "sunlight", "dish")


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        samples = sorted(path for path in SAMPLES.glob("*.blend") if path.stem not in OWN_PICTURES)
        for path in samples:
            _compare(path, scratch / path.stem)
        save(folder / "samples.jpg", [scratch / path.stem / "result.png" for path in samples], columns=4)
        edges = _edges(scratch / "sphere", SAMPLES / "sphere.blend")
        save(folder / "sphere.jpg", [scratch / "sphere" / "reference.png", scratch / "sphere" / "result.png", edges],
              columns=3, crop=(212, 183, 772, 743))
        mirrors = SAMPLES / "mirrors.blend"
        for depth in (1, 2, 3):
            _compare(mirrors, scratch / f"mirrors{depth}", depth)
        save(folder / "mirrors.jpg", [scratch / "mirrors3" / "reference.png", *(
            scratch / f"mirrors{depth}" / "result.png" for depth in (1, 2, 3))], columns=2, crop=(100, 200, 924, 1024))
        light(folder / "lit.jpg", scratch)
        eevee(folder / "eevee.jpg", scratch)
        anamorphosis(folder / "anamorphosis.jpg", scratch)


def light(path: Path, scratch: Path) -> None:
    """The picture of the lit samples: by Cycles, as they are generated, and lit."""
    for name in LIT:
        _lit(SAMPLES / f"{name}.blend", scratch / name)
    save(path, [scratch / name / f"{kind}.png" for name in LIT for kind in ("reference", "generated", "result")],
          columns=3, crop=(32, 80, 378, 378))


def _lit(path: Path, folder: Path) -> None:
    """Three renders of a sample: without a reflection, with one, and with the same one lit."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    scene.render.resolution_percentage = 40
    scene.cycles.samples, scene.cycles.use_denoising = 64, False
    for name, work in (("reference", None), ("generated", bpy.ops.reflection_mesh.generate),
                       ("result", bpy.ops.reflection_mesh.light)):
        if work is not None:
            work()
        scene.render.filepath = str(folder / f"{name}.png")
        bpy.ops.render.render(write_still=True)


def eevee(path: Path, scratch: Path) -> None:
    """The picture of the room in EEVEE."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "room.blend"))
    scene = bpy.context.scene
    scene.render.resolution_percentage = 40
    scene.cycles.samples, scene.eevee.taa_render_samples, scene.eevee.use_raytracing = 128, 32, True
    own = "BLENDER_EEVEE_NEXT" if bpy.app.version < (5, 0, 0) else "BLENDER_EEVEE"
    pictures = []
    for name, engine in (("cycles", "CYCLES"), ("own", own), ("lit", own)):
        if name == "lit":
            bpy.ops.reflection_mesh.generate()
            bpy.ops.reflection_mesh.light()
        scene.render.engine = engine
        pictures.append(scratch / f"eevee_{name}.png")
        scene.render.filepath = str(pictures[-1])
        bpy.ops.render.render(write_still=True)
    save(path, pictures, columns=3, crop=(88, 80, 318, 310))


def anamorphosis(path: Path, scratch: Path) -> None:
    """The sheet of the sample, as it is printed, and what the camera sees of it and its mirror."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "anamorphosis.blend"))
    bpy.ops.reflection_mesh.mirror_uvs(picture="Compass", frame="WHOLE")
    sheet = bpy.data.objects["Sheet Anamorphosis"]
    bpy.context.view_layer.objects.active = sheet
    printed, shown = scratch / "sheet.png", scratch / "anamorphosis.png"
    bpy.ops.reflection_mesh.print_sheet(filepath=str(printed), dpi=100.0)
    # on white, with a border around the paper
    paper = np.asarray(Image.open(printed).convert("RGB"))
    square = np.full((paper.shape[1], paper.shape[1], 3), 225, dtype=np.uint8)
    top = (paper.shape[1] - paper.shape[0]) // 2
    square[top:top + paper.shape[0]] = paper
    Image.fromarray(square).save(printed)
    scene = bpy.context.scene
    scene.render.resolution_percentage = 50
    scene.cycles.samples, scene.cycles.use_denoising = 64, False
    scene.render.filepath = str(shown)
    bpy.ops.render.render(write_still=True)
    save(path, [printed, shown], columns=2)


def _compare(path: Path, folder: Path, depth: int = 1) -> None:
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(path))
    bpy.ops.reflection_mesh.generate(depth=depth)
    bpy.ops.reflection_mesh.compare(filepath=str(folder), samples=32)


def _edges(folder: Path, path: Path) -> Path:
    """The reflection with its edges drawn, which shows that it is a mesh."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(path))
    bpy.ops.reflection_mesh.generate()
    result = bpy.context.view_layer.objects.active
    for index, material in enumerate(result.data.materials):
        copy = material.copy()
        result.data.materials[index] = copy
        draw_edges(copy.node_tree)
    for source in result.reflection_mesh.sources:
        source.object.visible_glossy = False
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.use_denoising = 32, False
    scene.render.filepath = str(folder / "edges.png")
    bpy.ops.render.render(write_still=True)
    return folder / "edges.png"


def draw_edges(tree) -> None:
    """Mix the colour that a material emits with dark edges."""
    emission = next(node for node in tree.nodes if node.type == "EMISSION")
    wire, mix = tree.nodes.new("ShaderNodeWireframe"), tree.nodes.new("ShaderNodeMix")
    wire.use_pixel_size = True
    wire.inputs["Size"].default_value = 0.7
    mix.data_type = "RGBA"
    inputs = [socket for socket in mix.inputs if socket.type == "RGBA"]
    output = next(socket for socket in mix.outputs if socket.type == "RGBA")
    tree.links.new(wire.outputs["Fac"], mix.inputs[0])
    tree.links.new(emission.inputs["Color"].links[0].from_socket, inputs[0])
    inputs[1].default_value = (0.0, 0.0, 0.0, 1.0)
    tree.links.new(output, emission.inputs["Color"])


def save(path: Path, pictures: list[Path], columns: int, crop: tuple | None = None) -> None:
    """Set pictures, or the boxes (left, top, right, bottom) of them, side by side on white."""
    left, top, right, bottom = crop or (0, 0, 1, 1)
    height = round(PANEL * (bottom - top) / (right - left))
    panels = [np.asarray(Image.open(picture).convert("RGB").resize((PANEL, height), Image.Resampling.LANCZOS, crop))
              for picture in pictures]
    rows = -(-len(panels) // columns)
    down, across = height + GAP, PANEL + GAP
    sheet = np.full((rows * down - GAP, columns * across - GAP, 3), 255, dtype=np.uint8)
    for index, panel in enumerate(panels):
        low, beside = index // columns * down, index % columns * across
        sheet[low:low + height, beside:beside + PANEL] = panel
    Image.fromarray(sheet).save(path, quality=90, optimize=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures")
