"""The pictures of a comparison, as files and as parts of its page."""
from __future__ import annotations

import errno
import os
from contextlib import suppress
from functools import partial

import bpy
import numpy as np

from ...core import breathe, in_steps
from ..faults import Steps, part
from ..files import is_whole
from ..metrics import Measurement
from ..report import Picture, heat_map, png_bytes
from .pictures import Pictures

# kinds of pixels in holes.png, and their colours: the set of M. Okabe and K. Ito, safe for colour-blind readers
KINDS = {"no mirror": (20, 20, 20), "left out": (62, 62, 68), "right": (130, 130, 130), "hole": (213, 94, 0),
         "spill": (0, 114, 178), "wrong layer": (240, 228, 66)}
DRAWING = "Drawing error maps"
ROUND = "Drawing the surroundings of the mirror"
DIFFERENCE, DISPLACEMENT = (0.001, 1.0), (0.01, 10.0)       # ends of the scales: linear light, pixels


def comparison_pictures(folder: str, scene: bpy.types.Scene, pictures: Pictures,
                        measurement: Measurement) -> Steps[tuple[Picture, ...]]:
    """Write five PNG files into the folder, in steps. Return them as pictures for a page.

    Parameters
    ----------
    folder : str
        A temporary folder from `files.staged`.
    scene : bpy.types.Scene
        A temporary scene with the user's view settings. Its image settings are changed.
    """
    yield 0.0, DRAWING
    difference = np.abs(pictures.reference.astype(np.float64) - pictures.result).mean(axis=2)
    coverage = coverage_picture(measurement)
    maps = yield from part(in_steps(partial(_maps, difference, measurement.displacement, coverage)), 0.0, 0.0, DRAWING)
    for name, data in maps.items():
        with open(os.path.join(folder, f"{name}.png"), "wb") as file:
            file.write(data)
    yield 0.3, ROUND
    # the page shows of the maps what is round the mirrors alone, and so larger
    box = surroundings(measurement.mirror)
    maps = yield from part(in_steps(partial(_maps, difference[box], measurement.displacement[box], coverage[box])), 0.3,
                           0.0, ROUND)
    small = {}
    for name, linear in (("reference", pictures.reference), ("result", pictures.result)):
        yield 0.6 if name == "reference" else 0.8, f"Writing {name}.png"
        save_picture(os.path.join(folder, f"{name}.png"), scene, linear, "PNG")
        path = os.path.join(folder, f"{name}.jpg")
        save_picture(path, scene, linear, "JPEG")
        with open(path, "rb") as file:
            small[name] = file.read()
        os.unlink(path)
    return (
        Picture("reference", "Cycles", "The mirror is traced.", small["reference"], "image/jpeg"),
        Picture("result", "With the reflection mesh", "The mesh lies before a mirror that reflects the world alone.",
                small["result"], "image/jpeg"),
        Picture("displacement", "Displacement", "How far each point of the reflection lies from where Cycles shows it, "
                "in pixels. Grey: not measured. The three maps show what is round the mirror.", maps["displacement"]),
        Picture("difference", "Difference of the pictures", "Mean over the channels, in linear light (white is 1); the "
                "noise of both renders included.", maps["difference"]),
        Picture("holes", "Holes", "Orange: the mesh shows nothing where Cycles shows the scene; blue: the reverse; "
                "yellow: another surface; dark: left out. Wrong pixels are drawn enlarged.", maps["holes"]))


def _maps(difference: np.ndarray, displacement: np.ndarray, coverage: np.ndarray) -> dict:
    """Draw the error maps of a comparison.

    Parameters
    ----------
    difference : (height, width) float
        Absolute difference of the pictures in linear light, mean of the channels, from the lowest row up like all
        three.
    displacement : (height, width) float
        Displacement in pixels; NaN where it was not measured.
    coverage : (height, width) uint8
        Kinds of pixels as indices into `KINDS`.

    Returns
    -------
    dict of str to bytes
        PNG files by the names "difference", "displacement" and "holes".
    """
    return {"difference": heat_map(difference, *DIFFERENCE),
            "displacement": heat_map(displacement, *DISPLACEMENT, unit="px"),
            "holes": png_bytes(coverage[::-1], np.array(list(KINDS.values())))}


def surroundings(mirror: np.ndarray) -> tuple[slice, slice]:
    """Return the bounding box of the mirror's pixels with a margin of a twentieth; the whole picture if there are none.
    """
    if not mirror.any():
        return slice(None), slice(None)
    box = []
    for axis in (0, 1):
        found = np.flatnonzero(mirror.any(axis=1 - axis))
        margin = 2 + (found[-1] - found[0]) // 20
        box.append(slice(max(int(found[0]) - margin, 0), int(found[-1]) + 1 + margin))
    return box[0], box[1]


def coverage_picture(measurement: Measurement) -> np.ndarray:
    """Return the kinds of pixels as indices into `KINDS`, (height, width) uint8. Wrong pixels are enlarged in large
    pictures.
    """
    names, mirror = list(KINDS), measurement.mirror
    picture = np.full(mirror.shape, names.index("no mirror"), dtype=np.uint8)
    picture[mirror] = names.index("left out")
    picture[measurement.judged] = names.index("right")
    for name, mask in (("spill", measurement.spill), ("wrong layer", measurement.wrong_layer),
                       ("hole", measurement.hole)):
        breathe()
        picture[enlarged(mask, mirror.shape[1] // 400)] = names.index(name)
    return picture


def enlarged(mask: np.ndarray, reach: int) -> np.ndarray:
    """Return a mask of all pixels within `reach` rows and columns of a pixel of `mask`."""
    for axis in (0, 1):
        pad = [(0, 0), (0, 0)]
        pad[axis] = (reach, reach)
        padded, length = np.moveaxis(np.pad(mask, pad), axis, 0), mask.shape[axis]
        mask = np.moveaxis(np.any([padded[k:k + length] for k in range(2 * reach + 1)], axis=0), 0, axis)
    return mask


def save_picture(path: str, scene: bpy.types.Scene, linear: np.ndarray, kind: str) -> None:
    """Write a linear picture with the scene's view settings."""
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.quality = kind, "RGB", 92
    if kind == "PNG":
        settings.color_depth = "8"
    height, width, _ = linear.shape
    image = bpy.data.images.new("Reflection Comparison", width, height, float_buffer=True)
    try:
        rgba = np.ones((height, width, 4), dtype=np.float32)
        rgba[..., :3] = linear
        image.pixels.foreach_set(rgba.ravel())
        with suppress(RuntimeError):
            image.save_render(path, scene=scene)
        if not is_whole(path):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), path)
    finally:
        bpy.data.images.remove(image)
