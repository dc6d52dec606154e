"""Render with Cycles: codes at the pixels' centres, and pictures."""
from __future__ import annotations

import bpy
import numpy as np

from ..rendering import Renders, rendering, with_cycles

SAMPLING = ("samples", "use_adaptive_sampling", "adaptive_threshold", "adaptive_min_samples", "use_denoising",
            "denoiser")
LIGHT = ("sample_clamp_direct", "sample_clamp_indirect", "blur_glossy", "film_exposure", "pixel_filter_type",
         "filter_width", "caustics_reflective", "caustics_refractive", "max_bounces", "diffuse_bounces",
         "glossy_bounces", "transmission_bounces", "transparent_max_bounces", "seed")

LAYERS = 256  # openings that a ray passes where it looks for a code


def prepare(scene: bpy.types.Scene, depth: int) -> None:
    """Set a temporary scene up for Cycles on the processor, `depth` reflections and lossless linear pictures.

    Raises
    ------
    ReflectionError
        Where Cycles is switched off.
    """
    with_cycles(scene)
    scene.render.use_persistent_data = False
    scene.render.film_transparent = False
    cycles = scene.cycles
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = True
    cycles.seed = 0
    cycles.max_bounces = 4 + depth
    # follow as many reflections as the mesh does: a mirror that is visible in the last one is black
    cycles.glossy_bounces = depth


def render_codes(scene: bpy.types.Scene) -> Renders[np.ndarray]:
    """Return the codes at the pixels' centres, (height, width, 3) float32, rows from bottom to top. Use one sample and
    no filter.
    """
    cycles = scene.cycles
    cycles.samples, cycles.pixel_filter_type, cycles.filter_width = 1, "BOX", 0.01
    cycles.film_exposure = 1.0
    layers, cycles.transparent_max_bounces = cycles.transparent_max_bounces, LAYERS
    try:
        return (yield from rendering(scene))[..., :3]
    finally:
        cycles.transparent_max_bounces = layers


def render_picture(scene: bpy.types.Scene, samples: int, user: bpy.types.Scene,
                   other_noise: bool = False) -> Renders[np.ndarray]:
    """Return the picture in linear light, (height, width, 3) float32, rows from bottom to top.

    With 0 samples, sampling, denoising, clamping, filter and bounces are those of the scene `user`.
    """
    cycles = scene.cycles
    if samples:
        cycles.samples, cycles.pixel_filter_type, cycles.filter_width = samples, "BLACKMAN_HARRIS", 1.5
    else:
        take_settings(scene, user, (*SAMPLING, *LIGHT))
    seed = cycles.seed
    cycles.seed = seed + other_noise
    try:
        return (yield from rendering(scene))[..., :3]
    finally:
        cycles.seed = seed


def take_settings(scene: bpy.types.Scene, user: bpy.types.Scene, names: tuple[str, ...] = LIGHT) -> None:
    """Copy the user's settings of light paths to a temporary scene."""
    for name in names:
        if hasattr(user.cycles, name):
            setattr(scene.cycles, name, getattr(user.cycles, name))
