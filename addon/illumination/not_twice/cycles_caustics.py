"""Switch off Cycles' own caustics where a mesh shows them."""
from __future__ import annotations

import bpy

from ...faults import AllOrNothing
from ..light_sources import is_met
from .own_caustics import leave_out_own_caustics, makes_own_caustics


def leave_out(scene: bpy.types.Scene, mirror: bpy.types.Object, lamp: bpy.types.Object, materials: list,
              whole: AllOrNothing) -> list:
    """Switch off Cycles' own caustics of a lamp and a mirror with `materials`, if it makes any. Return a list with a
    sentence if that is impossible.
    """
    own, alone = makes_own_caustics(materials)
    if scene.render.engine != "CYCLES" or not scene.cycles.caustics_reflective or not (own and is_met(lamp)):
        return []
    if not alone:
        return [f"Cycles adds its own caustics of '{lamp.name}' in '{mirror.name}', which is lit as well as it "
                "mirrors: switch Light Paths > Caustics > Reflective off."]
    if leave_out_own_caustics(scene, lamp, mirror, whole):
        return []
    return [f"Cycles adds its own caustics of '{lamp.name}', whose light is linked already: take '{mirror.name}' out "
            "of what it lights."]
