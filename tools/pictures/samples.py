"""Makes the README's pictures from the software's own output.

    python -m tools.pictures.samples [folder] [picture ...]

Leaves `sphere.jpg` (Cycles, the reflection mesh before a mirror that reflects the sky alone, the mesh's edges),
`samples.jpg` (the reflection mesh in each sample that emits what it shows), `mirrors.jpg` (mirrors in mirrors, by
Cycles and to a depth of 1, 2 and 3), `lit.jpg` (each lit sample by Cycles, as generated, and lit) and `eevee.jpg`
(the room by Cycles, by EEVEE's own ray tracing, and by EEVEE with the lit reflection) and `anamorphosis.jpg` (the
sheet that is printed, and the mirror on it by Cycles) in the folder, docs/pictures/ by default; or those of them that
are named.
"""
from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip

SAMPLES = extension_zip.ROOT / "sample_blends"
PANEL, GAP = 480, 6
LIT_BOX, BALL_BOX = (32, 80, 378, 378), (88, 80, 318, 310)  # left, top, right, bottom, of pictures of 409 pixels
LIT = ("room", "bathroom", "pond")
OWN_PICTURES = (*LIT, "anamorphosis", "pool", "ring", "sunlight", "dish")


def main(folder: Path, asked: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        for name, make in PICTURES.items():
            if not asked or name in asked:
                make(folder / f"{name}.jpg", scratch)


def samples(path: Path, scratch: Path) -> None:
    """The picture of the samples that emit what they show."""
    chosen = sorted(one for one in SAMPLES.glob("*.blend") if one.stem not in OWN_PICTURES)
    for one in chosen:
        _compare(one, scratch / one.stem)
    save(path, [scratch / one.stem / "result.png" for one in chosen], columns=4)


def sphere(path: Path, scratch: Path) -> None:
    """The picture of the sphere: by Cycles, its reflection, and the mesh's edges."""
    _compare(SAMPLES / "sphere.blend", scratch / "sphere")
    edges = _edges(scratch / "sphere", SAMPLES / "sphere.blend")
    save(path, [scratch / "sphere" / "reference.png", scratch / "sphere" / "result.png", edges],
         columns=3, crop=(212, 183, 772, 743))


def mirrors(path: Path, scratch: Path) -> None:
    """The picture of mirrors in mirrors: by Cycles, and to each depth."""
    for depth in (1, 2, 3):
        _compare(SAMPLES / "mirrors.blend", scratch / f"mirrors{depth}", depth)
    save(path, [scratch / "mirrors3" / "reference.png", *(
        scratch / f"mirrors{depth}" / "result.png" for depth in (1, 2, 3))], columns=2, crop=(100, 200, 924, 1024))


def light(path: Path, scratch: Path) -> None:
    """The picture of the lit samples: by Cycles, as they are generated, and lit."""
    for name in LIT:
        _lit(SAMPLES / f"{name}.blend", scratch / name)
    save(path, [scratch / name / f"{kind}.png" for name in LIT for kind in ("reference", "generated", "result")],
          columns=3, crop=(0, 0, LIT_BOX[2] - LIT_BOX[0], LIT_BOX[3] - LIT_BOX[1]))


def _lit(path: Path, folder: Path) -> None:
    """Three renders of a sample: without a reflection, with one, and with the same one lit."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(path))
    scene = bpy.context.scene
    scene.render.resolution_percentage = 40
    _crop(scene.render, LIT_BOX)
    scene.cycles.samples, scene.cycles.use_denoising = 32, True
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
    _crop(scene.render, BALL_BOX)
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
    save(path, pictures, columns=3, crop=(0, 0, BALL_BOX[2] - BALL_BOX[0], BALL_BOX[3] - BALL_BOX[1]))


def _crop(render, box: tuple) -> None:
    """Render a box (left, top, right, bottom) of pixels alone."""
    width, height = (side * render.resolution_percentage // 100 for side in (render.resolution_x, render.resolution_y))
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x = (box[0] + 0.5) / width, (box[2] + 0.5) / width
    render.border_min_y, render.border_max_y = 1.0 - (box[3] - 0.5) / height, 1.0 - (box[1] - 0.5) / height


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


PICTURES = {"samples": samples, "sphere": sphere, "mirrors": mirrors, "lit": light, "eevee": eevee,
            "anamorphosis": anamorphosis}

if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures", sys.argv[2:])
