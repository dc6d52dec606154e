"""Operators that Blender repeats (F9, Repeat Last, Repeat History), started again with progress and ESC.

Blender repeats an operator by one call of its `execute`, in which the window draws nothing and hears no key. A repeated
operator therefore refuses that call, whereupon Blender brings back what it had undone, and is invoked by a timer.
"""
from __future__ import annotations

import bpy
from bpy.app.translations import pgettext_iface

DELAY = 0.3  # seconds: while a value is dragged Blender calls for each step of it
BUSY = 0.2   # seconds between two looks whether another operator has ended

_waiting: list[tuple[str, str, dict, int]] = []
_starting = [False]


def is_repeated(operator: bpy.types.Operator) -> bool:
    """Return True where Blender repeats the operator in a window."""
    return not bpy.app.background and (operator.options.is_repeat or operator.options.is_repeat_last)


def starts_again() -> bool:
    """Return True while an operator is invoked with all that it asks for, so that it need not ask again."""
    return _starting[0]


def start_again(operator: bpy.types.Operator, context: bpy.types.Context) -> None:
    """Invoke the operator with its present properties soon; only the last of several calls counts."""
    properties = operator.properties
    # settings of the file that the last run displayed were not set by the user
    shown = getattr(operator, "used", {})
    given = {name: getattr(properties, name) for name in properties.bl_rna.properties.keys()
             if name != "rna_type" and properties.is_property_set(name)
             and not (name in shown and shown[name] == getattr(properties, name))}
    _waiting[:] = [(operator.bl_idname, operator.bl_label, given, context.window.as_pointer())]
    if bpy.app.timers.is_registered(_start):
        bpy.app.timers.unregister(_start)
    bpy.app.timers.register(_start, first_interval=DELAY)


def _start() -> float | None:
    """Invoke the waiting operator in its window. Return the seconds until the next look."""
    name, label, given, pointer = _waiting[0]
    windows = bpy.context.window_manager.windows
    if any(len(window.modal_operators) for window in windows):
        return BUSY
    _waiting.clear()
    window = next((window for window in windows if window.as_pointer() == pointer), None)
    if window is None:
        return None
    category, _, verb = name.partition("_OT_")
    _starting[0] = True
    try:
        with bpy.context.temp_override(window=window):
            getattr(getattr(bpy.ops, category.lower()), verb)("INVOKE_DEFAULT", True, **given)
    except RuntimeError as error:
        _show(label, str(error).removeprefix("Error: ").strip())
    finally:
        _starting[0] = False
    return None


def _show(label: str, sentence: str) -> None:
    """Show why nothing was started, like Blender shows errors."""
    bpy.context.window_manager.popup_menu(
        lambda menu, _context: menu.layout.label(text=sentence, translate=False),
        title=pgettext_iface(label), icon="ERROR")
