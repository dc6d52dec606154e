"""The buttons, and what the last comparison told."""
from __future__ import annotations

import bpy

from ..comparison import show_comparison
from .draw_lines import draw_sentence

# in the order in which they are used
WORK = (("reflection_mesh.generate", "MOD_MIRROR"), ("reflection_mesh.light", "LIGHT"),
        ("reflection_mesh.caustics", "LIGHT_POINT"), ("reflection_mesh.update", "FILE_REFRESH"),
        ("reflection_mesh.bake", "FILE_CACHE"), ("reflection_mesh.clear", "TRASH"))
TOOLS = (("reflection_mesh.compare", "IMAGE_DATA"), ("reflection_mesh.mirror_uvs", "UV"),
         ("reflection_mesh.print_sheet", "OUTPUT"))


def draw_buttons(layout: bpy.types.UILayout, operators: tuple) -> None:
    """Draw a button for each operator. The operators take their settings from the file."""
    column = layout.column(align=True)
    for name, icon in operators:
        column.operator(name, icon=icon)


def draw_comparison(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the numbers of the last comparison, and the link to its page."""
    told = show_comparison.lines(context.scene)
    if not told:
        return
    box = layout.box()
    for line in told:
        draw_sentence(box, context, line, icon="NONE")
    address = show_comparison.page_address(context.scene)
    if address:
        box.operator("wm.url_open", text="Open the Report", icon="URL").url = address
