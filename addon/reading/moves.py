"""What is going to move: light that goes by the view is worth little there."""
from __future__ import annotations

import bpy


def moves(obj: bpy.types.Object | None) -> bool:
    """Whether an object, its data or what it hangs on is animated, driven, constrained or simulated."""
    while obj is not None:
        if obj.animation_data is not None or obj.constraints or obj.rigid_body is not None:
            return True
        if getattr(obj.data, "animation_data", None) is not None and obj.data.animation_data.action is not None:
            return True
        obj = obj.parent
    return False
