"""Show progress in the status bar: a bar with per cent, the next stage, and the remaining time.

Blender lets a function draw the status bar (`WorkSpace.status_text_set`, from 2.83 on) and has progress bars in layouts
(`UILayout.progress`, from 4.0 on).
"""
from __future__ import annotations

import time
from collections.abc import Callable

import bpy
from bpy.app.translations import pgettext_iface

from .told import translated_stage

# before this share of the work, or this many seconds, no time left can be told
EARLY, SOON = 0.05, 1.0


class StatusBar:
    """Draws what it was last told."""

    def __init__(self) -> None:
        self._started = time.perf_counter()
        self.fraction, self.stage, self.stopping = 0.0, "", ""

    def told(self, fraction: float, stage: str, stopping: str) -> Callable:
        """Store the fraction done, the stage, and the hint on how to stop. Return the function that draws them, a plain
        function as Blender requires.
        """
        self.fraction, self.stage, self.stopping = fraction, stage, stopping
        return lambda header, context: self._draw(header.layout)

    def _draw(self, layout: bpy.types.UILayout) -> None:
        row = layout.row()
        row.ui_units_x = 10
        row.progress(factor=self.fraction, text=f"{100.0 * self.fraction:.0f} %", translate=False)
        layout.label(text=translated_stage(self.stage), translate=False)
        left = time_left(time.perf_counter() - self._started, self.fraction)
        if left:
            layout.label(text=left, icon="TIME", translate=False)
        layout.separator_spacer()
        layout.label(text=self.stopping, translate=False)


def time_left(passed: float, fraction: float) -> str:
    """Return the remaining time in words, after `passed` seconds; "" while it cannot be estimated."""
    if fraction < EARLY or passed < SOON:
        return ""
    seconds = passed * (1.0 - fraction) / fraction
    if seconds < 90.0:
        return pgettext_iface("about {seconds:.0f} s left").format(seconds=max(1.0, seconds))
    if seconds < 5400.0:
        return pgettext_iface("about {minutes:.0f} min left").format(minutes=seconds / 60.0)
    return pgettext_iface("about {hours:.1f} h left").format(hours=seconds / 3600.0)
