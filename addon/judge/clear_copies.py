"""Copies that the eye looks through: codes are opaque, and would hide the mirrors behind panes and films."""
from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ..faults import still_there
from ..reading.materials import transparency
from .cycles_scene import CopiedScene


@contextmanager
def clear_before_mirrors(copied: CopiedScene) -> Iterator[None]:
    """Hide from the camera, for a while, copies of which all materials let a part of light straight through."""
    clear = [copy for copy, _ in copied.diffuse + copied.bystanders if copy.visible_camera and copy.material_slots
             and all(transparency(slot.material) for slot in copy.material_slots)]
    try:
        for copy in clear:
            copy.visible_camera = False
        yield
    finally:
        for copy in still_there(clear):
            copy.visible_camera = True
