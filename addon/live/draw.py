"""Live in the panel: the switch, what it does, and what is stale where it is off."""
from __future__ import annotations

import bpy

from ..freshness import why_stale
from . import switch
from .kept import kept_results


def draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The switch and its state, or one sentence on each result that is stale, with the button that mends it."""
    live = context.window_manager.reflection_mesh_live
    if live.on and switch.updater is not None:
        layout.operator("reflection_mesh.live", text="Stop Live", icon="PAUSE")
        layout.prop(live, "eye")
        layout.label(text=state_of(switch.updater), icon="TIME")
        return
    layout.operator("reflection_mesh.live", text="Live", icon="PLAY")
    for obj, why in stale_results(context):
        box = layout.box()
        box.label(text=f"'{obj.name}': {why} since it was made.", icon="ERROR", translate=False)
        box.operator("reflection_mesh.generate", text="Generate Again", icon="FILE_REFRESH")


def stale_results(context: bpy.types.Context) -> list[tuple]:
    """The results that no longer show what there is, and why, in a few words."""
    told = [(obj, why_stale(context, obj)) for obj in kept_results(context)]
    return [(obj, why) for obj, why in told if why]


def state_of(updater) -> str:
    """What Live is doing, in a few words."""
    if updater.told:
        return updater.told
    return f"{'Exact' if updater.at_rest else 'Coarse'}, {updater.milliseconds:.0f} ms"
