"""Makes docs/pictures/animation.gif: ten seconds of a room, its golden ball a reflection mesh that is made anew and
lit in every frame.

    python -m tools.pictures.animation [folder] [seconds]

What the camera sees of the ball is the mesh alone: the ball itself is hidden from the camera.
"""
from __future__ import annotations

import math
import sys
from pathlib import Path

from PIL import Image

from tools import extension_zip

SAMPLE = extension_zip.ROOT / "sample_blends" / "room.blend"
WIDTH, HEIGHT, RATE = 216, 136, 5
SAMPLES = 12
SWING, RISE = 0.5, 0.35  # of the camera round the ball: radians, and of its height
COLOURS = 48


def main(folder: Path, seconds: float) -> None:
    count = round(seconds * RATE)
    with extension_zip.installed() as scratch:
        _open()
        pictures = [_frame(number / count, scratch / "frame.png") for number in range(count)]
    palette = _palette(pictures)
    # one palette and no dither: what stands still takes no bytes
    frames = [picture.quantize(palette=palette, dither=Image.Dither.NONE) for picture in pictures]
    folder.mkdir(parents=True, exist_ok=True)
    frames[0].save(folder / "animation.gif", save_all=True, append_images=frames[1:], duration=10 * round(100 / RATE),
                   loop=0, optimize=False)


def _open() -> None:
    import bpy
    bpy.ops.wm.open_mainfile(filepath=str(SAMPLE))
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = WIDTH, HEIGHT, 100
    scene.cycles.samples, scene.cycles.use_denoising = SAMPLES, True
    scene.render.image_settings.file_format = "PNG"


def _frame(turn: float, path: Path) -> Image.Image:
    """The picture at a part of the whole turn."""
    import bpy
    from mathutils import Matrix, Vector
    scene = bpy.context.scene
    camera, ball = scene.camera, bpy.data.objects["Golden Ball"]
    if "rest" not in camera:
        camera["rest"] = [value for row in camera.matrix_world for value in row]
    rest = Matrix([camera["rest"][4 * row:4 * row + 4] for row in range(4)])
    centre = ball.matrix_world.translation
    angle = SWING * math.sin(2.0 * math.pi * turn)
    place = Matrix.Rotation(angle, 3, "Z") @ (rest.translation - centre) + centre
    place.z += RISE * (1.0 - math.cos(2.0 * math.pi * turn))
    aim = centre - place
    camera.matrix_world = Matrix.Translation(place) @ Vector(aim).to_track_quat("-Z", "Y").to_matrix().to_4x4()
    bpy.context.view_layer.update()
    bpy.ops.reflection_mesh.generate()
    bpy.ops.reflection_mesh.light(samples=SAMPLES)
    scene.render.filepath = str(path)
    ball.visible_camera = False
    bpy.ops.render.render(write_still=True)
    ball.visible_camera = True
    with Image.open(path) as picture:
        return picture.convert("RGB")


def _palette(pictures: list) -> Image.Image:
    """Colours for all of the pictures."""
    some = pictures[::max(1, len(pictures) // 8)]
    sheet = Image.new("RGB", (WIDTH, HEIGHT * len(some)))
    for row, picture in enumerate(some):
        sheet.paste(picture, (0, HEIGHT * row))
    return sheet.quantize(COLOURS)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else extension_zip.ROOT / "docs" / "pictures",
         float(sys.argv[2]) if len(sys.argv) > 2 else 10.0)
