"""The place of the panel's one prompt, which is as high whatever it says, so that nothing below it moves."""
from __future__ import annotations

import bpy

from .draw_lines import draw_sentence, lines_of
from .prompts import Prompt, longest, prompt


def draw_prompt(layout: bpy.types.UILayout, context: bpy.types.Context, obj: bpy.types.Object | None) -> None:
    """Draw the one sentence that matters most, with its button, and empty rows as far as other prompts may reach."""
    shown = prompt(context, obj)
    column = layout.box().column(align=True)
    draw_sentence(column, context, shown.text, icon=shown.icon)
    rows = _rows(context, shown)
    if shown.button is not None:
        shown.button(column)
    for _ in range(max(map(lambda one: _rows(context, one), longest(context))) - rows):
        column.label(text="")


def _rows(context: bpy.types.Context, shown: Prompt) -> int:
    return len(lines_of(context, shown.text)) + (shown.button is not None)
