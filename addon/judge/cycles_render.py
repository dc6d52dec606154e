"""Cycles renders of a temporary scene, as arrays."""
from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np

from ...core import ReflectionError
from ..blender_data import render_size
from ..faults import interrupt_held
from ..files import has_room, is_whole, scratch_folder, scratch_is_full

SLOT = "Reflection Comparison"
OWN_SETTINGS = ("samples", "use_adaptive_sampling", "adaptive_threshold", "adaptive_min_samples", "use_denoising",
                "denoiser", "sample_clamp_direct", "sample_clamp_indirect", "blur_glossy", "film_exposure",
                "pixel_filter_type", "filter_width", "caustics_reflective", "caustics_refractive", "max_bounces",
                "diffuse_bounces", "glossy_bounces", "transmission_bounces", "transparent_max_bounces", "seed")


def prepare(scene: bpy.types.Scene, depth: int) -> None:
    """Set a temporary scene up for Cycles on the processor, `depth` reflections and lossless linear pictures.

    Raises
    ------
    ReflectionError
        Where Cycles is switched off.
    """
    try:
        scene.render.engine = "CYCLES"
    except TypeError as error:
        raise ReflectionError("Cycles is not available: enable the add-on 'Cycles Render Engine' in the "
                              "preferences.") from error
    scene.render.use_persistent_data = False
    scene.render.film_transparent = False
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    settings.exr_codec = "ZIP"
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = True
    cycles.seed = 0
    cycles.max_bounces = 4 + depth
    # as many reflections as the mesh follows: a mirror that is seen in the last one is black
    cycles.glossy_bounces = depth


def render_codes(scene: bpy.types.Scene) -> np.ndarray:
    """What each pixel's centre shows, (height, width, 3) float32 from the lowest row up: one sample, no filter."""
    cycles = scene.cycles
    cycles.samples, cycles.pixel_filter_type, cycles.filter_width = 1, "BOX", 0.01
    cycles.film_exposure = 1.0
    return _render(scene)


def render_picture(scene: bpy.types.Scene, samples: int, user: bpy.types.Scene) -> np.ndarray:
    """The picture in linear light, (height, width, 3) float32 from the lowest row up.

    With 0 samples, sampling, denoising, clamping, filter and bounces are those of the scene `user`.
    """
    cycles = scene.cycles
    if samples:
        cycles.samples, cycles.pixel_filter_type, cycles.filter_width = samples, "BLACKMAN_HARRIS", 1.5
    else:
        for name in OWN_SETTINGS:
            if hasattr(user.cycles, name):
                setattr(cycles, name, getattr(user.cycles, name))
    return _render(scene)


def _render(scene: bpy.types.Scene) -> np.ndarray:
    # A file, since a render result has no pixels to read without a window.
    with scratch_folder() as folder, _slot_of_its_own():
        path = os.path.join(folder, "render.exr")
        scene.render.filepath = path
        with interrupt_held():
            _write_still(scene)
        if os.path.exists(path):
            if not is_whole(path):
                raise scratch_is_full()
        elif has_room(folder, _largest(scene)):
            raise ReflectionError("The render was cancelled: the comparison is left out, nothing has changed.")
        else:
            raise scratch_is_full()
        image = bpy.data.images.load(path)
        try:
            image.colorspace_settings.name = "Non-Color"
            width, height = image.size
            pixels = np.empty(width * height * image.channels, dtype=np.float32)
            image.pixels.foreach_get(pixels)
            return pixels.reshape(height, width, -1)[..., :3].copy()
        finally:
            bpy.data.images.remove(image)


def _largest(scene: bpy.types.Scene) -> int:
    """The most bytes that a picture takes in a file."""
    width, height = render_size(scene)
    return width * height * 3 * 4 + 20 * height + 10_000


def _write_still(scene: bpy.types.Scene) -> None:
    """Render to the scene's path; where that is cancelled there is no file."""
    bpy.ops.render.render(write_still=True, scene=scene.name)


@contextmanager
def _slot_of_its_own() -> Iterator[None]:
    """Keep the user's last render: ours goes into another slot of the render result."""
    result = bpy.data.images.get("Render Result")
    if bpy.app.background or result is None:
        yield
        return
    slots = result.render_slots
    active = slots.active_index
    if slots.find(SLOT) < 0:
        slots.new(name=SLOT)
    slots.active_index = slots.find(SLOT)
    try:
        yield
    finally:
        slots.active_index = active
