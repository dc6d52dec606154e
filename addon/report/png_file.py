"""PNG files, by the standard library alone (ISO/IEC 15948)."""
from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

import numpy as np

from ...core import breathe

AT_ONCE = 1 << 16  # bytes that are packed between two breaths


def png_bytes(indices: np.ndarray, palette: np.ndarray) -> bytes:
    """Encode a picture.

    Parameters
    ----------
    indices : (height, width) uint8
        Entries of the palette, from the highest row down.
    palette : (n, 3) uint8
        sRGB colours, at most 256.
    """
    return _file(indices, 3, (b"PLTE", np.asarray(palette, np.uint8).tobytes()))


def png_picture(pixels: np.ndarray, dots_per_metre: int) -> bytes:
    """Encode a picture that is to be printed in its size.

    Parameters
    ----------
    pixels : (height, width, 3) uint8
        sRGB, from the highest row down.
    """
    return _file(pixels, 2, (b"pHYs", struct.pack(">IIB", dots_per_metre, dots_per_metre, 1)))


def _file(pixels: np.ndarray, kind: int, told: tuple[bytes, bytes]) -> bytes:
    """A file of colour type `kind`, with what is `told` before the pixels."""
    height, width = pixels.shape[:2]
    header = struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0)
    parts = (b"IHDR", header), told, (b"IDAT", b"".join(_packed(pixels.reshape(height, -1)))), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*part) for part in parts)


def _packed(rows: np.ndarray) -> Iterator[bytes]:
    """The rows (height, bytes) packed, in parts."""
    packer, at_once = zlib.compressobj(9), max(1, AT_ONCE // rows.shape[1])
    for start in range(0, len(rows), at_once):
        breathe()
        part = rows[start:start + at_once]
        # each row starts with its filter: none
        yield packer.compress(np.pad(part, ((0, 0), (1, 0))).tobytes())
    yield packer.flush()


def _chunk(kind: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
