"""Makes the pictures of docs/anamorphosis.md that show what its options do, and another mirror.

    python -m tools.pictures.anamorphosis [folder] [picture ...]

Leaves `fills.jpg` (what the tube of the sample shows by each choice of *Picture Fills*) and `cone.jpg` (a sheet for a
cone that is seen from above its tip: printed, round the cone, and the cone alone) in the folder, docs/pictures/
by default; or the one of them that is named. `anamorphosis.jpg` is one of tools/pictures/samples.py.
"""
from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from PIL import Image

from tools import extension_zip
from tools.pictures.samples import SAMPLES, save

FILLS = ("CAMERA", "WHOLE", "MIRROR")
TUBE = (0.22, 0.03, 0.78, 0.67)  # parts of the sample's picture: left, top, right, bottom
SAMPLES_PER_PIXEL = 64
# of the cone, in metres and radians: a ray from above leaves it at twice the angle between its side and its axis
RADIUS, TIP, SLANT, ROUND = 0.046, 0.0001, math.radians(30.0), 256
SIDE, EYE = 0.32, 0.9  # of the sheet, and how high the camera stands
# a pixel at the tip is a strip along the rim of what is printed: a large picture, and a sheet of many faces
SIZE, FACES = 2000, 16
CONE = (0.36, 0.36, 0.64, 0.64)


def main(folder: Path, asked: list[str]) -> None:
    folder.mkdir(parents=True, exist_ok=True)
    with extension_zip.installed() as scratch:
        for name, make in (("fills", fills), ("cone", cone)):
            if not asked or name in asked:
                make(folder / f"{name}.jpg", scratch)


def fills(path: Path, scratch: Path) -> None:
    """What the tube shows with each choice of *Picture Fills*."""
    import bpy
    made = []
    for frame in FILLS:
        bpy.ops.wm.open_mainfile(filepath=str(SAMPLES / "anamorphosis.blend"))
        bpy.ops.reflection_mesh.mirror_uvs(picture="Compass", frame=frame)
        made.append(_rendered(scratch / f"{frame}.png", 84, TUBE))
    save(path, made, columns=len(made), crop=_whole(made[0]))


def cone(path: Path, scratch: Path) -> None:
    """A sheet for a cone."""
    import bpy
    portrait = _portrait(scratch / "portrait.png")
    _cone_on_sheet()
    bpy.ops.reflection_mesh.mirror_uvs(picture=str(portrait), frame="MIRROR")
    bpy.context.view_layer.objects.active = bpy.data.objects["Sheet Anamorphosis"]
    printed = scratch / "printed.png"
    bpy.ops.reflection_mesh.print_sheet(filepath=str(printed), dpi=100.0)
    save(path, [printed, _rendered(scratch / "round.png", 30), _rendered(scratch / "cone.png", 100, CONE)], columns=3)


def _portrait(path: Path) -> Path:
    """Suzanne on a ground of one colour, as a picture to be put on the sheet."""
    import bpy
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    _scene(1024)
    bpy.ops.mesh.primitive_monkey_add(size=2.0, rotation=(-0.05, 0.0, 0.0))
    head = bpy.context.object
    head.modifiers.new("Smooth", "SUBSURF").render_levels = 3
    head.data.shade_smooth()
    head.data.materials.append(_material("Clay", (0.80, 0.33, 0.10), Roughness=0.6))
    bpy.ops.mesh.primitive_plane_add(size=30.0, location=(0.0, 3.0, 0.0), rotation=(math.pi / 2, 0.0, 0.0))
    bpy.context.object.data.materials.append(_material("Ground", (0.10, 0.32, 0.42), Roughness=1.0))
    _lamp((-3.0, -6.0, 5.0), (0.0, 0.0, 0.0), 700.0, 2.0)
    _camera((0.0, -8.0, -0.1), (0.0, 0.0, -0.1), 94.0)
    return _rendered(path, 100)


