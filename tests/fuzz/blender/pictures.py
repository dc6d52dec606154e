"""What Cycles shows of the open file, where it shows mirrors, and what Blender prints meanwhile."""
from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np
from mathutils import Vector


def rendered(seed: int) -> np.ndarray:
    """The file's own picture in linear light, (height, width, 3), from the lowest row up."""
    scene = bpy.context.scene
    kept = scene.cycles.seed, scene.render.filepath
    with tempfile.TemporaryDirectory() as folder:
        path = str(Path(folder) / "picture.exr")
        scene.cycles.seed, scene.render.filepath = seed, path
        try:
            bpy.ops.render.render(write_still=True)
        finally:
            scene.cycles.seed, scene.render.filepath = kept
        image = bpy.data.images.load(path)
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        bpy.data.images.remove(image)
    return pixels.reshape(scene.render.resolution_y, scene.render.resolution_x, -1)[..., :3].astype(np.float64)


def mirror_pixels(mirrors: list) -> np.ndarray:
    """Where the camera sees a mirror at the middle of a pixel of the square picture, (size, size) bool, the lowest row
    first."""
    scene, camera = bpy.context.scene, bpy.context.scene.camera
    depsgraph, eye = bpy.context.evaluated_depsgraph_get(), camera.matrix_world.translation
    right_top, right, left, _ = (camera.matrix_world @ corner for corner in camera.data.view_frame(scene=scene))
    ahead = camera.matrix_world.to_3x3() @ Vector((0.0, 0.0, -1.0))
    steps = ((np.arange(scene.render.resolution_x) + 0.5) / scene.render.resolution_x).tolist()

    def seen(x: float, y: float) -> bool:
        place = left + x * (right - left) + y * (right_top - right)
        start, way = (place, ahead) if camera.data.type == "ORTHO" else (eye, place - eye)
        return scene.ray_cast(depsgraph, start, way)[4] in mirrors
    return np.array([[seen(x, y) for x in steps] for y in steps])


@contextlib.contextmanager
def heard() -> Iterator[list[str]]:
    """Collect what Blender prints, where the sentences of operators go in the background."""
    words: list[str] = []
    with tempfile.TemporaryFile("w+b") as file:
        kept = os.dup(1)
        os.dup2(file.fileno(), 1)
        try:
            yield words
        finally:
            os.dup2(kept, 1)
            os.close(kept)
            file.seek(0)
            words.append(file.read().decode(errors="replace"))


def save(path: Path, picture: np.ndarray) -> None:
    """Write a picture in sRGB as PNG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    image = bpy.data.images.new("Kept", picture.shape[1], picture.shape[0])
    pixels = np.ones((*picture.shape[:2], 4), dtype=np.float32)
    pixels[..., :3] = picture
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


def as_srgb(linear: np.ndarray) -> np.ndarray:
    """Linear light from 0 to 1, and what is brighter as 1, as sRGB (IEC 61966-2-1)."""
    linear = np.clip(linear, 0.0, 1.0)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 1e-9)**(1.0 / 2.4) - 0.055)
