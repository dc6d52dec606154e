"""Makes the pictures of docs/tutorials.md from the software's own output.

    python -m tools.pictures.tutorials [folder] [picture ...]

Leaves `tutorial_still.jpg` (the room with the golden ball by EEVEE: as it is opened, after Generate, after Light, and
with a material of one's own) and `tutorial_farm.jpg` (what a job of Open Job Description has written, of which a task
came first that is not, and one was stopped half way; and the film) in the folder, docs/pictures/ by default; or the one
that is named.
"""
from __future__ import annotations

import sys
from pathlib import Path

from tools import extension_zip
from tools.pictures.farm import farm
from tools.pictures.samples import PANEL, SAMPLES, save

SCALE = 85  # per cent, at which the window below is as large as it is shown
WINDOW = 0.224, 0.212  # left and top, parts of the picture
EEVEE_SAMPLES = 32


def main(folder: Path, asked: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        for name, make in (("still", still), ("farm", farm)):
            if not asked or f"tutorial_{name}" in asked:
                make(folder / f"tutorial_{name}.jpg", scratch)


def still(path: Path, scratch: Path) -> None:
    """The room after each step of the tutorial, by EEVEE."""
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "room.blend"))
    scene = bpy.context.scene
    scene.render.engine = "BLENDER_EEVEE_NEXT" if bpy.app.version < (5, 0, 0) else "BLENDER_EEVEE"
    scene.render.resolution_percentage, scene.eevee.taa_render_samples = SCALE, EEVEE_SAMPLES
    made = [_rendered(scratch / "opened.png")]
    bpy.ops.reflection_mesh.generate(preview=True, collect=True, select_alone=True)
    made.append(_rendered(scratch / "preview.png"))
    bpy.ops.reflection_mesh.light()
    made.append(_rendered(scratch / "lit.png"))
    result = bpy.context.view_layer.objects.active
    own = bpy.data.materials.new("Own")
    if bpy.app.version < (5, 0, 0):
        own.use_nodes = True
    own.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (0.75, 0.04, 0.10, 1.0)
    ring = result.data.materials.find("Glaze")
    result.material_slots[ring].material = own
    made.append(_rendered(scratch / "own.png"))
    save(path, made, columns=len(made))


def _rendered(path: Path) -> Path:
    """The window of a render of the open file; what generates and lights sees the whole picture."""
    import bpy
    render = bpy.context.scene.render
    width = PANEL / (render.resolution_x * SCALE / 100)
    left, top = WINDOW
    render.border_min_x, render.border_max_x = left, left + width
    render.border_min_y, render.border_max_y = 1.0 - top - width, 1.0 - top
    render.use_border = render.use_crop_to_border = True
    render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    render.use_border = False
    return path


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures", sys.argv[2:])