def _cone_on_sheet() -> None:
    """A cone of mirror on a sheet of paper, and a camera above its tip; cone and sheet are selected."""
    import bpy
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    scene = _scene(SIZE)
    bpy.ops.mesh.primitive_grid_add(x_subdivisions=FACES, y_subdivisions=FACES, size=SIDE)
    sheet = bpy.context.object
    sheet.name = "Sheet"
    sheet.data.materials.append(_material("Paper", (0.8, 0.8, 0.8), Roughness=1.0))
    bpy.ops.mesh.primitive_plane_add(size=3.0, location=(0.0, 0.0, -0.001))
    bpy.context.object.data.materials.append(_material("Table", (0.16, 0.075, 0.035), Roughness=0.7))
    mirror = _cone()
    _lamp((-0.6, 0.5, 1.2), (0.0, 0.0, 0.0), 14.0, 0.5)
    _camera((0.0, 0.0, EYE), (0.0, 0.0, 0.0), 36.0 * EYE / (1.12 * SIDE))
    scene.cycles.caustics_reflective = False
    bpy.ops.object.select_all(action="DESELECT")
    for obj in (sheet, mirror):
        obj.select_set(True)
    bpy.context.view_layer.objects.active = mirror


def _cone():
    """The side of a cone, whose normals are those of a cone up to its tip, where an edge as wide as a hair is."""
    import bpy
    from_tip = np.linspace(TIP, RADIUS, 25)
    angle = 2.0 * np.pi * np.arange(ROUND) / ROUND
    ring = np.column_stack((np.cos(angle), np.sin(angle)))
    points = np.concatenate([np.column_stack((radius * ring, np.full(ROUND, (RADIUS - radius) / math.tan(SLANT))))
                             for radius in from_tip])
    first = (np.arange(len(from_tip) - 1)[:, None] * ROUND + np.arange(ROUND)).ravel()
    after = first // ROUND * ROUND + (first + 1) % ROUND
    mesh = bpy.data.meshes.new("Cone")
    mesh.from_pydata(points.tolist(), [], np.column_stack((first, first + ROUND, after + ROUND, after)).tolist())
    mesh.shade_smooth()
    mesh.materials.append(_material("Mirror", (1.0, 1.0, 1.0), Metallic=1.0, Roughness=0.0))
    mirror = bpy.data.objects.new("Cone", mesh)
    bpy.context.scene.collection.objects.link(mirror)
    return mirror


def _scene(size: int):
    import bpy
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = size
    scene.view_settings.view_transform = "Standard"
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0.35, 0.35, 0.36)
    return scene


def _material(name: str, colour: tuple, **values: float):
    import bpy
    made = bpy.data.materials.new(name)
    if bpy.app.version < (5, 0, 0):
        made.use_nodes = True
    shader = made.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    for key, value in values.items():
        shader.inputs[key].default_value = value
    return made


def _lamp(place: tuple, at: tuple, watts: float, size: float) -> None:
    import bpy
    data = bpy.data.lights.new("Lamp", "AREA")
    data.energy, data.size = watts, size
    _stand(bpy.data.objects.new("Lamp", data), place, at)


def _camera(place: tuple, at: tuple, lens: float) -> None:
    import bpy
    data = bpy.data.cameras.new("Camera")
    data.lens, data.clip_start = lens, 0.01
    bpy.context.scene.camera = bpy.data.objects.new("Camera", data)
    _stand(bpy.context.scene.camera, place, at)


def _stand(obj, place: tuple, at: tuple) -> None:
    """Put a lamp or a camera there, and let it look that way."""
    import bpy
    from mathutils import Vector
    obj.location = place
    obj.rotation_euler = (Vector(at) - Vector(place)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(obj)


def _whole(path: Path) -> tuple[int, int, int, int]:
    """The box of all that a picture shows."""
    with Image.open(path) as picture:
        return (0, 0, *picture.size)


def _rendered(path: Path, percent: int, box: tuple = (0.0, 0.0, 1.0, 1.0)) -> Path:
    """A render of the open file by Cycles, or of a part (left, top, right, bottom) of its picture."""
    import bpy
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES_PER_PIXEL, True
    render = scene.render
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_max_x = box[0], box[2]
    render.border_min_y, render.border_max_y = 1.0 - box[3], 1.0 - box[1]
    render.resolution_percentage = percent
    render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return path


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures", sys.argv[2:])
