"""Makes the picture of docs/results.md of one mirror that two cameras see.

    python -m tools.pictures.cameras [folder]

Leaves `two_cameras.jpg` in the folder, docs/pictures/ by default: what each of two cameras sees of its own result, and
what the second one sees of the first one's.
"""
from __future__ import annotations

import sys
from pathlib import Path

from tools import extension_zip
from tools.pictures.manual import _generate, _leave_sky, _opened, _rendered
from tools.pictures.samples import save

PLACE, AIM, LENS = (-5.2, -2.6, 3.0), (0.0, 0.0, 1.15), 50.0  # of the second camera
BOX = (172, 172, 832, 832)
RAYS = 48  # per pixel


def main(folder: Path) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        made = two_cameras(scratch)
        save(folder / "two_cameras.jpg", made, columns=len(made), crop=BOX)


def two_cameras(scratch: Path) -> list[Path]:
    """The mirror itself shows the sky alone, so that what is seen in it is the results."""
    import bpy
    scene = _opened("sphere")
    mirror = scene.objects["Mirror Sphere"]
    sources = [obj for obj in scene.objects if obj.type == "MESH" and obj != mirror]
    results, cameras = [_generate()], [scene.camera, _second_camera()]
    scene.camera = cameras[1]
    bpy.ops.object.select_all(action="DESELECT")
    mirror.select_set(True)
    bpy.context.view_layer.objects.active = mirror
    results.append(_generate())
    _leave_sky(sources)
    made = []
    for camera in cameras:
        scene.camera = camera
        bpy.context.view_layer.update()
        made.append(_rendered(scratch / f"{camera.name}.png", RAYS))
    results[0].hide_render, results[1].hide_render = False, True
    return [*made, _rendered(scratch / "other.png", RAYS)]


def _second_camera():
    """Another camera of the open file, beside the mirror."""
    import bpy
    from mathutils import Vector
    data = bpy.data.cameras.new("Second")
    data.lens = LENS
    camera = bpy.data.objects.new("Second", data)
    camera.location = PLACE
    camera.rotation_euler = (Vector(AIM) - Vector(PLACE)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(camera)
    return camera


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures")
