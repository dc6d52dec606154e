"""PNG files with a palette, by the standard library alone (ISO/IEC 15948)."""
from __future__ import annotations

import struct
import zlib

import numpy as np


def png_bytes(indices: np.ndarray, palette: np.ndarray) -> bytes:
    """Encode a picture.

    Parameters
    ----------
    indices : (height, width) uint8
        Entries of the palette, from the highest row down.
    palette : (n, 3) uint8
        sRGB colours, at most 256.
    """
    height, width = indices.shape
    rows = np.zeros((height, width + 1), dtype=np.uint8)    # each row starts with its filter: none
    rows[:, 1:] = indices
    header = struct.pack(">IIBBBBB", width, height, 8, 3, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        _chunk(kind, data) for kind, data in ((b"IHDR", header), (b"PLTE", np.asarray(palette, np.uint8).tobytes()),
                                              (b"IDAT", zlib.compress(rows.tobytes(), 9)), (b"IEND", b"")))


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
