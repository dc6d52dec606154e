"""Opacity of triangles: what light goes through, and what the eye alone does not see."""
from __future__ import annotations

from enum import IntEnum


class Opacity(IntEnum):
    """What rays do at a triangle of the scene.

    Attributes
    ----------
    CLEAR
        All rays go on behind it, and nothing is lost if it is covered, as with clear glass.
    UNSEEN
        The eye looks through it and mirrors show it, as a wall that is hidden from the camera.
    OPEN
        All rays go on behind it, but it is seen itself, as films, leaves and tinted panes are.
    OPAQUE
        All rays end at it.
    """

    CLEAR = 0
    UNSEEN = 1
    OPEN = 2
    OPAQUE = 3
