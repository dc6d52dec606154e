"""What a result remembers of light in the pixels of a picture: the view that it is for."""
from __future__ import annotations

import hashlib
import json

import numpy as np

from ....core import View
from ...writing import LONGEST_RECORD
from .window import Window


def record_of(view: View, window: Window) -> str:
    """What a result remembers of its light."""
    return json.dumps({"kind": "PICTURE", "view": _fingerprint(view),
                       "window": [window.column, window.row, window.width, window.height]})


def window_of(record: str, view: View) -> Window | None:
    """The window of the picture that light was made for; None where that was another view's."""
    try:
        known = json.loads(record[:LONGEST_RECORD])
        column, row, width, height = (int(side) for side in known["window"])
        same = known["view"] == _fingerprint(view)
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    return Window(column, row, width, height, view.resolution) if same and width > 0 and height > 0 else None


def _fingerprint(view: View) -> str:
    """What tells one view from another, to single precision."""
    numbers = np.concatenate((view.camera_to_world.ravel(), view.projection.ravel(), view.resolution))
    return hashlib.sha256((numbers.astype(np.float32) + np.float32(0.0)).tobytes()).hexdigest()
