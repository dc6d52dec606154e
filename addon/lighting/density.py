"""How many texels the picture of light has along a side of a pixel: two or three where it shows what is brighter than
white.

Stripes and rims of lamps that are narrower than a pixel would ask a texel for each pixel to be darker than black. Twice
as dense, with a quarter of the samples, light is made of as many rays, and the render's own filter takes their mean.
"""
from __future__ import annotations

from ..rendering import Renders, crop_to, rendering
from .light_scene import LightScene
from .picture import Window

MOST_TEXELS = 1 << 21       # sharpening takes some 200 bytes for each
# texels along a side, and the samples from which on they are worth it: a quarter of 16 still tells something, and
# where each of nine is to have 16, the denoiser's price is no more of the whole than with four
DENSITIES = ((3, 144), (2, 16))
GLIMPSE = 1 / 32            # of the samples, to see what is bright
BRIGHT = 0.001              # of the pixels, from which on it is no spark


def needed_density(made: LightScene, window: Window, samples: int, white: float) -> Renders[int]:
    """How many texels a side of a pixel asks for in `window`, by a glimpse of what `made` shows there.

    Parameters
    ----------
    samples : int
        That the light is to have for each pixel.
    white : float
        From which on light looks white.
    """
    most = MOST_TEXELS / (window.width * window.height)
    density = next((dense for dense, fewest in DENSITIES if samples >= fewest and dense**2 <= most), 1)
    if density == 1:
        return 1
    scene = made.scene
    scene.cycles.samples, scene.cycles.use_denoising = max(int(samples * GLIMPSE), 1), False
    scene.render.film_transparent, scene.render.use_persistent_data = made.alone, True
    seen = yield from rendering(scene)
    return density if (seen[..., :3].max(axis=2) > white).mean() > BRIGHT else 1


def make_denser(made: LightScene, window: Window, density: int) -> None:
    """Let `made` render the same window with `density` pixels for each along a side."""
    if density == 1:
        return
    render, cycles = made.scene.render, made.scene.cycles
    render.resolution_x, render.resolution_y = (side * density for side in window.size)
    render.resolution_percentage = 100
    low = window.column * density, window.row * density
    crop_to(render, low, (low[0] + window.width * density, low[1] + window.height * density),
            (render.resolution_x, render.resolution_y))
    # what is diced by pixels is so by those of the picture
    for rate in ("dicing_rate", "preview_dicing_rate"):
        if hasattr(cycles, rate):
            setattr(cycles, rate, getattr(cycles, rate) * density)
