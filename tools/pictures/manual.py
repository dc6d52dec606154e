"""Makes the manual's pictures of settings from the software's own output.

    python -m tools.pictures.manual [folder]

Leaves `tolerance.jpg` (0.5, 4 and 16 pixels, with the edges of the mesh), `placement.jpg` (layered, on the surface and
virtual, from beside the camera) and `made_of.jpg` (faces, and points with discs, of a coarse and a dense mesh) in the
folder, docs/pictures/ by default.
"""
from __future__ import annotations

import sys
from pathlib import Path

from tools import extension_zip
from tools.pictures.samples import SAMPLES, draw_edges, save

BALL = (212, 183, 772, 743)


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        made = [_tile(scratch / f"tolerance{value}.png", edges=True, tolerance=value) for value in (0.5, 4.0, 16.0)]
        save(folder / "tolerance.jpg", made, columns=3, crop=BALL)
        made = [_tile(scratch / f"{placement}.png", beside=True, placement=placement)
                for placement in ("LAYERED", "SURFACE", "VIRTUAL")]
        save(folder / "placement.jpg", made, columns=3, crop=(256, 256, 768, 768))
        made = [_tile(scratch / "faces.png"), _tile(scratch / "points.png", method="POINTS"),
                _tile(scratch / "dense.png", dense=True, method="POINTS")]
        save(folder / "made_of.jpg", made, columns=3, crop=BALL)


def _tile(path: Path, edges: bool = False, beside: bool = False, dense: bool = False, **settings) -> Path:
    """A render of the ball with its reflection by these settings of the scene.

    Parameters
    ----------
    edges : bool
        With the mesh's edges.
    beside : bool
        Not from where the reflection is right.
    dense : bool
        Of objects whose triangles are smaller than a pixel.
    """
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "sphere.blend"))
    scene = bpy.context.scene
    for name, value in settings.items():
        setattr(scene.reflection_mesh, name, value)
    if dense:
        for obj in scene.objects:
            if obj.type == "MESH" and obj.name not in {"Mirror Sphere", "Floor"}:
                obj.modifiers.new("Dense", "SUBSURF").levels = 5
                obj.modifiers["Dense"].subdivision_type = "SIMPLE"
    bpy.ops.reflection_mesh.generate()
    if edges:
        result = bpy.context.view_layer.objects.active
        for index, material in enumerate(result.data.materials):
            result.data.materials[index] = material.copy()
            draw_edges(result.data.materials[index].node_tree)
    if beside:
        from mathutils import Vector
        camera = scene.camera
        camera.location = (-5.2, -2.6, 3.0)
        camera.rotation_euler = (Vector((0.0, 0.0, 1.25)) - camera.location).to_track_quat("-Z", "Y").to_euler()
        camera.data.shift_x = camera.data.shift_y = 0.0
    scene.cycles.samples, scene.cycles.use_denoising = 16, False
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return path


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures")
