"""What a comparison leaves in its folder: four pictures and the numbers."""
from __future__ import annotations

import json
import os

import bpy
import numpy as np

from .compare_numbers import Measurement

HOLE, SPILL, WRONG_LAYER = (0.90, 0.08, 0.05), (0.10, 0.25, 0.95), (0.95, 0.80, 0.05)
NO_MIRROR, LEFT_OUT, RIGHT = (0.01, 0.01, 0.01), (0.06, 0.06, 0.08), (0.22, 0.22, 0.22)


def write_report(folder: str, scene: bpy.types.Scene, reference: np.ndarray, result: np.ndarray, mirror: np.ndarray,
                 measurement: Measurement, report: dict) -> None:
    """Write reference.png, result.png, difference.png, holes.png and report.json.

    Parameters
    ----------
    folder : str
        An existing folder.
    scene : bpy.types.Scene
        A temporary scene whose view settings are those of the user; its image settings are changed.
    reference, result : (height, width, 3) float32
        Linear pictures.
    mirror : (height, width) bool
    """
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "PNG", "RGB", "8"
    _write_png(os.path.join(folder, "reference.png"), scene, reference)
    _write_png(os.path.join(folder, "result.png"), scene, result)
    view = scene.view_settings
    view.view_transform, view.look, view.exposure, view.gamma = "Standard", "None", 0.0, 1.0
    _write_png(os.path.join(folder, "difference.png"), scene, np.abs(reference - result))
    _write_png(os.path.join(folder, "holes.png"), scene, coverage_picture(mirror, measurement))
    with open(os.path.join(folder, "report.json"), "w", encoding="utf-8") as file:
        json.dump(report, file, indent=2)
        file.write("\n")


def coverage_picture(mirror: np.ndarray, measurement: Measurement) -> np.ndarray:
    """Holes red, spill blue, wrong layer yellow, left out dark; green grows with the displacement, full at 1 pixel."""
    picture = np.empty((*mirror.shape, 3), dtype=np.float32)
    picture[:] = NO_MIRROR
    picture[mirror] = LEFT_OUT
    picture[measurement.judged] = RIGHT
    picture[..., 1] = np.maximum(picture[..., 1], np.clip(np.nan_to_num(measurement.displacement), 0.0, 1.0))
    for mask, colour in ((measurement.hole, HOLE), (measurement.spill, SPILL), (measurement.wrong_layer, WRONG_LAYER)):
        picture[mask] = colour
    return picture


def _write_png(path: str, scene: bpy.types.Scene, linear: np.ndarray) -> None:
    height, width, _ = linear.shape
    image = bpy.data.images.new("Reflection Comparison", width, height, float_buffer=True)
    try:
        rgba = np.ones((height, width, 4), dtype=np.float32)
        rgba[..., :3] = linear
        image.pixels.foreach_set(rgba.ravel())
        image.save_render(path, scene=scene)
    finally:
        bpy.data.images.remove(image)
