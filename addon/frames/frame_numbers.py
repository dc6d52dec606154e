"""Parse lists of frames in the notation of render farms: "1-24", "1-100:2", "3, 5-10, 47"."""
from __future__ import annotations

import re

from ...core import ReflectionError

PART = re.compile(r"(\d{1,7})(?:(?:-|\.\.)(\d{1,7})(?:[:x](\d{1,7}))?)?")
MOST = 1_000_000    # Blender knows no more frames


def frame_numbers(text: str) -> list[int]:
    """Return the sorted distinct frames in a text.

    Parameters
    ----------
    text : str
        Frames and ranges, separated by commas. A step may follow a range, after ":" or "x".

    Raises
    ------
    ReflectionError
        If the text has any other form. Frames in files are not negative.
    """
    found: set[int] = set()
    for part in text.split(","):
        known = PART.fullmatch(part.strip())
        first, last, step = (int(number) if number else None for number in known.groups()) if known else (None,) * 3
        last = first if last is None else last
        if first is None or last < first or step == 0 or last > MOST:
            raise ReflectionError(f"'{text}' names no frames: write them as 1-24, as 1-100:2 with a step, or with "
                                  "commas between them, from 0 on.")
        found.update(range(first, last + 1, step or 1))
    return sorted(found)


def frame_text(start: int, end: int, step: int) -> str:
    """Return the range of a scene in this notation."""
    return f"{start}-{end}:{step}" if step > 1 else f"{start}-{end}"
