"""Record of light in the pixels of a picture: the window of the picture that it is for."""
from __future__ import annotations

import json

from ....core import View
from ...writing import LONGEST_RECORD
from .window import Window


def record_of(window: Window) -> str:
    """Return what a result remembers of its light."""
    return json.dumps({"kind": "PICTURE", "window": [window.column, window.row, window.width, window.height]})


def window_of(record: str, view: View) -> Window | None:
    """Return the window of the view's picture that light was made for, or None where the record names none."""
    try:
        known = json.loads(record[:LONGEST_RECORD])
        column, row, width, height = (int(side) for side in known["window"])
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return Window(column, row, width, height, view.resolution) if width > 0 and height > 0 else None
