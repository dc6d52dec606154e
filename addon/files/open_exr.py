"""OpenEXR pictures, packed in parts: Blender's own call packs a large one at once, and ten times as large.

After the file layout in OpenEXR's technical documentation (openexr.com, "OpenEXR File Layout"): one part of scan lines,
in blocks of 16 that are packed by zlib, each byte told as its difference from the one before.
"""
from __future__ import annotations

import struct
import zlib
from collections.abc import Iterator

import numpy as np

from ...core import breathe

LINES = 16  # lines in a block compressed as ZIP
AT_ONCE = 256  # lines that are looked at between two breaths
LEVEL = 1  # compression level of zlib; a higher one takes half as long again and saves a twentieth
# largest value of half precision, and mean light above which its steps are small enough
LARGEST, LEAST_MEAN = 65504.0, 1e-3
HALF, SINGLE = ("<f2", 1), ("<f4", 2)  # dtype in NumPy and pixel type in OpenEXR


def open_exr(texels: np.ndarray) -> bytes:
    """Encode a picture of linear light, in half precision if its relative error is below a fortieth of a per cent.

    Parameters
    ----------
    texels : (height, width, 3) or (height, width, 4) float
        Red, green and blue, and opacity where there is one, from the lowest row up.
    """
    height, width, channels = texels.shape
    kind, number = HALF if _is_told_by_half(texels[..., :3]) else SINGLE
    names = "ABGR"[-channels:]
    told = b"".join(struct.pack("<2s4i", name.encode(), number, 0, 1, 1) for name in names) + b"\0"
    box = struct.pack("<4i", 0, 0, width - 1, height - 1)
    head = struct.pack("<2i", 20000630, 2) + b"".join(_attribute(*entry) for entry in (
        ("channels", "chlist", told), ("compression", "compression", b"\3"), ("dataWindow", "box2i", box),
        ("displayWindow", "box2i", box), ("lineOrder", "lineOrder", b"\0"),
        ("pixelAspectRatio", "float", struct.pack("<f", 1.0)), ("screenWindowCenter", "v2f", bytes(8)),
        ("screenWindowWidth", "float", struct.pack("<f", 1.0)))) + b"\0"
    order = ["RGBA".index(name) for name in names]
    blocks = list(_blocks(texels[::-1], order, kind))
    start = np.cumsum([len(head) + 8 * len(blocks), *map(len, blocks[:-1])])
    return head + start.astype("<u8").tobytes() + b"".join(blocks)


def _is_told_by_half(light: np.ndarray) -> bool:
    """Return True if half precision can represent the whole picture, with steps that are small relative to its mean."""
    largest, total = 0.0, 0.0
    for first in range(0, len(light), AT_ONCE):
        breathe()
        part = light[first:first + AT_ONCE]
        largest, total = max(largest, float(part.max())), total + float(part.sum(dtype=np.float64))
    return largest <= LARGEST and total >= LEAST_MEAN * light.size


def _attribute(name: str, kind: str, value: bytes) -> bytes:
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value)) + value


def _blocks(lines: np.ndarray, order: list[int], kind: str) -> Iterator[bytes]:
    """Yield the compressed blocks of the lines (height, width, channels), from top to bottom."""
    for first in range(0, len(lines), LINES):
        breathe()
        part = lines[first:first + LINES][..., order].transpose(0, 2, 1)
        plain = np.ascontiguousarray(part, dtype=kind).reshape(-1).view(np.uint8)
        # bytes of the same weight side by side: those of even places, then those of odd ones
        apart = np.concatenate((plain[::2], plain[1::2]))
        apart[1:] = apart[1:] - apart[:-1] + np.uint8(128)
        packed = zlib.compress(apart.tobytes(), LEVEL)
        # blocks that do not get smaller are stored uncompressed
        packed = packed if len(packed) < len(plain) else plain.tobytes()
        yield struct.pack("<2i", first, len(packed)) + packed
