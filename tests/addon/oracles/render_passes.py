"""The passes of a render, read from an uncompressed OpenEXR file of several layers."""
from __future__ import annotations

import struct
from collections.abc import Iterator
from pathlib import Path

import bpy
import numpy as np

MULTIPART = 0x1000  # flag of the version
KINDS = {0: "<u4", 1: "<f2", 2: "<f4"}


def rendered_passes(path: Path, engine: str = "CYCLES", samples: int = 64) -> dict[str, np.ndarray]:
    """Render the open scene; each channel (height, width) by its name, "ViewLayer.Combined.R"."""
    scene = bpy.context.scene
    scene.render.engine, scene.render.filepath = engine, str(path)
    if engine == "CYCLES":
        scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = samples, False, False
    settings = scene.render.image_settings
    if bpy.app.version >= (5, 0, 0):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.exr_codec, settings.color_depth = "OPEN_EXR_MULTILAYER", "NONE", "32"
    bpy.ops.render.render(write_still=True)
    return read_passes(path)


def read_passes(path: Path) -> dict[str, np.ndarray]:
    """The channels of a file of scan lines without compression, of one part or of several (OpenEXR's "File Layout")."""
    data = Path(path).read_bytes()
    magic, version = struct.unpack_from("<2I", data)
    several, at, headers, found = bool(version & MULTIPART), 8, [], {}
    assert magic == 20000630
    while data[at]:
        header, at = _header(data, at)
        headers.append(header)
        if not several:
            break
    at += several
    for header in headers:
        assert header["compression"] == b"\0"
        left, top, right, bottom = struct.unpack("<4i", header["dataWindow"])
        width, height = right - left + 1, bottom - top + 1
        channels = list(_channels(header["channels"]))
        rows = {name: np.empty((height, width), dtype=kind) for name, kind in channels}
        for start in struct.unpack_from(f"<{height}Q", data, at):
            start += 4 * several
            row, = struct.unpack_from("<i", data, start)
            start += 8
            for name, kind in channels:
                rows[name][row - top] = np.frombuffer(data, kind, width, start)
                start += kind.itemsize * width
        at += 8 * height
        found.update(rows)
    return found


def _header(data: bytes, at: int) -> tuple[dict[str, bytes], int]:
    """The attributes of one part, and where what follows begins."""
    header = {}
    while data[at]:
        name, at = _text(data, at)
        _, at = _text(data, at)
        size, = struct.unpack_from("<I", data, at)
        header[name], at = data[at + 4:at + 4 + size], at + 4 + size
    return header, at + 1


def _channels(data: bytes) -> Iterator[tuple[str, np.dtype]]:
    place = 0
    while data[place]:
        name, place = _text(data, place)
        yield name, np.dtype(KINDS[struct.unpack_from("<I", data, place)[0]])
        place += 16


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.index(b"\0", at)
    return data[at:end].decode(), end + 1
