"""The picture of light that other engines show: 8 bits, sRGB, filtered as a camera filters, with its opacity."""
from __future__ import annotations

import bpy
import numpy as np

from ..faults import Steps
from .unwrapping import Unwrapped

WRITING = "Writing"
# weights of the texels beside one, the nearest first, by the number of texels along a pixel's side: of ten filters the
# best on the room and the sphere, in three.js at twice the size against Cycles with its own pixel filter
WEIGHTS = {1: (0.05,), 2: (0.15, 0.02)}
LEAST = 1e-6    # opacity of what has a colour
NEARLY = 0.02   # from none or all of opacity


def fill_export_image(image: bpy.types.Image, light: np.ndarray, unwrapped: Unwrapped, dense: int) -> Steps[None]:
    """Write light into an existing image in the form that exporters need: 8 bits, sRGB, clipped at white, with alpha.

    The light of faces is blurred slightly by a separable kernel of a few texels, before it is clipped. A camera's pixel
    filter does the same, so that the outlines of lamps are equally bright. Alpha is raised where a channel exceeds it,
    and the stored colour is not premultiplied.

    Parameters
    ----------
    image : bpy.types.Image
        Image of any size with 8 bits per channel. It gets the size of `light` and is packed into the file.
    light : (height, width, 4) float32
        Linear premultiplied RGB and alpha from the lowest row up; its size is `unwrapped.size`. It is not changed.
    unwrapped : Unwrapped
        Layout of the picture. Each block of its pages is filtered alone; texels of points are not filtered.
    dense : {1, 2}
        Number of texels along each side of a pixel. It selects the kernel.
    """
    yield 0.0, WRITING
    light = np.clip(_filtered(light, unwrapped, dense), 0.0, 1.0)
    light[..., 3] = light.max(axis=2)
    light[..., :3] /= np.maximum(light[..., 3:], LEAST)
    # IEC 61966-2-1
    colour = light[..., :3]
    light[..., :3] = np.where(colour <= 0.0031308, 12.92 * colour,
                              1.055 * np.maximum(colour, 0.0031308)**(1.0 / 2.4) - 0.055)
    yield 0.0, WRITING
    height, width, _ = light.shape
    image.scale(width, height)
    image.alpha_mode = "CHANNEL_PACKED"
    yield 0.0, WRITING
    image.pixels.foreach_set(light.ravel())
    yield 0.0, WRITING
    image.pack()
    yield 0.0, WRITING


def straight(light: np.ndarray) -> np.ndarray:
    """Return light and opacity (height, width, 4) with the colour that each texel would have if it were opaque."""
    light = light.copy()
    light[..., :3] /= np.maximum(light[..., 3:], LEAST)
    return light


def is_cut_out(opacity: np.ndarray) -> bool:
    """Return True if most that is not opaque is clear."""
    clear, between = opacity < NEARLY, (opacity >= NEARLY) & (opacity <= 1.0 - NEARLY)
    return bool(clear.sum() > between.sum())


def _filtered(light: np.ndarray, unwrapped: Unwrapped, dense: int) -> np.ndarray:
    """Return light that each block of faces takes from neighbouring texels; points have a texel each."""
    light, weights = light.copy(), WEIGHTS[dense]
    for block in (block for page in unwrapped.pages for block in page.blocks):
        (column, row), (width, height) = block.corner, block.size
        part = light[row:row + height, column:column + width]
        # along columns, then along rows
        for axis in (0, 1):
            reach, count = len(weights), part.shape[axis]
            padded = np.pad(part, [(reach, reach) if axis == other else (0, 0) for other in range(3)], mode="edge")
            part = (1.0 - 2.0 * sum(weights)) * part
            for step, weight in enumerate(weights, start=1):
                for start in (reach - step, reach + step):
                    part += weight * np.take(padded, np.arange(start, start + count), axis=axis)
        light[row:row + height, column:column + width] = part
    return light
