"""What panels draw, taken down in place of being shown; and a scene whose panels are looked at."""
from __future__ import annotations

from types import SimpleNamespace

import bpy
import parts


class Layout:
    """Takes what a panel draws: labels, properties with their holders, buttons."""

    def __init__(self):
        self.labels, self.properties, self.buttons, self.menus, self.values = [], {}, [], [], []

    box = column = row = lambda self, align=False: self
    separator = popover = lambda self, *_, **__: None

    def split(self, factor):
        return self

    def label(self, text="", icon="", translate=True):
        self.labels.append(text)

    def prop(self, holder, name, text=None, translate=True, emboss=True):
        assert name in holder.bl_rna.properties and (not text or not translate)
        self.properties[name] = holder

    def operator(self, name, text="", icon="", translate=True):
        assert getattr(bpy.ops, name.split(".")[0]), name
        self.buttons.append(name)
        return SimpleNamespace()

    def menu(self, name, icon="", text=None):
        self.menus.append(name)

    def prop_enum(self, holder, name, value):
        assert value in holder.bl_rna.properties[name].enum_items
        self.values.append((holder, value))


def drawn(room, space: str) -> Layout:
    """All panels of a space, where they are to be seen."""
    layout = Layout()
    for panel in room("addon.interface.panels").CLASSES:
        if panel.bl_space_type == space and getattr(panel, "poll", lambda _: True)(bpy.context):
            panel.draw(SimpleNamespace(layout=layout), bpy.context)
    return layout


def pair(context: bpy.types.Context) -> bpy.types.Scene:
    """A cube and a wall mirror, 64 x 48 pixels; both selected, the mirror active."""
    cube = parts.add("cube", "Box", size=1.0, location=(0.0, -1.5, 1.0))
    cube.data.materials.append(parts.material("Plain"))
    parts.select(cube, parts.add_wall_mirror())
    context.scene.render.resolution_x, context.scene.render.resolution_y = 64, 48
    return context.scene
