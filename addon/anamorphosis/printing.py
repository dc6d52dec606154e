"""A flat sheet as a picture to print, in its size: PNG, or SVG around one."""
from __future__ import annotations

import base64

import bpy
import numpy as np

from ...core import ReflectionError, View, draw
from ..faults import Steps
from ..report import png_picture
from .flat_sheet import FlatSheet

INCH = 0.0254
FINER = 2               # samples along a pixel's side
ROUNDING = 0.01         # pixels: a sheet of 10 cm may be a little longer in single precision
MOST_PIXELS = 200e6
AT_ONCE = 400_000       # samples


def print_size(sheet: FlatSheet, dpi: float) -> tuple[int, int]:
    """Width and height in pixels.

    Raises
    ------
    ReflectionError
        Where there are too many of them to be printed.
    """
    width, height = (max(1, int(np.ceil(side / INCH * dpi - ROUNDING))) for side in sheet.size)
    if width * height > MOST_PIXELS:
        metres = " x ".join(f"{side:.2f}" for side in sheet.size)
        raise ReflectionError(f"The sheet is {metres} m large, {width * height / 1e6:.0f} million pixels at {dpi:g} "
                              "dots per inch: lower them, scale the scene to the size of the paper, or set its unit "
                              "scale.")
    return width, height


def printed(sheet: FlatSheet, picture: np.ndarray, dpi: float) -> Steps[np.ndarray]:
    """Return the sheet with `picture` (from `pixels_of`) as (height, width, 3) uint8, rows from top to bottom. It is
    white where the mirror does not show it. Yields (fraction, stage).
    """
    width, height = print_size(sheet, dpi)
    corners, uv = sheet.corners[sheet.seen] / INCH * dpi * FINER, sheet.uv[sheet.seen]
    low, high = corners[:, :, 1].min(axis=1), corners[:, :, 1].max(axis=1)
    # clear beside it
    framed = np.pad(picture, ((1, 1), (1, 1), (0, 0)))
    rows = max(1, AT_ONCE // (FINER * FINER * width))
    pixels = np.empty((height, width, 3), dtype=np.uint8)
    for start in range(0, height, rows):
        yield start / height, "Drawing the sheet"
        end = min(start + rows, height)
        near = (high > start * FINER) & (low < end * FINER)
        pixels[height - end:height - start] = _band(corners[near], uv[near], framed, width, (start, end))[::-1]
    return pixels


def _band(corners: np.ndarray, uv: np.ndarray, framed: np.ndarray, width: int, rows: tuple[int, int]) -> np.ndarray:
    """Return the rows of pixels in the half-open range `rows`, counted from below, as (rows, width, 3) uint8."""
    start, end = rows
    places = np.concatenate((corners.reshape(-1, 2), np.zeros((3 * len(corners), 1))), axis=1)
    lines, across, bottom = (end - start) * FINER, width * FINER, start * FINER
    middle = (0.5 * across, bottom + 0.5 * lines)
    view = View.looking_at((*middle, 1.0), (*middle, 0.0), (across, lines), up=(0.0, 1.0, 0.0),
                           orthographic_scale=float(max(across, lines)))
    drawn = draw(view, places, np.arange(len(places)).reshape(-1, 3))
    pixel = np.flatnonzero(drawn.triangle >= 0)
    spot = np.einsum("kn,nkc->nc", drawn.weights[:, pixel], uv[drawn.triangle[pixel]])
    band = np.ones((lines * across, 3), dtype=np.float32)
    band[pixel] = _looked_up(framed, spot)
    samples = band.reshape(lines // FINER, FINER, width, FINER, 3)
    shown = sum(samples[:, row, :, column] for row in range(FINER) for column in range(FINER))
    return np.round(shown * (255.0 / FINER**2)).astype(np.uint8)


def _looked_up(framed: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Colours (n, 3) on white at `uv` (n, 2), between the centres of the pixels, of a picture in a frame of one pixel,
    (h + 2, w + 2, 4), its colours times its alpha: what is clear has no colour to mix in."""
    height, width = framed.shape[0] - 2, framed.shape[1] - 2
    place = np.clip(uv * (width, height) + 0.5, 0.0, (width + 0.999, height + 0.999))
    corner = np.floor(place)
    right, up = (place - corner).astype(np.float32).T[..., None]
    first = (corner[:, 1] * (width + 2) + corner[:, 0]).astype(np.int64)
    texels = framed.reshape(-1, 4)
    below, above = (_between(texels.take(row, axis=0), texels.take(row + 1, axis=0), right)
                    for row in (first, first + width + 2))
    shown = _between(below, above, up)
    return np.clip(shown[:, :3] + (1.0 - shown[:, 3:]), 0.0, 1.0)


def _between(start: np.ndarray, end: np.ndarray, share: np.ndarray) -> np.ndarray:
    """From `start` to `end`, which is written over."""
    end -= start
    end *= share
    end += start
    return end


def pixels_of(image: bpy.types.Image) -> np.ndarray:
    """(height, width, 4) float32, rows from below: colours as a screen shows them times alpha, and alpha."""
    width, height = image.size
    pixels = np.empty(width * height * 4, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, 4)
    colours, alpha = pixels[..., :3], pixels[..., 3:]
    if image.alpha_mode == "NONE":
        alpha[:] = 1.0
    if image.is_float:
        if image.alpha_mode in {"STRAIGHT", "PREMUL"}:
            # however they lie in the file, Blender holds those of single precision times alpha, and bytes without
            np.divide(colours, alpha, out=colours, where=alpha > 0.0)
        # IEC 61966-2-1
        light = np.clip(colours, 0.0, 1.0)
        colours[:] = np.where(light <= 0.0031308, 12.92 * light,
                              1.055 * np.maximum(light, 0.0031308)**(1.0 / 2.4) - 0.055)
    colours *= alpha
    return pixels


def encoded(pixels: np.ndarray, sheet: FlatSheet, dpi: float, svg: bool) -> bytes:
    """Return a PNG with its physical size, or an SVG around it with the exact size and the border of the sheet."""
    png = png_picture(pixels, round(dpi / INCH))
    if not svg:
        return png
    width, height = 1000.0 * sheet.size
    # the last row and column of pixels may reach beyond the sheet
    across, down = (1000.0 * INCH / dpi * side for side in (pixels.shape[1], pixels.shape[0]))
    data = base64.b64encode(png).decode("ascii")
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width:.3f}mm" height="{height:.3f}mm" '
            f'viewBox="0 0 {width:.3f} {height:.3f}">\n'
            f'<image x="0" y="{height - down:.3f}" width="{across:.3f}" height="{down:.3f}" '
            f'href="data:image/png;base64,{data}"/>\n'
            f'<rect width="{width:.3f}" height="{height:.3f}" fill="none" stroke="#999" stroke-width="0.2"/>\n'
            "</svg>\n").encode("ascii")
