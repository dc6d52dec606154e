"""Live: the switch, what it does, and what is stale where it is off."""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

from ..faults import translated
from ..freshness import why_light_differs, why_light_is_stale, why_stale
from ..lighting import is_lit
from ..live import abandoned_light, abandoned_results, kept_light, kept_results, present
from .draw_lines import draw_sentence


def draw_live(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """The switch and its state, or one sentence on each result that is stale, with the button that mends it."""
    live, updater = context.window_manager.reflection_mesh_live, present()
    column = layout.column(align=True)
    if updater is None:
        column.operator("reflection_mesh.live", text="Live", icon="PLAY")
    else:
        column.operator("reflection_mesh.live", text="Stop Live", icon="PAUSE")
    column.prop(live, "eye")
    if updater is not None:
        draw_sentence(layout, context, state_of(updater), icon="TIME")
        return
    gone = abandoned_results(context)
    stale = [(obj, why) for obj in kept_results(context) + gone if (why := _why(context, obj))]
    stale += [(obj, why) for obj in kept_light(context) if (why := why_light_is_stale(context, obj))]
    for obj, why in stale:
        layout.label(text=pgettext_iface("'{name}' is stale:").format(name=obj.name), icon="ERROR", translate=False)
        draw_sentence(layout, context, f"{pgettext_iface(why)}.")
    gone += abandoned_light(context)
    if any(obj not in gone for obj, _ in stale):
        layout.operator("reflection_mesh.update", icon="FILE_REFRESH")


def _why(context: bpy.types.Context, obj: bpy.types.Object) -> str:
    """Return why a reflection, or else its light, is no longer right; empty where both are."""
    return why_stale(context, obj) or (why_light_differs(context, obj) if is_lit(obj) else "")


def state_of(updater) -> str:
    """What Live is doing, in a few words."""
    if updater.told:
        return translated(pgettext_iface(updater.told))
    text = pgettext_iface("Exact, {milliseconds:.0f} ms" if updater.at_rest else "Coarse, {milliseconds:.0f} ms")
    return text.format(milliseconds=updater.milliseconds)
