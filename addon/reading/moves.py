"""Detect objects that are animated or simulated, and objects that appear and disappear."""
from __future__ import annotations

import bpy

from .. import compat

SWITCHES = ("hide_render", "hide_viewport", "visible_glossy")


def moves(obj: bpy.types.Object | None) -> bool:
    """Return True if an object, its data or one of its parents is animated, driven, constrained or simulated."""
    while obj is not None:
        if obj.animation_data is not None or obj.constraints or obj.rigid_body is not None:
            return True
        if getattr(obj.data, "animation_data", None) is not None and obj.data.animation_data.action is not None:
            return True
        obj = obj.parent
    return False


def comes_and_goes(obj: bpy.types.Object) -> bool:
    """Return True if the visibility of an object in viewports, renders or mirrors is animated (also by strips) or
    driven.
    """
    # collections cannot be animated
    data = obj.animation_data
    return data is not None and any(curve.data_path in SWITCHES
                                    for curve in (*data.drivers, *compat.every_curve_of(obj)))


def forgets_particles(obj: bpy.types.Object) -> bool:
    """Return True if an object has simulated emitter particles without a baked cache. Blender discards these when a
    setting of the object changes. It keeps baked particles and hair.
    """
    return any(modifier.type == "PARTICLE_SYSTEM" and modifier.particle_system.settings.type == "EMITTER"
               and not modifier.particle_system.point_cache.is_baked for modifier in obj.modifiers)
