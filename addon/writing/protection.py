"""Protection of results: clicks in the viewport pass by them and mean their mirror, and they cannot be moved."""
from __future__ import annotations

from collections.abc import Iterable

import bpy

LOCKED = (True, True, True)


def protect(results: Iterable[bpy.types.Object]) -> None:
    """Protect results that never were: if the user takes the protection away, it stays away."""
    for obj in results:
        if obj.library is None and not obj.reflection_mesh.protected:
            obj.reflection_mesh.protected = obj.hide_select = True
            obj.lock_location = obj.lock_rotation = obj.lock_scale = LOCKED
