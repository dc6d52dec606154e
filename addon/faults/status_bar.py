"""How far the work is, in the status bar: a bar with per cent, what comes next, and the time that is left.

Blender lets a function draw its status bar in place of its own (`WorkSpace.status_text_set`, from 2.83 on) and has bars
for layouts from 4.0 on (`UILayout.progress`).
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
        """Take what is to be drawn, how far the work is, its stage, and how it is stopped; returns what draws it, which
        Blender takes only as a plain function."""
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
    """Words on the time that is left after some seconds; none while that is anybody's guess."""
    if fraction < EARLY or passed < SOON:
        return ""
    seconds = passed * (1.0 - fraction) / fraction
    if seconds < 90.0:
        return pgettext_iface("about {seconds:.0f} s left").format(seconds=max(1.0, seconds))
    if seconds < 5400.0:
        return pgettext_iface("about {minutes:.0f} min left").format(minutes=seconds / 60.0)
    return pgettext_iface("about {hours:.1f} h left").format(hours=seconds / 3600.0)
