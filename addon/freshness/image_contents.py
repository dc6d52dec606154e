"""Digests of what images hold, by which an image that was only renamed, moved or saved elsewhere is the same one."""
from __future__ import annotations

import os
from collections.abc import Iterator
from hashlib import blake2b

import bpy
import numpy as np

SIZE = 12            # bytes of a digest
ENDS = 64 * 1024     # bytes of a file that are read at its start and at its end: images of one size differ there
MADE = {"GENERATED", "VIEWER"}
PLAIN = ("source", "alpha_mode", "generated_type", "use_half_precision")


def image_content(image: bpy.types.Image) -> bytes:
    """Return a digest of what an image shows: of its file, undecoded, or of its pixels where these were painted."""
    told = blake2b(repr([getattr(image, name) for name in PLAIN] + [image.colorspace_settings.name]).encode(),
                   digest_size=SIZE)
    if image.is_dirty:
        pixels = np.empty(len(image.pixels), dtype=np.float32)
        image.pixels.foreach_get(pixels)
        told.update(pixels.tobytes())
    elif image.packed_files:
        for packed in image.packed_files:
            told.update(packed.packed_file.data)
    elif image.source in MADE:
        told.update(repr((tuple(image.size), tuple(image.generated_color))).encode())
    else:
        for path in _paths(image):
            told.update(_ends(path))
    return told.digest()


def _paths(image: bpy.types.Image) -> Iterator[str]:
    """Return the files of an image, one for each of its tiles."""
    path = bpy.path.abspath(image.filepath, library=image.library)
    for tile in image.tiles if image.source == "TILED" else [None]:
        if tile is not None:
            u, v = (tile.number - 1001) % 10, (tile.number - 1001) // 10
            yield path.replace("<UDIM>", str(tile.number)).replace("<UVTILE>", f"u{u + 1}_v{v + 1}")
        else:
            yield path


def _ends(path: str) -> bytes:
    """Return the size of a file with its first and its last bytes."""
    try:
        with open(path, "rb") as file:
            size = file.seek(0, os.SEEK_END)
            file.seek(max(size - ENDS, 0))
            last = file.read(ENDS)
            file.seek(0)
            return size.to_bytes(8, "big") + file.read(ENDS) + last
    except OSError:
        return b"missing"
