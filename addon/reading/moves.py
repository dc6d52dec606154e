"""What is going to move: light that goes by the view is worth little there; and what comes and goes."""
from __future__ import annotations

import bpy

from .. import compat

SWITCHES = ("hide_render", "hide_viewport", "visible_glossy")


def moves(obj: bpy.types.Object | None) -> bool:
    """Whether an object, its data or what it hangs on is animated, driven, constrained or simulated."""
    while obj is not None:
        if obj.animation_data is not None or obj.constraints or obj.rigid_body is not None:
            return True
        if getattr(obj.data, "animation_data", None) is not None and obj.data.animation_data.action is not None:
            return True
        obj = obj.parent
    return False


def comes_and_goes(obj: bpy.types.Object) -> bool:
    """Whether what hides an object from viewports, renders or mirrors is animated, by strips too, or driven."""
    # collections cannot be animated
    data = obj.animation_data
    return data is not None and any(curve.data_path in SWITCHES
                                    for curve in (*data.drivers, *compat.every_curve_of(obj)))


def forgets_particles(obj: bpy.types.Object) -> bool:
    """Whether an object has particles that Blender simulates from frame to frame, and forgets where anything of the
    object is switched; those that are baked, and hair, it keeps."""
    return any(modifier.type == "PARTICLE_SYSTEM" and modifier.particle_system.settings.type == "EMITTER"
               and not modifier.particle_system.point_cache.is_baked for modifier in obj.modifiers)
