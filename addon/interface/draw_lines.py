"""Sentences in panels, which are as narrow as the user made them."""
from __future__ import annotations

import bpy
import blf

# pixels beside a line, at the resolution scale of 1: icon, margins, and the tabs of a sidebar
BESIDE, LEAST = 96, 80


def draw_sentence(layout: bpy.types.UILayout, context: bpy.types.Context, text: str, icon: str = "BLANK1") -> None:
    """Draw a sentence in as many lines as it needs. Blender would cut off text that is wider than the panel."""
    for number, line in enumerate(lines_of(context, text)):
        layout.label(text=line, icon="BLANK1" if number and icon != "NONE" else icon, translate=False)


def lines_of(context: bpy.types.Context, text: str) -> list[str]:
    """Return the lines of a sentence as it is drawn in the region of the context."""
    return _lines(text, *_room(context))


def _room(context: bpy.types.Context) -> tuple[float, float]:
    """Return the width of a line and the font size, in pixels. Without a region the width is infinite."""
    preferences, region = context.preferences, getattr(context, "region", None)
    # 0 without a window
    scale = preferences.system.ui_scale or 1.0
    width = float("inf") if region is None else max(region.width - BESIDE * scale, LEAST * scale)
    return width, preferences.ui_styles[0].widget.points * scale


def _lines(text: str, width: float, size: float) -> list[str]:
    """Return the text in lines that are not wider than `width`. A word that is too wide gets its own line."""
    blf.size(0, size)
    lines: list[str] = []
    for word in text.split():
        longer = f"{lines[-1]} {word}" if lines else word
        if lines and blf.dimensions(0, longer)[0] <= width:
            lines[-1] = longer
        else:
            lines.append(word)
    return lines
