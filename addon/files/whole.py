"""Check that a file written by Blender is complete. Blender mostly reports no error on a full disk."""
from __future__ import annotations

import os
import struct
from typing import BinaryIO

import bpy

# last bytes of a Zstandard file with a seek table, Blender's form of compression
SEEKABLE_END = (0x8F92EAB1).to_bytes(4, "little")
EXR_START = (20000630).to_bytes(4, "little")
EXR_HEAD = 1 << 20  # bytes, more than the header of a render and the table of its chunks take


def is_whole(path: str) -> bool:
    """Return True if the .blend, .exr, .usdc, .png or .jpg file at `path` exists and is complete to its end."""
    kind = os.path.splitext(path)[1]
    try:
        with open(path, "rb") as file:
            if kind == ".blend":
                return _whole_blend(file)
            if kind == ".exr":
                return _whole_exr(file)
            if kind == ".usdc":
                return _whole_usd(file)
            return _end(file, 12).endswith({".png": b"IEND\xaeB`\x82", ".jpg": b"\xff\xd9"}[kind])
    except OSError:
        return False


def _end(file: BinaryIO, length: int) -> bytes:
    """Return the last `length` bytes of a file, or fewer if it is shorter."""
    file.seek(0, os.SEEK_END)
    file.seek(-min(length, file.tell()), os.SEEK_END)
    return file.read()


def _whole_blend(file: BinaryIO) -> bool:
    """Return True if the last block exists, and the block before it, without which Blender reads no file."""
    os.fsync(file.fileno())
    start = file.read(9)
    # the block that ends a file has grown with Blender 5.0, whose files have digits for the header's length
    end = _end(file, 32 if start[7:9].isdigit() else 24)
    if not (end.startswith(b"ENDB") if start.startswith(b"BLENDER") else end.endswith(SEEKABLE_END)):
        return False
    with bpy.data.libraries.load(file.name):
        return True


def _whole_exr(file: BinaryIO) -> bool:
    """Return True if the table behind the header lists every chunk of lines, and the file ends with the last chunk.

    Blender 4.2 is not to be asked: it takes all memory over a picture whose end is missing.
    """
    start = file.read(EXR_HEAD)
    if not start.startswith(EXR_START):
        return False
    try:
        at = 8
        while start[at]:     # attributes: name, type, size, value
            at = start.index(0, start.index(0, at) + 1) + 1
            at += 4 + struct.unpack_from("<i", start, at)[0]
        at += 1
        # the first chunk follows the table
        first, = struct.unpack_from("<Q", start, at)
        chunks = struct.unpack_from(f"<{(first - at) // 8}Q", start, at)
        file.seek(chunks[-1])
        _, size = struct.unpack("<ii", file.read(8))
    except (IndexError, ValueError, OverflowError, struct.error):
        return False
    return all(chunks) and file.seek(0, os.SEEK_END) == chunks[-1] + 8 + size


def _whole_usd(file: BinaryIO) -> bool:
    """Return True if the head, which is written last, points to the table of contents at the end of the file."""
    start = file.read(24)
    if len(start) < 24 or not start.startswith(b"PXR-USDC"):
        return False
    table, = struct.unpack_from("<q", start, 16)
    return 24 <= table < file.seek(0, os.SEEK_END)
