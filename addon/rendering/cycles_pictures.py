"""Render scenes with Cycles into arrays."""
from __future__ import annotations

import os
from collections.abc import Generator, Iterator, Sequence
from contextlib import contextmanager
from typing import TypeVar

import bpy
import numpy as np

from ...core import ReflectionError
from ..faults import Beside, Steps, Undivided, between_events, finished
from ..files import has_room, is_whole, scratch_folder, scratch_is_full
from ..reading import render_size

Found = TypeVar("Found")
Renders = Generator[None, None, Found]
"""What renders: it yields while Blender renders beside, and nothing where it renders in one call."""

SLOT = "Reflection Comparison"
INSIDE = 0.5  # pixels from a border of a part: Blender rounds down, and would where rounding left a pixel's side below


def with_cycles(scene: bpy.types.Scene) -> None:
    """Let Cycles render a temporary scene, into lossless linear pictures.

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
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "IMAGE"
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGBA", "32"
    settings.exr_codec = "ZIP"


def denoise(cycles: bpy.types.PropertyGroup) -> None:
    """Let Cycles' settings `cycles` denoise what is rendered, by albedo and normals."""
    cycles.use_denoising = True
    try:
        cycles.denoiser = "OPENIMAGEDENOISE"
        cycles.denoising_input_passes, cycles.denoising_prefilter = "RGB_ALBEDO_NORMAL", "ACCURATE"
    except TypeError:
        # Linux distributions build Blender without it: then the light has the noise of its samples
        cycles.use_denoising = False


def crop_to(render: bpy.types.RenderSettings, low: Sequence[int], high: Sequence[int], size: Sequence[int]) -> None:
    """Let a part of a picture of `size` pixels be rendered alone: from columns and rows `low` to those before `high`,
    counted from the lower left corner."""
    render.use_border = render.use_crop_to_border = True
    render.border_min_x, render.border_min_y = ((start + INSIDE) / count for start, count in zip(low, size))
    render.border_max_x, render.border_max_y = (min((end + INSIDE) / count, 1.0) for end, count in zip(high, size))


def rendered(scene: bpy.types.Scene) -> np.ndarray:
    """Render a temporary scene in one call. Return the picture and raise errors as `rendering` does."""
    return finished(rendering(scene))


def shown_while(renders: Renders[Found], fraction: float, stage: str) -> Steps[Found]:
    """Run a render in steps. Yield (fraction, stage) before it and at each step. Return the result of `renders`."""
    told = render_stage(stage)
    yield fraction, told
    try:
        while True:
            next(renders)
            yield fraction, told
    except StopIteration as stop:
        return stop.value
    finally:
        renders.close()


def render_stage(stage: str) -> Beside | Undivided:
    """The stage of a render that comes next."""
    return Beside(stage) if between_events() else Undivided(stage)


def rendering(scene: bpy.types.Scene) -> Renders[np.ndarray]:
    """The picture of a temporary scene, (height, width, 4) float32 in linear light from the lowest row up.

    Raises
    ------
    ReflectionError
        Where the render is cancelled, or its file has no room.
    """
    # a file, since a render result has no pixels to read without a window.
    with scratch_folder() as folder, _slot_of_its_own():
        path = os.path.join(folder, "render.exr")
        scene.render.filepath = path
        yield from _writing_still(scene)
        if os.path.exists(path):
            if not is_whole(path):
                raise scratch_is_full()
        elif has_room(folder, _largest(scene)):
            raise ReflectionError("The render was cancelled: nothing has changed.")
        else:
            raise scratch_is_full()
        image = bpy.data.images.load(path)
        try:
            image.colorspace_settings.name = "Non-Color"
            width, height = image.size
            pixels = np.empty(width * height * image.channels, dtype=np.float32)
            image.pixels.foreach_get(pixels)
            return pixels.reshape(height, width, -1)
        finally:
            bpy.data.images.remove(image)


def _largest(scene: bpy.types.Scene) -> int:
    """The most bytes that a picture takes in a file."""
    width, height = render_size(scene)
    return width * height * 4 * 4 + 20 * height + 10_000


def _writing_still(scene: bpy.types.Scene) -> Renders[None]:
    """Render to the scene's path; where that is cancelled there is no file."""
    if not between_events():
        _write_still(scene)
        return
    preferences = bpy.context.preferences
    shown, changed = preferences.view.render_display_type, preferences.is_dirty
    # no window opens for a picture that is not the user's
    preferences.view.render_display_type = "NONE"
    try:
        bpy.ops.render.render("INVOKE_DEFAULT", write_still=True, scene=scene.name)
    finally:
        preferences.view.render_display_type, preferences.is_dirty = shown, changed
    while bpy.app.is_job_running("RENDER"):
        yield


def _write_still(scene: bpy.types.Scene) -> None:
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
